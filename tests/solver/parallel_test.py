# SPDX-License-Identifier: GPL-3.0-or-later
"""One coupled step gives the same charges and fields on 1, 2 and 4 ranks."""

import tempfile
import unittest

from tiny_case import TinyCase


def after_one_update(method, ranks):
    """Particles by tag and the last row of the charge table; the floor and a pair are in contact during this update."""
    with tempfile.TemporaryDirectory() as folder:
        case = TinyCase(folder, method)
        case.replace("system/controlDict", "endTime 2e-3;", "endTime 1e-3;")
        case.replace("system/controlDict", "writeInterval 2;", "writeInterval 1;")
        if ranks > 1:
            case.decompose(ranks)
        result = case.run(ranks=ranks)
        if result.code != 0:
            raise RuntimeError(result.text)
        particles = case.particles("0.001") if method in ("him", "p3m") else {}
        return particles, case.charge_table()[1][-1]


class SameOnAnyNumberOfRanks(unittest.TestCase):
    def compare(self, method, tolerance):
        serial, serial_row = after_one_update(method, 1)
        self.assertGreater(abs(serial_row["floor"]), 1e-14)
        for ranks in (2, 4):
            parallel, row = after_one_update(method, ranks)
            for name in ("total", "min", "mean", "max", "floor"):
                self.assertAlmostEqual(row[name], serial_row[name], delta=tolerance * 1e-9, msg="%s, %d ranks" % (name, ranks))
            self.assertAlmostEqual(row["largestField"] / serial_row["largestField"], 1, delta=tolerance)
            self.assertEqual(set(parallel), set(serial))
            for tag, particle in serial.items():
                self.assertAlmostEqual(parallel[tag]["charge"], particle["charge"], delta=tolerance * 1e-9)
                for a, b in zip(parallel[tag]["electricField"], particle["electricField"]):
                    self.assertAlmostEqual(a, b, delta=tolerance * serial_row["largestField"])

    def test_pairwise_sum_to_round_off(self):
        self.compare("pairwiseSum", 1e-11)

    def test_him_to_the_tolerance_of_the_potential(self):
        self.compare("him", 1e-9)

    def test_p3m_to_the_tolerance_of_the_potential(self):
        self.compare("p3m", 1e-9)


if __name__ == "__main__":
    unittest.main(verbosity=2)
