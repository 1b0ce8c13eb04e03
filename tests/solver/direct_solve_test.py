# SPDX-License-Identifier: GPL-3.0-or-later
"""The direct solve by sine transforms gives what the linear solvers of OpenFOAM give, on any number of ranks."""

import csv
import pathlib
import random
import tempfile
import unittest

from tiny_case import TinyCase

SOLUTION = """
solvers { electricPotential { solver PCG; preconditioner DIC; tolerance 1e-14; relTol 0; maxIter 2000; } }
HIM { directSolve %s; }
"""


def values(file):
    with open(file, newline="") as table:
        return [[float(row[name]) for name in ("Ex", "Ey", "Ez", "V")] for row in csv.DictReader(table)]


class DirectSolve(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def field(self, method, solve, ranks, voltage):
        case = TinyCase(self.folder / f"{method}.{solve}.{ranks}", method=method, cells=(12, 10, 16))
        case.write("system/fvSolution", SOLUTION % solve)
        case.write("constant/electrostaticProperties", f"fieldMethod {method};\nhimCoeffs {{ nearCutoff 0.02; }}\n")
        case.replace("0/electricPotential", "top { type fixedValue; value uniform 0; }",
                     f"top {{ type fixedValue; value uniform {voltage}; }}")
        dice = random.Random(1)
        rows = ["%r,%r,%r,%r" % (*(dice.uniform(0.005, 0.095) for _ in range(3)), dice.gauss(0, 1e-9)) for _ in range(60)]
        (case.path / "particles.csv").write_text("x,y,z,q\n" + "\n".join(rows) + "\n")
        case.decompose(ranks) if ranks > 1 else None
        result = case.run("-particles", "particles.csv", "-output", "field.csv", ranks=ranks, program="himField")
        self.assertEqual(result.code, 0, result.text)
        return values(case.path / "field.csv"), result.text

    def compare(self, method, voltage, columns):
        iterative, log = self.field(method, "no", 1, voltage)
        self.assertIn("Solving for", log)
        scale = max(abs(row[0]) for row in iterative)
        for ranks in (1, 2, 4):
            direct, log = self.field(method, "auto", ranks, voltage)
            self.assertNotIn("Solving for", log)
            for a, b in zip(direct, iterative):
                for column in range(columns):
                    self.assertLess(abs(a[column] - b[column]), 1e-10 * (scale if column < 3 else 0.1 * scale))

    def test_him_is_the_same_with_a_wall_at_a_voltage(self):
        self.compare("him", 35, 3)

    def test_p3m_is_the_same_with_a_wall_at_a_voltage(self):
        self.compare("p3m", 35, 4)


if __name__ == "__main__":
    unittest.main()
