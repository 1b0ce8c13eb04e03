# SPDX-License-Identifier: GPL-3.0-or-later
"""cutCells: slabs of the mesh for the ranks, by places or by particles."""

import re
import tempfile
import unittest

from tiny_case import TinyCase

MANUAL = "numberOfSubdomains 2; method manual; manualCoeffs { dataFile \"cellDecomposition\"; }"
BOX = """
actions
(
    { name middle; type cellSet; action new; source boxToCell; sourceInfo { box (0.02 0.02 -1) (0.08 0.08 1); } }
    { name middle; type cellZoneSet; action new; source setToCellZone; sourceInfo { set middle; } }
);
"""


class CutCells(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.case = TinyCase(folder.name, "p3m")

    def parts(self):
        """The part of each cell, in layers of 100 cells along z."""
        text = (self.case.path / "constant/cellDecomposition").read_text()
        numbers = [int(word) for word in re.search(r"1000\s*\(([^)]*)\)", text).group(1).split()]
        self.assertEqual(len(numbers), 1000)
        return [numbers[100 * layer:100 * layer + 100] for layer in range(10)]

    def test_cells_go_to_the_slab_of_their_centre(self):
        result = self.case.run("-axis", "z", "-at", "(0.02 0.07)", program="cutCells")
        self.assertEqual(result.code, 0, result.text[-1500:])
        self.assertIn("Cells of each part: 200 500 300", result.text)
        self.assertEqual([set(layer) for layer in self.parts()], [{0}] * 2 + [{1}] * 5 + [{2}] * 3)

    def test_cells_outside_a_zone_make_all_slabs_equally_large(self):
        self.case.write("system/topoSetDict", BOX)
        self.case.tool("topoSet")
        result = self.case.run("-axis", "z", "-at", "(0.02)", "-zone", "middle", program="cutCells")
        self.assertEqual(result.code, 0, result.text[-1500:])
        # 36 of the 100 cells of a layer are in the zone: 72 below the cut and 288 above it; 428 and 212 others.
        self.assertIn("Cells of each part: 500 500", result.text)
        for number, layer in enumerate(self.parts()):
            inside = [layer[10 * j + i] for j in range(2, 8) for i in range(2, 8)]
            self.assertEqual(set(inside), {int(number >= 2)})

    def test_layers_around_a_zone_are_cut_with_it(self):
        self.case.write("system/topoSetDict", BOX)
        self.case.tool("topoSet")
        for layers in range(3):
            result = self.case.run("-axis", "z", "-at", "(0.02)", "-zone", "middle", "-layers", str(layers), program="cutCells")
            self.assertEqual(result.code, 0, result.text[-1500:])
            # Those left over make up for it; with two layers 12 of the 100 cells of a level are left over, too few.
            self.assertIn("Cells of each part: " + ("500 500", "500 500", "296 704")[layers], result.text)
            for number, layer in enumerate(self.parts()):
                beside = [layer[10 * j + i] for j in range(10) for i in range(10)
                          if max(2 - i, i - 7, 0) + max(2 - j, j - 7, 0) <= layers]
                self.assertEqual(len(beside), (36, 60, 88)[layers])
                self.assertEqual(set(beside), {int(number >= 2)})

    def test_slabs_with_as_many_particles_run_as_one_rank_does(self):
        serial = self.case.run()
        self.assertEqual(serial.code, 0, serial.text[-1500:])
        particles = self.case.particles("0.002")
        result = self.case.run("-axis", "z", "-parts", "2", program="cutCells")
        self.assertEqual(result.code, 0, result.text[-1500:])
        line = re.search(r"^(cut_domain z (\S+))$", result.text, re.M)
        # Four of the eight start below 31.7 mm and the others above 48.3 mm; none moves by 1 mm.
        self.assertGreater(float(line.group(2)), 0.0327)
        self.assertLess(float(line.group(2)), 0.0473)

        with tempfile.TemporaryDirectory() as folder:
            other = TinyCase.copy(self.case.path, folder)
            other.tool("foamListTimes", "-rm")
            other.replace("DEM/in.cube", "units si\n", "units si\n" + line.group(1) + "\n")
            other.replace("DEM/in.cube", "processors * * *", "processors 1 1 2")
            other.write("system/decomposeParDict", MANUAL)
            other.tool("decomposePar", "-force")
            result = other.run(ranks=2)
            self.assertEqual(result.code, 0, result.text[-1500:])
            cut = other.particles("0.002")
        self.assertEqual(set(cut), set(particles))
        for tag, particle in particles.items():
            self.assertAlmostEqual(cut[tag]["charge"], particle["charge"], delta=1e-18)
            for a, b in zip(cut[tag]["U"], particle["U"]):
                self.assertAlmostEqual(a, b, delta=1e-8)

    def test_wrong_options_are_listed_together(self):
        result = self.case.run("-axis", "q", program="cutCells")
        self.assertEqual(result.code, 1)
        self.assertIn("-axis: expected x, y or z, found q.", result.text)
        self.assertIn("-at, -parts: expected one of them.", result.text)
        for options, complaint in ((["-at", "(0.07 0.02)"], "expected one or more ascending places [m]"),
                                   (["-parts", "1"], "expected a number of at least 2"),
                                   (["-parts", "2"], "has 0 particles, too few for 2 parts. Give the places of the cuts with -at."),
                                   (["-at", "(0.02)", "-layers", "1"], "-layers: expected a whole number of layers around the cells of -zone"),
                                   (["-at", "(0.02)", "-zone", "middle"], "the mesh has no cell zone middle, nor any other.")):
            result = self.case.run("-axis", "z", *options, program="cutCells")
            self.assertEqual(result.code, 1)
            self.assertIn(complaint, result.text)


if __name__ == "__main__":
    unittest.main()
