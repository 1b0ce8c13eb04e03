# SPDX-License-Identifier: GPL-3.0-or-later
"""chargingParameters through the program itself: the examples give the papers' numbers, and what is impossible is refused."""

import csv
import math
import os
import pathlib
import shutil
import subprocess
import tempfile
import unittest

CASES = pathlib.Path(__file__).resolve().parents[2] / "cases"
BIN = pathlib.Path(os.environ["HIMFOAM_BIN"])

PTFE = """
radius 1.59e-3; density 2150; youngsModulus 0.564e9; poissonsRatio 0.42;
"""
WALL = "measurements { ptfe { contact particleWall; particle { %s initialCharge -1.71e-10; saturationCharge -6.57e-10; } " \
       "chargeTransfer -2.70e-11; normalSpeed 2.56; } }" % PTFE


class ChargingParameters(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.case = pathlib.Path(folder.name)

    def run_program(self, text, *options):
        (self.case / "system").mkdir(exist_ok=True)
        (self.case / "system/chargingParametersDict").write_text(text)
        environment = {"WM_PROJECT_DIR": "/usr/share/openfoam", **os.environ}
        done = subprocess.run([BIN / "chargingParameters", "-case", self.case, *options], env=environment, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, text=True, timeout=60)
        return done.returncode, " ".join(done.stdout.split())

    def accepted(self, text, *options):
        code, out = self.run_program(text, *options)
        self.assertEqual(code, 0, out)
        return out

    def refused(self, text, *messages):
        code, out = self.run_program(text)
        self.assertEqual(code, 1, out)
        for message in messages:
            self.assertIn(message, out)
        self.assertFalse((self.case / "postProcessing").exists())

    # --- results

    def test_an_efficiency_for_frozen_charges_comes_with_the_words_update_frozen(self):
        text = (CASES / "chargingParameters/examples/similarPairNearlyEqual").read_text()
        self.accepted(text)
        lines = (self.case / "postProcessing/chargingParameters/entries.liggghts").read_text().splitlines()
        words = [line for line in lines if not line.startswith("#")]
        self.assertEqual(words[0], "update frozen")
        self.assertRegex(words[1], r"^pair 1 1 gamma 0 kappa 3[56]\d\d")
        # Beside it another measurement gets the form of kappa_c that belongs to `update frozen`.
        both = WALL[:WALL.rindex("}")] + text[text.index("{", text.index("measurements")) + 1:]
        self.accepted(both)
        folder = self.case / "postProcessing/chargingParameters"
        line = next(line for line in (folder / "entries.liggghts").read_text().splitlines() if line.startswith("pair 1 2"))
        with open(folder / "parameters.csv", newline="") as file:
            frozen = next(float(row["average"]) for row in csv.DictReader(file)
                          if row["from"] == "ptfe" and row["quantity"] == "kappa_c frozen")
        self.assertAlmostEqual(float(line.split()[-1]) / frozen, 1, delta=1e-5)

    def test_every_example_takes_its_branch_and_gives_the_numbers_of_the_paper(self):
        shutil.copy(CASES / "RunFunctions", self.case)
        shutil.copytree(CASES / "chargingParameters", self.case / "chargingParameters", ignore=shutil.ignore_patterns("postProcessing", "log.*"))
        done = subprocess.run(["./Allrun"], cwd=self.case / "chargingParameters", stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              env={**os.environ, "HIMFOAM_BUILD": str(BIN.parent)}, timeout=120)
        self.assertEqual(done.returncode, 0, done.stdout)
        self.assertNotIn("FAILED", done.stdout)
        for branch in ("particleWall", "particleWallHistory", "particleWallSaturationOnly", "particleWallWithoutSaturation",
                       "dissimilarPair", "dissimilarPairSaturationOnly", "dissimilarPairWithoutSaturation", "similarPair",
                       "similarPairNearlyEqual"):
            self.assertIn(f"{branch}: branch {branch}\n", done.stdout)

    def test_the_log_names_branch_equations_and_where_the_area_is_from(self):
        out = self.accepted(WALL)
        self.assertIn("R Fig. 3: particle-wall, saturation known, charge transfer known: branch particleWall Gamma by R17, kappa_c by R20",
                      out)
        self.assertIn("contact area: elastic impact at 2.56 m/s on a rigid wall, area law hertz", out)

    def test_the_lines_for_a_script_move_the_measured_charge(self):
        # The updated law: dq = (q_sat - q) (1 - exp(-kappa A/(4 pi r^2))), with the area in the table.
        self.accepted(WALL)
        folder = self.case / "postProcessing/chargingParameters"
        words = [line.split() for line in (folder / "entries.liggghts").read_text().splitlines() if not line.startswith("#")]
        self.assertEqual(len(words), 1)
        self.assertEqual(words[0][:4] + words[0][5:6], ["pair", "1", "2", "gamma", "kappa"])
        with open(folder / "parameters.csv", newline="") as file:
            area = next(float(row["average"]) for row in csv.DictReader(file) if row["quantity"] == "contact area")
        surface = 4 * math.pi * 1.59e-3**2
        saturation = float(words[0][4]) * surface * 8.8541878128e-12
        moved = (saturation + 1.71e-10) * -math.expm1(-float(words[0][6]) * area / surface)
        self.assertAlmostEqual(moved / -2.70e-11, 1, delta=1e-4)

    def test_intervals_give_the_parameters_that_charge_least_and_most(self):
        text = WALL.replace("saturationCharge -6.57e-10;", "saturationCharge -6.57e-10 (-7.0e-10 -6.2e-10);")
        out = self.accepted(text)
        self.assertIn("# least: pair 1 2 gamma -2.20414e+06 kappa", out)
        self.assertIn("# most: pair 1 2 gamma -2.48854e+06 kappa", out)

    def test_another_dictionary_and_another_folder_can_be_named(self):
        (self.case / "mine").write_text(WALL)
        self.accepted("", "-dict", "mine", "-output", str(self.case / "here"))
        self.accepted("", "-dict", str(self.case / "mine"), "-output", str(self.case / "there"))
        self.assertEqual((self.case / "here/parameters.csv").read_text(), (self.case / "there/parameters.csv").read_text())

    # --- refusals

    def test_a_transfer_of_the_wrong_sign_is_refused(self):
        self.refused(WALL.replace("chargeTransfer -", "chargeTransfer "), "system/chargingParametersDict: measurements: ptfe: "
                     "the charge transfer of 2.7e-11 C has the wrong sign")

    def test_a_charge_beyond_saturation_is_refused(self):
        self.refused(WALL.replace("initialCharge -1.71e-10", "initialCharge -7e-10"), "begins with -7e-10 C, beyond its saturation charge")

    def test_an_area_of_zero_is_refused(self):
        self.refused(WALL.replace("normalSpeed 2.56", "contactArea 0"), "the contact area and its whole interval must be above zero, found 0 m2")

    def test_an_interval_that_reaches_into_the_impossible_is_refused(self):
        self.refused(WALL.replace("saturationCharge -6.57e-10;", "saturationCharge -6.57e-10 (-9e-10 -1.9e-10);"),
                     "measurements: ptfe: within the intervals of the inputs: charge transfer over the charge that brings both bodies")

    def test_unknown_entries_and_names_are_listed_with_the_known_ones_and_all_complaints_come_together(self):
        text = WALL.replace("normalSpeed", "speed").replace("contact particleWall", "contact wall").replace("radius 1.59e-3;", "") + "what 1;"
        self.refused(text, "ptfe: contact: unknown name `wall`; known: particleWall, dissimilarPair, similarPair.",
                     "ptfe: speed: unknown entry; known: contact, ", "particle: radius: the entry is missing.",
                     "what: unknown entry; known: measurements, sizeLaw.")

    def test_what_contradicts_itself_is_refused(self):
        self.refused(WALL.replace("normalSpeed 2.56;", "normalSpeed 2.56; contactArea 1e-7;"), "contactArea is there as well")
        self.refused(WALL.replace("saturationCharge", "transferLimit -2e6; saturationCharge"), "saturationCharge is there as well")
        self.refused(WALL.replace("normalSpeed 2.56;", "normalSpeed 2.56; readings ((0 0) (2 -1e-10) (4 -2e-10) (6 -2.5e-10));"),
                     "readings: the readings hold the saturation charge and kappa_c")

    def test_malformed_numbers_are_refused(self):
        self.refused(WALL.replace("normalSpeed 2.56", "normalSpeed 2.56 (2 3 4)"), "normalSpeed: found `2.56 ( 2 3 4 )`, but a number, or")
        self.refused(WALL.replace("poissonsRatio 0.42", "poissonsRatio 0.7"), "poissonsRatio: found 0.7, but a number above -1 and at most 0.5")
        self.refused(WALL.replace("2.56;", "2.56; types (1);"), "two LIGGGHTS atom types are expected, like (1 2)")

    def test_readings_that_do_not_bend_are_refused(self):
        text = "measurements { ptfe { contact particleWall; particle { %s } normalSpeed 2; readings ((0 0) (1 -1) (2 -2) (3 -3) (4 -4)); } }"
        self.refused(text % PTFE, "the charge readings do not bend towards saturation")

    def test_a_size_law_needs_two_sizes_and_known_names(self):
        self.refused(WALL + "sizeLaw { measurements (ptfe small); predict (1e-3); }", "unknown name `small`; known: ptfe.",
                     "a law through 1 different radii is no law")
        self.refused("nothing 1;", "there is neither a section measurements nor a section sizeLaw")


if __name__ == "__main__":
    unittest.main(verbosity=2)
