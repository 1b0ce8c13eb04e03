# SPDX-License-Identifier: GPL-3.0-or-later
"""Cases with gas, in copies. Usage: gas_cases_test.py <case> [test]"""

import os
import re
import subprocess
import sys
import unittest

from case_copy import copy_case

NAME = sys.argv.pop(1)


def python_with_numpy():
    """As the cases' scripts choose it."""
    for python in ("/usr/bin/python3", "python3"):
        if subprocess.run([python, "-c", "import numpy, matplotlib"], stderr=subprocess.DEVNULL).returncode == 0:
            return python
    raise RuntimeError("no python3 with numpy and matplotlib")


def rows(file):
    lines = file.read_text().splitlines()
    names = [line for line in lines if line.startswith("# Time")][0][2:].split()
    return [dict(zip(names, map(float, line.split()))) for line in lines if not line.startswith("#")]


class GasCase(unittest.TestCase):
    def setUp(self):
        self.path = copy_case(self, NAME)

    def allrun(self, *options):
        return subprocess.run(["./Allrun", *options], cwd=self.path, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              timeout=580)


@unittest.skipIf(NAME == "triboFluidisedBed", "its whole runs take long")
class Whole(GasCase):
    def test_the_case_holds_its_claims(self):
        done = self.allrun()
        self.assertEqual(done.returncode, 0, done.stdout[-3000:])
        self.assertNotIn("FAILED", done.stdout)
        self.assertIn("ok", done.stdout)


@unittest.skipUnless(NAME == "triboFluidisedBed", "of the charged bed only")
class Findings(GasCase):
    def findings(self, dynamic, uniform):
        """What is found of two runs of a wide bed that lose these shares of the pressure drop, with equal charge."""
        code = """
import sys, types
import numpy as np
from check import holds
from findings import findings
def run(name, begin, end, lost, acceleration, uniform):
    time = np.arange(begin, end, 1e-3)
    same = np.ones_like(time)
    bed = {"pressureDrop": (1 - lost*np.minimum(time/1.5, 1))*100, "chargePerMass": 2e-5*time, "chargingTime": 10*time, "particles": 20000*same,
           "tau": np.nan*same, "wallParticles": 9000*same, "wallSpeed": 0.01*same}
    late = lambda name, seconds=0.5: np.mean(bed[name][time > time[-1] - seconds])
    return types.SimpleNamespace(name=name, time=time, bed=bed, late=late, acceleration=acceleration, uniform=uniform, leap=0, strength=4, hangs_since=lambda: None)
base = run("uncharged", 0, 0.5, 0, 0, False)
runs = [run("a10-eg4", 0, 1.5, %r, 10, False), run("a10-eg4-uniform", 1.5, 1.7, %r, 10, True)]
for sentence, so in findings(runs, base):
    print(sentence, "holds" if holds(so) else "does not hold")
""" % (dynamic, uniform)
        done = subprocess.run([python_with_numpy(), "-c", code], cwd=self.path, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.assertEqual(done.returncode, 0, done.stdout)
        return [line for line in done.stdout.splitlines() if "uniformly" in line][0]

    def test_uniform_charge_must_lose_much_more_at_the_charge_of_the_end(self):
        # A mean over the last 0.5 s would see 0.17 in place of 0.2, and let 0.28 pass.
        self.assertTrue(self.findings(0.2, 0.31).endswith(" holds"))
        self.assertIn("dynamic charge loses 20.0", self.findings(0.2, 0.31))
        self.assertTrue(self.findings(0.2, 0.28).endswith("does not hold"))


@unittest.skipUnless(NAME == "triboFluidisedBed", "of the charged bed only")
class ChargedBed(GasCase):
    """Gas, a field on its own mesh, insulating walls, charging and fixed charge together, cut for two ranks and then on one."""

    SHORT = ("-small", "-unchargedTime", "0.01", "-uniformTime", "0.002")

    def test_its_three_runs_follow_one_another_and_go_on_on_another_number_of_ranks(self):
        first = self.allrun(*self.SHORT, "-chargingTime", "0.05", "-np", "2")
        # A bed that has just begun to lift does not carry its weight yet: that, and only that, is not as it will be.
        failed = [line for line in first.stdout.splitlines() if "FAILED" in line]
        self.assertEqual(len(failed), 1, first.stdout[-3000:])
        self.assertIn("2500 particles", failed[0])
        self.assertEqual(first.returncode, 1)
        runs = self.path / "runs/small"
        charged, uniform = runs / "a10-eg4", runs / "a10-eg4-uniform"
        self.assertEqual(sorted(run.name for run in runs.iterdir()), ["a10-eg4", "a10-eg4-uniform", "uncharged"])
        self.assertFalse((runs / "uncharged/constant/electrostaticProperties").exists())

        def series(run, name, of):
            folders = sorted((run / "postProcessing" / name).iterdir(), key=lambda folder: float(folder.name))
            return [row for folder in folders for row in rows(folder / of)]

        ledger = series(charged, "charge", "charge.dat")
        glass = sum(ledger[-1][wall] for wall in ("xlo", "xhi", "ylo", "yhi"))
        self.assertGreater(ledger[-1]["total"], 0)
        self.assertAlmostEqual(glass/-ledger[-1]["total"], 1, delta=1e-9)       # what the glass has lost, the particles have
        self.assertAlmostEqual(ledger[-1]["wallFaces"]/glass, 1, delta=1e-9)
        spread = series(uniform, "charge", "charge.dat")
        self.assertGreater(spread[0]["total"], ledger[-1]["total"])     # of the last millisecond as well
        self.assertLess(spread[0]["total"], 1.1*ledger[-1]["total"])
        for row in spread:
            self.assertAlmostEqual(row["total"]/spread[0]["total"], 1, delta=1e-12)
        self.assertEqual(spread[-1]["min"], spread[-1]["max"])

        again = self.allrun(*self.SHORT, "-chargingTime", "0.08", "-np", "1", "-strength", "4 8", "-target", "3e-5")
        self.assertIn(os.fspath(runs / "uncharged") + " has been run already", again.stdout)
        self.assertIn(os.fspath(uniform) + " has been run already", again.stdout)
        # Two runs, far from saturated: their books can be read, but give no Gamma.
        for line in (1, 2):
            self.assertRegex(again.stdout, r"calibration.dat: line %d: the .*run longer" % line)
        longer = series(charged, "charge", "charge.dat")
        self.assertGreater(longer[-1]["Time"], ledger[-1]["Time"])
        self.assertGreater(longer[-1]["total"], ledger[-1]["total"])
        self.assertLess(abs(longer[-1]["closureError"]), 1e-9*longer[-1]["total"])
        self.assertLess(abs(longer[-1]["wallFaceError"]), 1e-9*longer[-1]["total"])

    def test_a_parallel_run_that_was_stopped_goes_on_from_its_last_complete_state(self):
        self.allrun("-small", "-a", "", "-unchargedTime", "0.004", "-np", "2")
        run = self.path / "runs/small/uncharged"
        begin = (run / "system/controlDict").read_text()
        newest = max((folder.name for folder in (run / "DEM/restart").iterdir()), key=float)
        # As Allrun left it when it was stopped: states in the parts only, the last one without its end.
        control = re.sub(r"^startTime +\S+;", "startTime %s;" % newest, begin, flags=re.M)
        control = re.sub(r"^endTime +\S+;", "endTime 0.01;", control, flags=re.M)
        control = re.sub(r"^writeInterval +\S+;", "writeInterval 0.002;", control, flags=re.M)
        (run / "system/controlDict").write_text(control)
        stopped = subprocess.run(["bash", "-c", ". ../../../../RunFunctions; runApplication -o decomposePar -time %s && "
                                  "runParallel -o -np 2 himFoam" % newest], cwd=run, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        self.assertEqual(stopped.returncode, 0, stopped.stdout[-2000:])
        states = sorted((folder.name for folder in (run / "processor0").iterdir() if re.match(r"[0-9.]+$", folder.name)), key=float)
        self.assertGreater(len(states), 3)
        for part in ("processor0", "processor1"):
            (run / part / states[-1] / "uniform/gas").unlink()
        again = self.allrun("-small", "-a", "", "-unchargedTime", "0.012", "-np", "1")
        self.assertRegex((run / "system/controlDict").read_text(), r"startTime +%s;" % re.escape(states[-2]), again.stdout[-2000:])
        self.assertFalse((run / "processor0").exists())
        # Written by the run on one rank: its first state after the joined one.
        self.assertGreater(max(float(folder.name) for folder in (run / "DEM/restart").iterdir()), 0.0119)
        self.assertIn("2500 particles", again.stdout)

    def test_faster_ways_to_charge_are_compared_with_plain_charging(self):
        done = self.allrun("-small", "-unchargedTime", "0.01", "-uniformTime", "0", "-a", "1 5", "-leap", "4", "-chargingTime", "0.05")
        self.assertNotIn("not compared", done.stdout)
        header, plain, accelerated, projective = done.stdout.splitlines()[-4:]
        self.assertEqual(header.split(), ["CPU", "[s]", "faster", "mean", "spread/mean", "walls/inside", "at", "walls", "distribution"])
        self.assertEqual([line[:10].strip() for line in (plain, accelerated, projective)], ["plain", "a = 5", "leap 4"])
        self.assertIn("its indicator", projective)
        ends = {run: rows(next((self.path / "runs/small" / run / "postProcessing/particleStatistics").glob("*/bed.dat")))[-1]
                for run in ("a1-eg4", "a5-eg4", "a1-eg4-leap4")}
        for end in ends.values():
            self.assertAlmostEqual(end["Time"], 0.06 if end is ends["a1-eg4"] else 0.02, delta=1.1e-3)      # statistics are taken every 1 ms
        deviations = [[float(word.rstrip("%")) for word in line[10:].split(" its")[0].split()] for line in (accelerated, projective)]
        self.assertTrue(all(len(row) == 7 for row in deviations), deviations)
        # The mean of each is what its log says of the moment that was written.
        total = {run: float(re.search(r"^ +total charge \[C\] +(\S+)", (self.path / "runs/small" / run / "log.himFoam").read_text(), re.M).group(1))
                 for run in ("a1-eg4", "a5-eg4", "a1-eg4-leap4")}
        for run, row in zip(("a5-eg4", "a1-eg4-leap4"), deviations):
            self.assertAlmostEqual(row[2], 100*(total[run]/total["a1-eg4"] - 1), delta=0.06)


if __name__ == "__main__":
    unittest.main(verbosity=2)
