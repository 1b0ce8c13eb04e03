# SPDX-License-Identifier: GPL-3.0-or-later
"""Contacts charge the patch condition `insulatingWall`: faces at the edge of the mesh."""

import unittest

from falling_bed import FALLING, faces_of
from insulating_walls_test import EPSILON0, INTERFACE
from tiny_case import SIZE, CaseTests, TinyCase


class WallChargesAtTheEdgeOfTheMesh(CaseTests):
    """The floor of the mesh is a patch insulatingWall: a plate of 1 mm of glass before a conductor."""

    pieces = {1: None, 2: (2, 1, 1), 4: (2, 2, 1)}  # the patch and its contacts lie on all ranks
    conditions = "thickness 1e-3; relativePermittivity 6.5; value uniform 0;"

    def edge_bed(self, name, method="him", entry=""):
        falling = [((x, y, z - INTERFACE), velocity, charge) for (x, y, z), velocity, charge in FALLING]
        case = TinyCase("%s/%s" % (self.folder, name), method, cells=(5, 5, 5), particles=falling, diameter=0.001)
        case.replace("0/electricPotential", "bottom { type fixedValue; value uniform 0; }",
                     "bottom { type insulatingWall; %s }" % self.conditions)
        case.replace("constant/electrostaticProperties", "externalField (0 0 1000);", entry)
        case.replace("constant/electrostaticProperties", "himCoeffs { nearCutoff 0.02; }", "himCoeffs { nearCutoff 0.04; }")
        return case

    def run_on(self, ranks, method="him", entry=""):
        """The case after its run, and the text of the run."""
        case = self.edge_bed("%s%d%d" % (method, ranks, len(entry)), method, entry)
        if ranks > 1:
            case.decompose(ranks, self.pieces[ranks])
        result = case.run(ranks=ranks)
        self.assertEqual(result.code, 0, result.text[-3000:])
        return case, result.text

    def test_contacts_leave_their_charge_on_its_faces_and_the_books_close(self):
        for method in ("him", "himCell"):
            case, _ = self.run_on(1, method)
            row = case.charge_table()[1][-1]
            everything = abs(row["wallFaces"]) + 7e-11
            self.assertGreater(abs(row["floor"]), 1e-12)
            self.assertAlmostEqual(row["wallFaces"], row["floor"], delta=1e-12 * everything)
            self.assertAlmostEqual(row["wallFaceError"], 0, delta=1e-12 * everything)
            self.assertAlmostEqual(row["total"] + row["wallFaces"], 7e-11, delta=1e-12 * everything)
            faces = faces_of(case)
            charged = {centre for centre, charge in faces.items() if charge != 0}
            self.assertEqual(charged, {(0.03, 0.03, 0), (0.07, 0.03, 0), (0.03, 0.07, 0), (0.05, 0.05, 0)})
            self.assertAlmostEqual(sum(faces.values()) * 0.02**2, row["floor"], delta=1e-12 * everything)

    def test_any_number_of_ranks_gives_the_same_faces_and_fields(self):
        serial_case, _ = self.run_on(1)
        serial, faces, spheres = serial_case.charge_table()[1][-1], faces_of(serial_case), serial_case.particles("0.002")
        for ranks in (2, 4):
            case, _ = self.run_on(ranks)
            row = case.charge_table()[1][-1]
            self.assertAlmostEqual(row["wallFaces"] / serial["wallFaces"], 1, delta=1e-9)
            self.assertAlmostEqual(row["wallFaceError"], 0, delta=1e-12 * 1e-10)
            for centre, charge in faces_of(case).items():
                self.assertAlmostEqual(charge, faces[centre], delta=1e-9 * max(map(abs, faces.values())))
            largest = max(abs(component) for sphere in spheres.values() for component in sphere["electricField"])
            for tag, sphere in case.particles("0.002").items():
                for component, expected in zip(sphere["electricField"], spheres[tag]["electricField"]):
                    self.assertAlmostEqual(component, expected, delta=1e-8 * largest)

    def test_its_charge_makes_the_field_of_a_capacitor_at_particles(self):
        """Plate and gas in series: V_f = sigma/(eps_w/t + eps0/L), and the field V_f/L is the same in the first cell and above."""
        sigma, heights = 1e-6, (0.0006, 0.015, 0.0333, 0.08)
        case = TinyCase(self.folder, cells=(5, 5, 5), diameter=0.001,
                        particles=[((0.03 + 0.01 * n, 0.047, z), (0., 0., 0.), 0.) for n, z in enumerate(heights)])
        case.replace("0/electricPotential", "bottom { type fixedValue; value uniform 0; }",
                     "bottom { type insulatingWall; %s }" % self.conditions)
        case.replace("0/electricPotential", "sides { type fixedValue; value uniform 0; }", "sides { type zeroGradient; }")
        case.replace("constant/electrostaticProperties", "externalField (0 0 1000);", "")
        case.replace("constant/electrostaticProperties", "himCoeffs { nearCutoff 0.02; }", "himCoeffs { nearCutoff 0.04; }")
        case.write("constant/probeProperties", "surfaceCharge { bottom %r; }\n" % sigma)
        charged = case.run(program="wallProbe")
        self.assertEqual(charged.code, 0, charged.text)
        case.replace("DEM/in.cube", "fix move all nve/sphere\n", "")
        case.replace("system/controlDict", "endTime 2e-3; deltaT 1e-3;", "endTime 1e-5; deltaT 1e-5;")
        case.replace("system/controlDict", "writeInterval 2;", "writeInterval 1;")
        self.ran(case)
        exact = sigma / (6.5 * EPSILON0 / 1e-3 + EPSILON0 / SIZE) / SIZE
        for sphere in case.particles("1e-05").values():
            self.assertAlmostEqual(sphere["electricField"][2] / exact, 1, delta=1e-6)

    def test_p3m_refuses_it_before_the_run(self):
        self.refused(self.edge_bed("p3m", "p3m"),
                     "0/electricPotential: bottom: found the condition insulatingWall, of whose other side p3m knows nothing. Mesh the "
                     "outside of the wall and name it in insulatingWalls, or use fieldMethod him or himCell.")

    def test_the_error_of_its_field_is_not_known_and_the_run_goes_on(self):
        for entry in ("", "fieldError { active no; }"):
            case, text = self.run_on(1, entry=entry)
            self.assertFalse((case.path / "postProcessing/fieldError").exists())
            if not entry:
                self.assertIn("Field error: n/a, there is no exact reference for him here: a stricter p3m would serve, but patch bottom "
                              "has the condition insulatingWall, of whose other side p3m knows nothing", text)


if __name__ == "__main__":
    unittest.main()
