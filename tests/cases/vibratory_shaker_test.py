# SPDX-License-Identifier: GPL-3.0-or-later
"""The shaker's short version passes its own check, and charges alike on one and two ranks."""

import math
import re
import statistics
import subprocess
import unittest

from case_copy import copy_case

SEEDS = (10007, 10009, 10037, 10039, 10061)   # LIGGGHTS wants primes above 10000


class VibratoryShaker(unittest.TestCase):
    def setUp(self):
        self.case = copy_case(self, "vibratoryShaker")

    def run_case(self, *options):
        done = subprocess.run(["./Allrun", *options], cwd=self.case, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              encoding="utf-8", timeout=300)
        self.assertEqual(done.returncode, 0, done.stdout[-3000:])
        return done.stdout

    def final_charge(self, seed, ranks=1):
        """Charge of all spheres [C] after one second, without drawing."""
        script = self.case / "DEM/in.shaker"
        script.write_text(re.sub(r"^variable +seed equal .*", f"variable seed equal {seed}", script.read_text(), flags=re.M))
        run = "himFoam" if ranks == 1 else f"decomposePar -force && mpirun -np {ranks} himFoam -parallel"
        entries = "".join(f"foamDictionary system/{file} -entry {entry} -set '{value}' && " for file, entry, value in (
            ("controlDict", "endTime", "1"), ("decomposeParDict", "numberOfSubdomains", ranks),
            ("decomposeParDict", "simpleCoeffs/n", f"({ranks} 1 1)")))
        commands = f". ../RunFunctions; rm -rf postProcessing processor*; {entries} blockMesh && {run}"
        done = subprocess.run(["bash", "-c", commands], cwd=self.case, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              encoding="utf-8", errors="replace", timeout=120)
        self.assertEqual(done.returncode, 0, done.stdout[-3000:])
        lines = (self.case / "postProcessing/charge/0/charge.dat").read_text().splitlines()
        return float(lines[-1].split()[1])

    def test_short_version_passes_its_check_and_draws_its_pictures(self):
        text = self.run_case("-short")
        self.assertIn("closure error of the books", text)
        self.assertNotIn("FAILED", text)
        for picture in ("bulkCharge.png", "particleCharge.png", "container.png"):
            self.assertGreater((self.case / picture).stat().st_size, 20000, picture)

    def test_two_ranks_charge_like_one_within_the_scatter_of_seeds(self):
        serial = [self.final_charge(seed) for seed in SEEDS]
        parallel = [self.final_charge(seed, ranks=2) for seed in SEEDS]
        error = math.sqrt((statistics.variance(serial) + statistics.variance(parallel)) / len(SEEDS))
        difference = statistics.mean(parallel) - statistics.mean(serial)
        self.assertLess(abs(difference), 4 * error, "serial %s, parallel %s" % (serial, parallel))
        self.assertLess(error, 0.05 * abs(statistics.mean(serial)), "a scatter this large would hide any difference")


if __name__ == "__main__":
    unittest.main(verbosity=2)
