# SPDX-License-Identifier: GPL-3.0-or-later
"""Contact charging through himFoam with the fields of a mesh: one sphere between two plates, at any field update interval."""

import math
import os
import re
import tempfile
import unittest

from tiny_case import TinyCase

EPSILON0 = 8.8541878128e-12
RADIUS, DENSITY, SPEED = 2e-3, 2000.0, 0.5
GAMMA, KAPPA = -7.67e5, 20.0
LID = 4.8e-3            # [m], a plate of the DEM scene inside the mesh: it charges, and is no conductor to the field
STEPS = 4000            # of 1e-5 s
SATURATION = 4 * math.pi * EPSILON0 * RADIUS**2 * GAMMA

PLATE = """solid plate
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 0.1 0 0
vertex 0.1 0.1 0
endloop
endfacet
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 0.1 0.1 0
vertex 0 0.1 0
endloop
endfacet
endsolid plate
"""


def relaxation():
    """x = kappa A/(4 pi r^2) of an elastic impact on the script's plates (Hertz)."""
    modulus = 5e6 / (1 - 0.45**2) / 2
    mass = 4 / 3 * math.pi * RADIUS**3 * DENSITY
    overlap = (15 * mass * SPEED**2 / (16 * modulus * math.sqrt(RADIUS)))**0.4
    return KAPPA * math.pi * RADIUS * overlap / (4 * math.pi * RADIUS**2)


class Bouncing(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        self.meshes = {}

    def case(self, name, method, interval, coeffs):
        """One sphere that flies down in the middle, elastic, with a field update every `interval` DEM steps."""
        ball = [((0.0513, 0.0487, 0.0024), (0.0, 0.0, -SPEED), 0.0)]
        if method not in self.meshes:
            self.meshes[method] = TinyCase(f"{self.folder}/mesh-{method}", method, particles=ball, diameter=2 * RADIUS).path
        case = TinyCase.copy(self.meshes[method], f"{self.folder}/{name}")
        case.replace("system/controlDict", "deltaT 1e-3;", f"deltaT {interval}e-5;")
        case.replace("system/controlDict", "endTime 2e-3;", f"endTime {STEPS}e-5;")
        case.replace("system/controlDict", "writeInterval 2;", f"writeInterval {STEPS // interval};")
        case.replace("constant/electrostaticProperties", "himCoeffs { nearCutoff 0.02; }", coeffs + "\nfieldError { active no; }")
        case.replace("constant/electrostaticProperties", "externalField (0 0 1000);", "")
        case.replace("DEM/in.cube", "0.9 0.9 0.9 0.9", "1 1 1 1")
        case.replace("DEM/in.cube", "zplane 0.1", f"zplane {LID!r}")
        case.replace("constant/couplingProperties", "wallContactField", "wallDistance 0.1; wallContactField")  # for the lid
        case.replace("system/fvSolution", "directSolve no;", "")
        return case

    def outcome(self, case):
        """Charge [C] at the end and number of contacts with walls."""
        result = case.run()
        self.assertEqual(result.code, 0, result.text[-2000:])
        contacts = int(re.search(r"contacts with particles, walls +\d+, (\d+)", result.text).group(1))
        return case.particles("%g" % (STEPS * 1e-5))[1]["charge"], contacts

    METHODS = {"him": "himCoeffs { nearCutoff 0.02; ownCellResponse forceOnly; }", "p3m": "himCoeffs { nearCutoff 0.02; }"}

    def test_an_isolated_sphere_follows_the_formula_of_n_contacts_at_intervals_1_10_and_1000(self):
        for method, coeffs in self.METHODS.items():
            for interval in (1, 10, 1000):
                with self.subTest(f"{method}, every {interval}"):
                    case = self.case(f"{method}-{interval}", method, interval, coeffs)
                    case.replace("constant/couplingProperties", "lid noTransfer", "lid top")
                    charge, contacts = self.outcome(case)
                    self.assertGreater(contacts, 12)
                    law = 1 - math.exp(-contacts * relaxation())
                    self.assertAlmostEqual(charge / SATURATION, law, delta=5e-3)

    def test_a_wall_at_a_voltage_shifts_saturation_by_its_field(self):
        # 10 kV at the bottom, 0 at the top, field lines along the insulated sides: 1e5 V/m upwards; n of the floor points down.
        for method, coeffs in self.METHODS.items():
            with self.subTest(method):
                case = self.case(f"{method}-voltage", method, 10, coeffs)
                case.replace("0/electricPotential", "bottom { type fixedValue; value uniform 0; }", "bottom { type fixedValue; value uniform 1e4; }")
                case.replace("0/electricPotential", "sides { type fixedValue; value uniform 0; }", "sides { type zeroGradient; }")
                charge, contacts = self.outcome(case)
                floor = (contacts + 1) // 2     # every second one is at the lid, which transfers nothing
                shifted = SATURATION * (GAMMA + 1e5) / GAMMA
                self.assertAlmostEqual(charge / shifted, 1 - math.exp(-floor * relaxation()), delta=1e-2)
                self.assertGreater(abs(charge / SATURATION - (1 - math.exp(-floor * relaxation()))), 0.05)


class EnableElectricField(unittest.TestCase):
    def test_it_does_the_same_as_the_fixes_by_their_own_names_to_the_bit(self):
        scripts = {
            "page": "fix tribo all enable_electric_field field_cutoff_radius 0.02 enable_collision_charge_transfer yes charge_transfer_cutoff 2e-9",
            "own": "fix tribo all charge/gran/contact pair 1 1 workFunctions kappa 1 pair 1 2 workFunctions kappa 1 pair 2 2 none "
                   "workFunction 1 7.2e-19 workFunction 2 6.8e-19 deltaE 2e-9",
        }
        found = {}
        for name, line in scripts.items():
            with tempfile.TemporaryDirectory() as folder:
                case = TinyCase(folder, "him")
                case.write("DEM/floor.stl", PLATE)
                text = (case.path / "DEM/in.cube").read_text()
                text = re.sub(r"fix floor all .*", "fix floor all mesh/surface file DEM/floor.stl type 2 curvature 10\n"
                              "fix walls all wall/gran model hertz tangential history cohesion charge mesh n_meshes 1 meshes floor", text)
                text = re.sub(r"fix tribo all .*", "fix work all property/global workFunction peratomtype 7.2e-19 6.8e-19\n" + line, text)
                (case.path / "DEM/in.cube").write_text(text)
                result = case.run()
                self.assertEqual(result.code, 0, result.text[-2000:])
                found[name] = case.particles("0.002")
        self.assertEqual(found["page"], found["own"])
        self.assertNotEqual(found["own"][8]["charge"], -0.2e-9, "the sphere at the floor must have charged")

    def test_another_cutoff_than_that_of_the_case_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            case = TinyCase(folder, "him")
            text = (case.path / "DEM/in.cube").read_text()
            (case.path / "DEM/in.cube").write_text(re.sub(r"fix tribo all .*", "fix tribo all charge/gran/contact pair 1 1 none pair 1 2 none\n"
                                                          "fix e all enable_electric_field field_cutoff_radius 0.03", text))
            result = case.run()
        self.assertNotEqual(result.code, 0)
        self.assertIn("field_cutoff_radius 0.03 m of enable_electric_field and the near cutoff 0.02", " ".join(result.text.split()))


if __name__ == "__main__":
    assert os.environ["HIMFOAM_BIN"]
    unittest.main(verbosity=2)
