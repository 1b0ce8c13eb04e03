# SPDX-License-Identifier: GPL-3.0-or-later
"""The potential and field of the mesh against exact solutions, through the program: charges that do not move."""

import math
import tempfile
import unittest

from tiny_case import SIZE, TinyCase

EPSILON0 = 8.8541878128e-12
GROUNDED = "type fixedValue; value uniform 0;"


def still(case, cutoff):
    """One short step without motion, gravity or an external field; only the mesh acts."""
    case.replace("DEM/in.cube", "fix move all nve/sphere\n", "")
    case.replace("system/controlDict", "endTime 2e-3; deltaT 1e-3;", "endTime 1e-5; deltaT 1e-5;")
    case.replace("system/controlDict", "writeInterval 2;", "writeInterval 1;")
    case.replace("constant/electrostaticProperties", "externalField (0 0 1000);", "")
    case.replace("constant/electrostaticProperties", "himCoeffs { nearCutoff 0.02; }", "himCoeffs { nearCutoff %g; }" % cutoff)


def solved(case):
    result = case.run()
    if result.code != 0:
        raise RuntimeError(result.text)
    return case


class PotentialOfTheMesh(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def image_force(self, cells):
        """Force on a charge at (.25 .5 .5) L of the grounded cube, in q^2/(4 pi eps0 L^2). The charge is in the middle of
        a cell and alone, so its field is the gradient of the mesh potential in its own cell."""
        charge = 1e-9
        with tempfile.TemporaryDirectory() as folder:
            case = TinyCase(folder, cells=cells, particles=[((0.25 * SIZE, 0.5 * SIZE, 0.5 * SIZE), (0., 0., 0.), charge)])
            still(case, 2 * SIZE / min(cells))
            particle = solved(case).particles("1e-05")[1]
        unit = charge / (4 * math.pi * EPSILON0 * SIZE**2)
        return [component / unit for component in particle["electricField"]]

    def test_image_force_of_a_grounded_cube_converges_to_the_exact_one(self):
        errors = []
        for cells in ((10, 11, 11), (18, 19, 19), (34, 35, 35)):
            x, y, z = self.image_force(cells)
            self.assertLess(max(abs(y), abs(z)), 1e-6)
            errors.append(abs(x + 3.09959) / 3.09959)
        print("relative errors of the image force:", errors)
        self.assertLess(errors[1], errors[0] / 2)
        self.assertLess(errors[2], errors[1] / 2)
        self.assertLess(errors[2], 0.02)

    def test_uniform_charge_density_gives_the_exact_centre_potential(self):
        cells = 15
        step = SIZE / cells
        charge = 1e-12
        places = [(i + 0.5) * step for i in range(cells)]
        particles = [((x, y, z), (0., 0., 0.), charge) for x in places for y in places for z in places]
        case = TinyCase(self.folder, cells=(cells, cells, cells), particles=particles, diameter=0.001)
        still(case, 2 * step)
        potential = solved(case).field_values("1e-05/electricPotential")
        centre = potential[len(potential) // 2]
        density = charge / step**3
        self.assertAlmostEqual(centre / (density * SIZE**2 / EPSILON0), 0.056213, delta=0.056213 * 0.01)

    def test_plates_at_a_voltage_have_a_linear_potential_and_a_uniform_field(self):
        case = TinyCase(self.folder, particles=[((0.0231, 0.0312, 0.0214), (0., 0., 0.), 0.)])
        case.replace("0/electricPotential", "sides { %s }" % GROUNDED, "sides { type zeroGradient; }")
        case.replace("0/electricPotential", "top { %s }" % GROUNDED, "top { type fixedValue; value uniform 500; }")
        still(case, 0.02)
        potential = solved(case).field_values("1e-05/electricPotential")
        for cell, value in enumerate(potential):
            self.assertAlmostEqual(value, 500 * (cell // 100 + 0.5) / 10, delta=1e-7)
        for field in case.field_values("1e-05/electricField"):
            self.assertAlmostEqual(field[2], -500 / SIZE, delta=1e-5)

    def test_dense_charges_of_opposite_sign_need_no_fixed_voltage(self):
        pair = [((0.025, 0.055, 0.055), (0., 0., 0.), 1e-9), ((0.085, 0.055, 0.055), (0., 0., 0.), -1e-9)]
        case = TinyCase(self.folder, particles=pair)
        text = (case.path / "0/electricPotential").read_text()
        (case.path / "0/electricPotential").write_text(text.replace(GROUNDED, "type zeroGradient;"))
        case.replace("constant/couplingProperties", "floor bottom;", "floor noTransfer;")
        still(case, 0.02)
        field = solved(case).particles("1e-05")
        self.assertGreater(field[2]["electricField"][0], 0)

    def solves_with(self, entry):
        """How often the potential is solved for in a run of two updates, and the largest field after it."""
        with tempfile.TemporaryDirectory() as folder:
            case = TinyCase(folder)
            case.replace("system/fvSolution", "HIM {", "HIM { %s" % entry)
            result = case.run()
            self.assertEqual(result.code, 0, result.text)
            return result.text.count("Solving for electricPotential"), case.charge_table()[1][-1]["largestField"]

    def test_solves_are_left_out_while_charges_have_moved_little(self):
        always, field = self.solves_with("")
        self.assertGreater(always, 1)
        # Before one of the solves no charge has left its cell and none was moved in a contact.
        self.assertEqual(self.solves_with("resolveAbove 1e-12;"), (always - 1, field))
        once, other = self.solves_with("resolveAbove 1e6;")
        self.assertEqual(once, 1)
        self.assertNotEqual(other, field)

    def test_the_field_of_clouds_is_off_by_the_share_of_charge_that_may_move_unseen(self):
        def run(entry):
            with tempfile.TemporaryDirectory() as folder:
                case = TinyCase(folder, "p3m")
                case.replace("system/controlDict", "endTime 2e-3;", "endTime 2e-2;")
                case.replace("system/fvSolution", "HIM {", "HIM { %s" % entry)
                result = case.run()
                self.assertEqual(result.code, 0, result.text)
                return result.text.count("Solving for meshPotential"), [row["largestField"] for row in case.charge_table()[1]]

        always, fields = run("")
        for share in (0.2, 0.05):
            solves, late = run("resolveAbove %g;" % share)
            worst = max(abs(a / b - 1) for a, b in zip(late, fields))
            print("resolveAbove", share, solves, "of", always, "solves, largest field off by", worst)
            self.assertLess(solves, 0.6 * always)
            self.assertLess(worst, share)

    def tilted_cells(self, correctors):
        """Largest deviation [V] from the linear potential between plates at 0 and 500 V, on two blocks that share a tilted
        face, so that most faces are not orthogonal to the line between their cells."""
        with tempfile.TemporaryDirectory() as folder:
            case = TinyCase(folder, particles=[((0.05, 0.05, 0.05), (0., 0., 0.), 0.)])
            case.replace("system/blockMeshDict", "(0 0 1) (1 0 1) (1 1 1) (0 1 1)",
                         "(0 0 1) (1 0 1) (1 1 1) (0 1 1) (0.4 0 0) (0.4 1 0) (0.7 0 1) (0.7 1 1)")
            case.replace("system/blockMeshDict", "(hex (0 1 2 3 4 5 6 7) (10 10 10)",
                         "(hex (0 8 9 3 4 10 11 7) (5 10 10) simpleGrading (1 1 1) hex (8 1 2 9 10 5 6 11) (5 10 10)")
            case.replace("system/blockMeshDict", "(0 3 2 1)", "(0 3 9 8) (8 9 2 1)")
            case.replace("system/blockMeshDict", "(4 5 6 7)); }", "(4 10 11 7) (10 5 6 11)); }")
            case.replace("system/blockMeshDict", "(0 1 5 4) (3 7 6 2)", "(0 8 10 4) (8 1 5 10) (3 7 11 9) (9 11 6 2)")
            case.tool("blockMesh")
            case.replace("0/electricPotential", "sides { %s }" % GROUNDED, "sides { type zeroGradient; }")
            case.replace("0/electricPotential", "top { %s }" % GROUNDED, "top { type fixedValue; value uniform 500; }")
            case.replace("system/fvSchemes", "default Gauss linear; }\ndivSchemes", "default leastSquares; }\ndivSchemes")
            case.replace("system/fvSolution", "nNonOrthogonalCorrectors 0;", "nNonOrthogonalCorrectors %d;" % correctors)
            still(case, 0.03)
            potential = solved(case).field_values("1e-05/electricPotential")
            case.tool("postProcess", "-func", "writeCellCentres", "-time", "0")
            heights = case.field_values("0/Cz")
        return max(abs(value - 500 * height / SIZE) for value, height in zip(potential, heights))

    def test_correctors_repair_the_potential_of_a_non_orthogonal_mesh(self):
        self.assertGreater(self.tilted_cells(0), 1)
        self.assertLess(self.tilted_cells(30), 1e-3)


if __name__ == "__main__":
    unittest.main(verbosity=2)
