# SPDX-License-Identifier: GPL-3.0-or-later
"""An isolated sphere in a grounded cylinder saturates at q_sat, whatever the walls answer to its own charge and however long the field
is held; and p3m's field at contact points. In boxes: tests/dem_coupling/isolated_sphere_test.cpp and tests/dem_coupling/liggghts/contact_field_test.py."""

import math
import unittest

from round_walls_test import RADIUS as CYLINDER
from round_walls_test import o_grid
from tiny_case import CaseTests, TinyCase

EPSILON0 = 8.8541878128e-12
SPHERE = 0.012  # [m], in cells of about 11 mm
SATURATION = 4 * math.pi * EPSILON0 * SPHERE ** 2 * -7.67e5
STEP = 1e-5  # [s]
STEPS = 4000
HIM = "himCoeffs { nearCutoff 0.04; ownCellResponse %s; }"
METHODS = {"p3m": ("p3m", ""), "him forceOnly": ("him", HIM % "forceOnly"), "him remove": ("him", HIM % "remove"),
           "pairs": ("pairwiseSum", "pairwiseSumCoeffs { images yes; }")}


class OwnResponse(CaseTests):
    def scene(self, name, method, coeffs, every):
        """A sphere that flies against floor and side; one wall contact moves all of the charge that it can."""
        particle = ((0.005, 0.003, SPHERE + 5e-4), (1.5, 0.8, -0.3), 0.0)
        case = TinyCase(self.folder + "/" + name, method, cells=(2, 2, 2), particles=[particle], diameter=2 * SPHERE)
        case.replace("constant/electrostaticProperties", "himCoeffs { nearCutoff 0.02; }", coeffs)
        case.replace("constant/electrostaticProperties", "externalField (0 0 1000);", "fieldError { active no; }")
        target = "grounded" if method == "pairwiseSum" else "%s"
        case.replace("constant/couplingProperties", "lid noTransfer;", "lid %s; side %s;" % (target.replace("%s", "bottom"), target.replace("%s", "sides")))
        case.replace("DEM/in.cube", "kappa 20.0", "kappa 1e5")
        case.replace("DEM/in.cube", "fix floor", "fix side all wall/gran model hertz tangential history cohesion charge primitive type 2 "
                     "zcylinder %r 0. 0.\nfix floor" % CYLINDER)
        case.replace("DEM/in.cube", "block -0.001 0.101 -0.001 0.101", "block -0.051 0.051 -0.051 0.051")
        if method != "pairwiseSum":
            case.write("system/blockMeshDict", o_grid(2, 8, facets=16))
            case.write("0/electricPotential", "dimensions [1 2 -3 0 0 -1 0]; internalField uniform 0; boundaryField "
                       "{ sides { type fixedValue; value uniform 0; } bottom { type fixedValue; value uniform 0; } }", "volScalarField")
            case.replace("system/fvSolution", "tolerance 1e-13", "tolerance 1e-6")
            case.replace("system/fvSolution", "nNonOrthogonalCorrectors 0", "nNonOrthogonalCorrectors 3")
            case.tool("blockMesh")
            case.tool("transformPoints", "-translate", "(0 0 %r)" % CYLINDER)
        case.replace("system/controlDict", "deltaT 1e-3;", "deltaT %r;" % (every * STEP))
        case.replace("system/controlDict", "endTime 2e-3;", "endTime %r;" % (STEPS * STEP))
        case.replace("system/controlDict", "writeInterval 2;", "writeInterval 100000;")
        return case

    def plateaus(self, case):
        """Result, and the charges that stood still for an update after they had changed, in q_sat, and the last one."""
        result = self.ran(case)
        _, rows = case.charge_table()
        charge = [row["total"] / SATURATION for row in rows]
        still = [b for a, b, c in zip(charge, charge[1:], charge[2:]) if b == c != a]
        return result, still + charge[-1:]

    def test_it_saturates_within_two_per_cent(self):
        for every in (20, 1000):
            for name, (method, coeffs) in METHODS.items():
                with self.subTest(name, every=every):
                    result, found = self.plateaus(self.scene("%s%d" % (name.replace(" ", ""), every), method, coeffs, every))
                    self.assertRegex(result.text, r"contacts with particles, walls\s+0, [2-9]")
                    for charge in found:
                        self.assertAlmostEqual(charge, 1, delta=2e-2)
                    self.assertNotIn("esponse of walls to a particle's own charge", result.text)

    def test_the_walls_hold_it_back_where_him_keeps_their_response(self):
        result, found = self.plateaus(self.scene("keep", "him", HIM % "keep", 20))
        self.assertGreater(max(abs(charge - 1) for charge in found), 2e-2)
        self.assertIn("response of walls to a particle's own charge: him keeps it", result.text)


class ContactPoint(CaseTests):
    RADIUS, OTHER = 2e-3, 1e-9

    def field(self, method, where):
        """Ez [V/m] of the others that the charge tells which a sphere has taken from the floor beside a charged one."""
        particles = [((0.05, 0.05, 0.0021), (0, 0, -0.5), 0.0), ((0.0545, 0.05, 0.0025), (0, 0, 0), self.OTHER)]
        case = TinyCase(self.folder + "/" + method + where, method, cells=(20, 20, 20), particles=particles)
        case.replace("constant/electrostaticProperties", "externalField (0 0 1000);", "pairwiseSumCoeffs { images yes; }")
        case.replace("DEM/in.cube", "kappa 20.0 area hertz", "kappa 1e6 wallField " + where)
        self.ran(case)
        _, rows = case.charge_table()
        return (rows[-1]["total"] - self.OTHER) / (4 * math.pi * EPSILON0 * self.RADIUS ** 2) + 7.67e5

    def test_p3m_and_the_pair_sum_agree_on_the_field_at_the_contact_point_and_at_the_centre(self):
        fields = {}
        for where in ("centre", "atContactPoint"):
            fields[where], pairs = (self.field(method, where) for method in ("p3m", "pairwiseSum"))
            self.assertAlmostEqual(fields[where] / pairs, 1, delta=0.05, msg=where)
        self.assertGreater(abs(fields["centre"] / fields["atContactPoint"] - 1), 0.1)


if __name__ == "__main__":
    unittest.main(verbosity=2)
