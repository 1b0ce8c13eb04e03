# SPDX-License-Identifier: GPL-3.0-or-later
"""Cases of contact charging, shortened, in a copy: they hold their own claims. Usage: charging_cases_test.py <case>"""

import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest

CASES = pathlib.Path(__file__).resolve().parents[2] / "cases"
NAME = sys.argv.pop(1)
ROWS = {"hardCases": 26, "packing": 2, "reciprocatingCharger": 1, "singleContact": 2}      # of the short report's first table


class ChargingCase(unittest.TestCase):
    def test_the_short_version_holds_its_claims_and_reports_them(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name in ("RunFunctions", "demScene.py"):
                shutil.copy(CASES / name, root)
            for name in {NAME} | ({"vibratoryShaker"} if NAME == "packing" else set()):
                shutil.copytree(CASES / name, root / name, ignore=shutil.ignore_patterns("runs", "study", "bands", "doc"))
            done = subprocess.run(["./Allrun", "-short"], cwd=root / NAME, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                  timeout=580)
            self.assertEqual(done.returncode, 0, done.stdout[-3000:])
            report = (root / NAME / "runs/report.md").read_text()
        self.assertNotIn("FAILED", done.stdout)
        table = report[report.index("|---|"):].split("\n\n")[0].strip().splitlines()[1:]
        self.assertEqual(len(table), ROWS[NAME], report)


if __name__ == "__main__":
    unittest.main(verbosity=2)
