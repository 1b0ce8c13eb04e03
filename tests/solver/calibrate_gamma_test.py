# SPDX-License-Identifier: GPL-3.0-or-later
"""calibrateGamma on runs whose answer is known."""

import math
import os
import pathlib
import subprocess
import tempfile
import unittest


class CalibrateGamma(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def run_with(self, table, *targets):
        (self.folder / "runs.dat").write_text(table)
        program = os.path.join(os.environ["HIMFOAM_BIN"], "calibrateGamma")
        words = str(targets[0]) if len(targets) == 1 else "(%s)" % " ".join(map(str, targets))
        environment = {"WM_PROJECT_DIR": "/usr/share/openfoam", **os.environ}
        return subprocess.run([program, "-runs", str(self.folder / "runs.dat"), "-target", words], stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, env=environment)

    def gammas(self, table, *targets):
        done = self.run_with(table, *targets)
        self.assertEqual(done.returncode, 0, done.stdout)
        return [float(line.split()[1]) for line in done.stdout.splitlines() if line and not line.startswith("#")], done.stdout

    def charging_run(self, name, limit, tau, end=3.0, begin=0.0, first=0.0, last=math.inf):
        """A run that charges from `begin` on, over `end` seconds; the file holds the times from `first` to `last`."""
        rows = ["%.10g %.15g" % (t, 1e-12 + limit * -math.expm1(-max(0.0, t - begin) / tau))
                for t in (begin + end * n / 60 for n in range(-20, 61)) if first - 1e-9 <= t <= last + 1e-9]
        (self.folder / name).write_text("# some words\n# Time total\n" + "\n".join(rows) + "\n")

    def test_gamma_is_linear_between_runs_and_exact_at_them(self):
        table = "8e5 4e-5\n4e5 1e-5 # the smallest\n1.2e6 6e-5\n"
        found, text = self.gammas(table, 1e-5, 2.5e-5, 5e-5, 6e-5)
        for value, exact in zip(found, (4e5, 6e5, 1e6, 1.2e6)):
            self.assertAlmostEqual(value / exact, 1, delta=1e-7)
        self.assertNotIn("extrapolated", text)

    def test_beyond_the_runs_the_line_goes_on_and_says_so(self):
        found, text = self.gammas("4e5 1e-5\n8e5 4e-5\n", 5.5e-5, -0.5e-5)
        self.assertAlmostEqual(found[0] / 1e6, 1, delta=1e-7)
        self.assertAlmostEqual(found[1] / 2e5, 1, delta=1e-7)
        self.assertEqual(text.count("extrapolated beyond the runs"), 2)

    def test_saturated_charges_come_from_the_fitted_curve(self):
        self.charging_run("low.dat", 2e-8, 1.1)
        self.charging_run("high.dat", 6e-8, 0.8)
        # 1 g: (1e-12 C at the start + Q_inf)/m
        found, _ = self.gammas("4e5 low.dat 1e-3\n8e5 high.dat 1e-3\n", 4e-5 + 1e-9)
        self.assertAlmostEqual(found[0] / 6e5, 1, delta=1e-5)

    def test_a_run_counts_from_where_its_charging_begins(self):
        """A bed that first fluidises without charge: its file begins at .5 s, or holds the flat part as well."""
        self.charging_run("low.dat", 2e-8, 1.1, begin=0.5, first=0.5)
        self.charging_run("flat.dat", 2e-8, 1.1, begin=0.5)
        self.charging_run("high.dat", 6e-8, 0.8, begin=10.0, first=10.0)
        for low in ("low.dat", "flat.dat"):
            found, _ = self.gammas("4e5 %s 1e-3\n8e5 high.dat 1e-3\n" % low, 4e-5 + 1e-9)
            self.assertAlmostEqual(found[0] / 6e5, 1, delta=1e-5)

    def test_the_files_of_a_run_that_was_continued_make_one_curve(self):
        self.charging_run("low.dat", 2e-8, 1.1, begin=0.5, first=0.5)
        self.charging_run("a.dat", 6e-8, 0.8, begin=0.5, first=0.5, last=1.2)
        self.charging_run("b.dat", 6e-8, 0.8, begin=0.5, first=1.0, last=2.0)
        self.charging_run("c.dat", 6e-8, 0.8, begin=0.5, first=2.0)
        # What the first start found after the time of the second does not count.
        with open(self.folder / "a.dat", "a", encoding="ascii") as file:
            file.write("1.3 -5e-8\n1.4 9e-8\n")
        for files in ("a.dat b.dat c.dat", "c.dat a.dat b.dat"):
            found, _ = self.gammas("4e5 low.dat 1e-3\n8e5 %s 1e-3\n" % files, 4e-5 + 1e-9)
            self.assertAlmostEqual(found[0] / 6e5, 1, delta=1e-5)

    def test_runs_that_can_not_be_read_are_listed_together(self):
        self.charging_run("short.dat", 2e-8, 50.0)
        (self.folder / "empty.dat").write_text("# Time total\n")
        (self.folder / "other.dat").write_text("1 2\n")
        text = self.run_with("4e5\n4e5 empty.dat 1e-3\n4e5 other.dat 1e-3\n", 1e-5).stdout
        for part in ("runs.dat: line 1: found one word", "line 2: empty.dat has no lines", "line 3: other.dat has no columns Time and total"):
            self.assertIn(part, text)
        done = self.run_with("4e5 short.dat 1e-3\n4e5 1e-5 0 0 0\n5e5 none.dat 1e-3\n6e5 short.dat -1\n", 1e-5)
        self.assertNotEqual(done.returncode, 0)
        for part in ("line 1: ", "line 2: a mass of 0 kg is not positive", "line 3: ", "line 4: a mass of -1 kg is not positive"):
            self.assertIn(part, done.stdout)
        self.assertIn("at least two runs with different Gamma", self.run_with("4e5 1e-5\n4e5 2e-5\n", 1e-5).stdout)
        done = self.run_with("4e5 1e-5\n8e5 5e-6\n6e5 2e-5\n", "nan", 1e-5)
        self.assertIn("-target: found nan", done.stdout)
        self.assertIn("does not rise from Gamma = 600000 V/m (2e-05 C/kg) to 800000 V/m (5e-06 C/kg)", done.stdout)

    def test_runs_of_one_gamma_count_as_one_also_beyond_the_runs(self):
        found, text = self.gammas("4e5 0.9e-5\n4e5 1.1e-5\n8e5 3.8e-5\n8e5 4.2e-5\n", 2.5e-5, 5.5e-5)
        self.assertAlmostEqual(found[0] / 6e5, 1, delta=1e-7)
        self.assertAlmostEqual(found[1] / 1e6, 1, delta=1e-7)
        self.assertEqual(text.count("extrapolated beyond the runs"), 1)


if __name__ == "__main__":
    unittest.main(verbosity=2)
