# SPDX-License-Identifier: GPL-3.0-or-later
"""cases/speedAgainstError, shortened, in a copy: the report is there and says what it must."""

import csv
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

SCENES = ("diluteMixed", "bedMixed", "bedMixedFine", "wallLayer", "polyhedra", "sphere", "cylinder")  # of -short, as reported
CASES = pathlib.Path(__file__).resolve().parents[2] / "cases"


class SpeedAgainstError(unittest.TestCase):
    def test_the_short_study_reports_every_scene_and_p3m_beats_him_in_each(self):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            shutil.copy(CASES / "RunFunctions", root)
            shutil.copytree(CASES / "speedAgainstError", root / "speedAgainstError", ignore=shutil.ignore_patterns("runs"))
            done = subprocess.run(["./Allrun", "-short"], cwd=root / "speedAgainstError", stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                  text=True, env=dict(os.environ))
            self.assertEqual(done.returncode, 0, done.stdout)
            report = (root / "speedAgainstError/runs/report.md").read_text()
            self.assertTrue((root / "speedAgainstError/runs/speedAgainstError.png").exists())
            kept = [self.methods_kept(root / "speedAgainstError/runs" / name) for name in SCENES]
        glance = report[report.index("| scene |"):].split("\n\n")[0].splitlines()
        names = [cell.strip() for cell in glance[0].split("|")][2:-1]
        self.assertEqual(len(glance) - 2, len(SCENES))
        for line in glance[2:]:
            cells = [cell.strip() for cell in line.split("|")][1:-1]
            errors = {name: float(cell.split(" at ")[0]) for name, cell in zip(names, cells[1:])}
            self.assertLess(errors["p3m-2h"], 0.25 * errors["him-diagonal"], line)
            self.assertLess(errors["p3m-3h"], 0.02, line)
        self.assertIn("| dilute | p3m-3h |", report)
        tables = report[report.index("## Scenes"):report.index("## Cost")].split("\n### ")[1:]
        shown = [[line.split("|")[1].strip() for line in table.splitlines() if line.startswith("| ")][1:] for table in tables]
        self.assertEqual(shown, kept, "the tables of the scenes must outlive the turns with LAMMPS")

    @staticmethod
    def methods_kept(folder):
        with open(folder / "postProcessing/himField/compare.csv", newline="") as file:
            return [row["name"] for row in csv.DictReader(file)]
        self.assertNotIn("left out", report[:report.index("## Cost")])
        cylinder = report[report.index("### Cylinder"):].split("\n###")[0]
        mirrored = next(line for line in cylinder.splitlines() if line.startswith("| pairwise-images")).split("|")
        self.assertLess(float(mirrored[-3]), 0.1)


if __name__ == "__main__":
    unittest.main(verbosity=2)
