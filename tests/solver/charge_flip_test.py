# SPDX-License-Identifier: GPL-3.0-or-later
"""Flipping the sign of everything electric leaves every trajectory as it is, to the last bit."""

import tempfile
import unittest

from tiny_case import PARTICLES, TinyCase

DUMP = """dump out all custom 20 out.dump id x y z vx vy vz q
dump_modify out format "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g" sort id
"""


def trajectories(method, sign):
    """Rows of all dumps after 20 field updates: tag, position, velocity, charge."""
    particles = [(position, velocity, sign * charge * 10) for position, velocity, charge in PARTICLES]
    with tempfile.TemporaryDirectory() as folder:
        case = TinyCase(folder, method, particles=particles)
        case.replace("system/controlDict", "endTime 2e-3;", "endTime 20e-3;")
        case.replace("DEM/in.cube", "fix move all", DUMP + "fix move all")
        case.replace("DEM/in.cube", "gamma -7.67e5", "gamma %r" % (sign * -7.67e5))
        case.replace("constant/electrostaticProperties", "(0 0 1000)", "(0 0 %r)" % (sign * 1000.0))
        result = case.run()
        if result.code != 0:
            raise RuntimeError(result.text)
        lines = (case.path / "out.dump").read_text().splitlines()
    return [tuple(map(float, line.split())) for line in lines if len(line.split()) == 8 and not line.startswith("ITEM")]


class ChargeFlip(unittest.TestCase):
    def compare(self, method):
        plus, minus = trajectories(method, 1), trajectories(method, -1)
        self.assertEqual(len(plus), 101 * len(PARTICLES))
        for a, b in zip(plus, minus):
            self.assertEqual(a[:7], b[:7])
            self.assertEqual(a[7], -b[7])
        charges = {row[0]: row[7] for row in plus[-len(PARTICLES):]}
        self.assertNotEqual(charges[8], PARTICLES[7][2] * 10, "the ball on the floor must have charged")

    def test_pairwise_sum(self):
        self.compare("pairwiseSum")

    def test_him(self):
        self.compare("him")


if __name__ == "__main__":
    unittest.main(verbosity=2)
