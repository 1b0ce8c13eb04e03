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


# Largest relative RMS field errors of p3m with R = 2, 3, 4 h that the method is held to, by the beginning of a scene's title. On cells of one
# diameter and in the cylinder only the middle one was set beforehand; the others bound what was measured.
BOUNDS = {
    "Dilute cloud, +-q": (0.04, 0.010, 0.004),
    "Dense bed, +-q, h = 2 d": (0.04, 0.010, 0.003),
    "Dense bed, +-q, h = d": (0.06, 0.015, 0.005),
    "Layer on all six walls, +-q": (0.055, 0.004, 0.0015),
    "Polyhedral mesh of a box": (0.06, 0.025, 0.01),
    "Sphere": (0.03, 0.02, 0.015),
    "Cylinder": (0.06, 0.02, 0.01),
}


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
            bounds = next(bounds for title, bounds in BOUNDS.items() if cells[0].startswith(title))
            for name, bound in zip(("p3m-2h", "p3m-3h", "p3m-4h"), bounds):
                self.assertLessEqual(errors[name], bound, line)
                self.assertEqual(errors[name + "-single"], errors[name], line)
        self.assertIn("| dilute | p3m-3h |", report)
        tables = report[report.index("## Scenes"):report.index("## Cost")].split("\n### ")[1:]
        shown = [[line.split("|")[1].strip() for line in table.splitlines() if line.startswith("| ")][1:] for table in tables]
        self.assertEqual(shown, kept, "the tables of the scenes must outlive the turns with LAMMPS")
        self.assertNotIn("left out", report[:report.index("## Cost")])
        cylinder = report[report.index("### Cylinder"):].split("\n###")[0]
        mirrored = next(line for line in cylinder.splitlines() if line.startswith("| pairwise-images")).split("|")
        self.assertLess(float(mirrored[-3]), 0.1)

    @staticmethod
    def methods_kept(folder):
        with open(folder / "postProcessing/himField/compare.csv", newline="") as file:
            return [row["name"] for row in csv.DictReader(file)]


if __name__ == "__main__":
    unittest.main(verbosity=2)
