# SPDX-License-Identifier: GPL-3.0-or-later
"""The pipe, shortened, in a copy: what particles carry out is in the books, and the claims of a short run hold."""

import pathlib
import shutil
import subprocess
import tempfile
import unittest

CASES = pathlib.Path(__file__).resolve().parents[2] / "cases"


class PneumaticPipe(unittest.TestCase):
    def test_the_short_version_holds_its_claims_on_two_ranks(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            shutil.copy(CASES / "RunFunctions", root)
            shutil.copytree(CASES / "pneumaticPipe", root / "pneumaticPipe", ignore=shutil.ignore_patterns("runs", "doc"))
            done = subprocess.run(["./Allrun", "-short", "-np", "2"], cwd=root / "pneumaticPipe", stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, text=True, timeout=500)
            rows = (root / "pneumaticPipe/runs/pipe/postProcessing/charge/0/charge.dat").read_text().splitlines()
        self.assertEqual(done.returncode, 0, done.stdout[-3000:])
        self.assertNotIn("FAILED", done.stdout)
        names = [line for line in rows if line.startswith("# Time")][0][1:].split()
        last = dict(zip(names, map(float, rows[-1].split())))
        self.assertGreater(last["removed"], 1e-12)  # some have left
        self.assertAlmostEqual((last["total"] + last["removed"]) / -last["pipe"], 1, delta=1e-10)


if __name__ == "__main__":
    unittest.main(verbosity=2)
