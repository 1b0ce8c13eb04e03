# SPDX-License-Identifier: GPL-3.0-or-later
"""him says how much field its mesh makes of a particle's own charge, and the field of uneven cells is the known one.

Reference: a growth of 10 % from cell to cell gives 0.052 q/(4 pi eps0 h^2), of 20 % 0.10 (measured on graded meshes).
"""

import re
import tempfile
import unittest

from tiny_case import TinyCase

CELLS = 21
RADIUS = 0.002
MIDDLE = (0.05, 0.05, 0.05)


def graded(case, growth):
    """Cells of the same size h at the middle in all directions, growing along z; returns h."""
    lengths = [growth ** n for n in range(CELLS)]
    size = 0.1 * lengths[CELLS // 2] / sum(lengths)
    below = sum(lengths[:CELLS // 2]) / sum(lengths) * 0.1
    across = round(0.1 / size) | 1
    case.replace("system/blockMeshDict", "simpleGrading (1 1 1)", "simpleGrading (1 1 %r)" % growth ** (CELLS - 1))
    case.replace("system/blockMeshDict", "(%d %d %d)" % (5, 5, 5), "(%d %d %d)" % (across, across, CELLS))
    case.tool("blockMesh")
    return size, below + size / 2


class SelfField(unittest.TestCase):
    def share(self, growth, entry=""):
        """Printed share of the surface field, and cell size; the only charge sits in the middle cell."""
        with tempfile.TemporaryDirectory() as folder:
            case = TinyCase(folder, "him", cells=(5, 5, 5))
            size, height = graded(case, growth)
            script = case.path / "DEM/in.cube"
            text = script.read_text()
            kept = [line for line in text.splitlines() if not re.match("create_atoms|set atom", line)]
            at = kept.index(next(line for line in kept if line.startswith("fix tribo")))
            kept.insert(at, "create_atoms 1 single 0.05 0.05 %r units box\n"
                            "set atom 1 diameter 0.004 density 2000 vx 0. vy 0. vz 0. charge 1.e-12" % height)
            script.write_text("\n".join(kept) + "\n")
            case.replace("constant/electrostaticProperties", "himCoeffs { nearCutoff 0.02; }",
                         "himCoeffs { nearCutoff 0.05; %s }" % entry)
            case.replace("system/controlDict", "endTime 2e-3;", "endTime 1e-3;")
            result = case.run()
            self.assertEqual(result.code, 0, result.text)
            return result.text, size

    def expect(self, growth, reference):
        text, size = self.share(growth)
        printed = float(re.search(r"away from walls: up to (\S+) of the field at the surface \(particle 1", text).group(1))
        in_cell_units = printed * (size / RADIUS) ** 2
        self.assertAlmostEqual(in_cell_units / reference, 1, delta=0.15)
        return text, printed

    def test_ten_percent_growth(self):
        self.expect(1.1, 0.052)

    def test_twenty_percent_growth(self):
        self.expect(1.2, 0.10)

    def test_uniform_cells_have_none(self):
        text, _ = self.share(1.0)
        self.assertIn("away from walls: none, the cells are uniform", text)

    def test_is_not_printed_when_it_is_taken_out(self):
        text, _ = self.share(1.1, "ownCellResponse remove;")
        self.assertNotIn("Self-field", text)


if __name__ == "__main__":
    unittest.main(verbosity=2)
