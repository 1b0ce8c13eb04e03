# SPDX-License-Identifier: GPL-3.0-or-later
"""What p3m is told about meshes of all kinds, and potentials under boundary values of its own, through meshProbe."""

import os
import tempfile
import unittest

from tiny_case import POTENTIAL, SIZE, TinyCase

GROUNDED = "type fixedValue; value uniform 0;"
SIDES = "sides  { type wall; faces ((0 4 7 3) (1 2 6 5) (0 1 5 4) (3 7 6 2)); }"
PERIODIC = """
    left { type cyclic; neighbourPatch right; faces ((0 4 7 3)); }
    right { type cyclic; neighbourPatch left; faces ((1 2 6 5)); }
    sides { type wall; faces ((0 1 5 4) (3 7 6 2)); }
"""


class ArraysOfMeshes(unittest.TestCase):
    def case(self, cells=(6, 7, 8), change=None, potential=None):
        """A tiny case whose blockMeshDict and electricPotential have passed the functions `change` and `potential`."""
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        case = TinyCase(folder.name, cells=cells)
        for name, edit in (("system/blockMeshDict", change), ("0/electricPotential", potential)):
            if edit:
                text = (case.path / name).read_text()
                changed = edit(text)
                self.assertNotEqual(text, changed)
                (case.path / name).write_text(changed)
        case.tool("blockMesh")
        return case

    def run_probe(self, case, ranks=1):
        program = os.path.join(os.environ["HIMFOAM_BIN"], "meshProbe")
        if ranks == 1:
            return case._run([program])
        case.decompose(ranks)
        return case._run(["mpirun", "--allow-run-as-root", "--oversubscribe", "--bind-to", "none", "-np", str(ranks),
                          program, "-parallel"])

    def probe(self, case, ranks=1):
        result = self.run_probe(case, ranks)
        if result.code != 0:
            raise RuntimeError(result.text)
        found = {}
        for line in result.text.splitlines():
            words = line.split()
            if len(words) == 2:
                try:
                    found[words[0]] = float(words[1])
                except ValueError:
                    pass
        self.assertLess(found["openness"], 1e-12)
        self.assertEqual(found["heldElsewhere"], 0)
        self.assertAlmostEqual(found["volume"], SIZE**3, delta=1e-12)
        return found

    def periodic(self):
        def potential(text):
            return text.replace("sides {", "left { type cyclic; }\n    right { type cyclic; }\n    sides {")
        return self.case(change=lambda text: text.replace(SIDES, PERIODIC), potential=potential)

    def test_box_on_any_number_of_ranks(self):
        for ranks in (1, 2, 4):
            found = self.probe(self.case(), ranks)
            self.assertEqual(found["cells"], 6 * 7 * 8)
            self.assertEqual(found["coupledFaces"], 2 * 6 * 7 * (ranks - 1))
            self.assertEqual(found["shiftedFaces"], 0)
            self.assertGreater(found["surelyHeld"], 0.2)
            self.assertLess(found["coupledOffset"], 1e-12)
            self.assertAlmostEqual(found["conductorArea"], 6 * SIZE**2, delta=1e-12)
            self.assertLess(found["linearError"], 1e-12)

    def test_direct_solve_of_a_box_on_any_number_of_ranks(self):
        for ranks in (1, 2, 4):
            case = self.case()
            case.replace("system/fvSolution", "directSolve no;", "")
            found = self.probe(case, ranks)
            self.assertEqual(found["direct"], 1)
            self.assertLess(found["linearError"], 1e-12)

    def test_box_with_a_baffle_inside_is_not_solved_directly(self):
        case = self.case()
        case.replace("system/fvSolution", "directSolve no;", "")
        case.write("system/topoSetDict", """actions ({ name baffle; type faceSet; action new; source boxToFace;
            sourceInfo { box (0.02 0.02 0.049) (0.08 0.08 0.051); } }
            { name baffle; type faceZoneSet; action new; source setToFaceZone; sourceInfo { faceSet baffle; } });""")
        case.write("system/createBafflesDict", """internalFacesOnly true;
            baffles { baffle { type faceZone; zoneName baffle;
                               patches { master { name baffle; type wall; } slave { name baffle; type wall; } } } }""")
        case.tool("topoSet")
        case.tool("createBaffles", "-overwrite")
        case.write("0/electricPotential", POTENTIAL.replace("sides {", "baffle { %s }\n    sides {" % GROUNDED), "volScalarField")
        found = self.probe(case)
        self.assertEqual(found["direct"], 0)
        self.assertGreater(found["conductorArea"], 6 * SIZE**2 + 1e-4)
        self.assertLess(found["linearError"], 1e-5)

    def test_voltages_and_insulated_faces(self):
        def potential(text):
            text = text.replace("top { %s }" % GROUNDED, "top { type fixedValue; value uniform 500; }")
            return text.replace("sides { %s }" % GROUNDED, "sides { type zeroGradient; }")
        for ranks in (1, 2):
            found = self.probe(self.case(potential=potential), ranks)
            self.assertAlmostEqual(found["conductorArea"], 2 * SIZE**2, delta=1e-12)
            self.assertAlmostEqual(found["insulatedArea"], 4 * SIZE**2, delta=1e-12)
            self.assertAlmostEqual(found["voltageTimesArea"], 500 * SIZE**2, delta=1e-9)
            self.assertLess(found["linearError"], 1e-5)

    def test_symmetry_patches_take_a_gradient(self):
        case = self.case(change=lambda text: text.replace("sides  { type wall;", "sides { type symmetry;"),
                         potential=lambda text: text.replace("sides { %s }" % GROUNDED, "sides { type symmetry; }"))
        found = self.probe(case)
        self.assertAlmostEqual(found["insulatedArea"], 4 * SIZE**2, delta=1e-12)
        self.assertLess(found["linearError"], 1e-5)

    def test_copies_beyond_periodic_patches_stand_one_period_away(self):
        for ranks in (1, 2, 4):
            found = self.probe(self.periodic(), ranks)
            self.assertEqual(found["shiftedFaces"], 2 * 7 * 8)
            self.assertAlmostEqual(found["largestShift"], SIZE, delta=1e-14)
            self.assertLess(found["coupledOffset"], 1e-12)

    def test_copies_beyond_periodic_patches_on_other_ranks(self):
        case = self.periodic()
        case.write("system/decomposeParDict", "numberOfSubdomains 3; method simple; simpleCoeffs { n (3 1 1); delta 0.001; }")
        case.tool("decomposePar", "-force")
        case.decompose = lambda ranks: None
        found = self.probe(case, 3)
        self.assertEqual(found["shiftedFaces"], 2 * 7 * 8)
        self.assertEqual(found["coupledFaces"], 2 * 7 * 8 * 3)
        self.assertLess(found["coupledOffset"], 1e-12)

    def test_conditions_that_are_neither_conductor_nor_insulated_are_refused(self):
        mixed = "type mixed; refValue uniform 0; refGradient uniform 0; valueFraction uniform 0.5; value uniform 0;"
        for condition, reason in ((mixed, "found the condition mixed"),
                                  ("type fixedGradient; gradient uniform 5;", "found the condition fixedGradient")):
            result = self.run_probe(self.case(potential=lambda text: text.replace("top { %s }" % GROUNDED,
                                                                                  "top { %s }" % condition)))
            self.assertEqual(result.code, 1)
            self.assertIn("0/electricPotential: top", result.text)
            self.assertIn(reason, result.text)

    def test_periodic_patches_with_rotation_are_refused(self):
        wedge = """
    left { type cyclic; neighbourPatch front; transform rotational; rotationAxis (0 0 1); rotationCentre (0 0 0);
           faces ((0 4 7 3)); }
    front { type cyclic; neighbourPatch left; transform rotational; rotationAxis (0 0 1); rotationCentre (0 0 0);
            faces ((0 1 5 4)); }
    sides { type wall; faces ((1 2 6 5) (3 7 6 2)); }
"""
        case = self.case(cells=(6, 6, 6), change=lambda text: text.replace(SIDES, wedge),
                         potential=lambda text: text.replace("sides {", "left { type cyclic; }\n front { type cyclic; }\n sides {"))
        result = self.run_probe(case)
        self.assertEqual(result.code, 1)
        self.assertIn("a periodic patch with rotation", result.text)

    def test_corrections_add_up_to_the_solve_of_the_whole_charge(self):
        found = self.probe(self.case())
        self.assertGreater(found["withoutCorrection"], 10 * found["correctedError"])
        self.assertAlmostEqual(found["correctedError"], found["quadraticError"], delta=1e-4 * found["withoutCorrection"])

    def sheared(self, degrees):
        """Blocks whose cells lean by this angle in x, between upright walls at both ends of z."""
        import math
        shift = math.tan(math.radians(degrees))
        def change(text):
            return text.replace("(0 0 1) (1 0 1) (1 1 1) (0 1 1)",
                                "(%g 0 1) (%g 0 1) (%g 1 1) (%g 1 1)" % (shift, 1 + shift, 1 + shift, shift))
        return self.case(cells=(10, 10, 10), change=change)

    def test_cells_that_lean_by_60_degrees(self):
        for ranks in (1, 2):
            case = self.sheared(60)
            case.replace("system/fvSchemes", "gradSchemes { default Gauss linear; }", "gradSchemes { default leastSquares; }")
            found = self.probe(case, ranks)
            self.assertLess(found["linearError"], 0.05)  # 1 V across the mesh: wall faces have no explicit part of the flux

    def test_cells_graded_one_to_ten(self):
        def change(text):
            return text.replace("simpleGrading (1 1 1)", "simpleGrading (10 10 10)")
        found = self.probe(self.case(cells=(12, 12, 12), change=change))
        self.assertLess(found["linearError"], 1e-5)

    def test_polyhedral_cells(self):
        case = self.case(cells=(8, 8, 8))
        case.tool("polyDualMesh", "75", "-overwrite")
        found = self.probe(case)
        self.assertGreater(found["cells"], 8**3)
        self.assertLess(found["linearError"], 0.02)


if __name__ == "__main__":
    unittest.main(verbosity=2)
