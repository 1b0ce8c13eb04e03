# SPDX-License-Identifier: GPL-3.0-or-later
"""`accuracy` chooses the field method and its settings; explicit entries win, and the log says what to expect."""

import tempfile
import unittest

from tiny_case import TinyCase

ELECTROSTATIC = "constant/electrostaticProperties"


class Accuracy(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.original = TinyCase(cls.folder.name + "/original")
        cls.count = 0

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def run_with(self, entries, *options, code=0, ranks=1):
        """The case, run with these entries in place of fieldMethod, and what it said."""
        Accuracy.count += 1
        case = TinyCase.copy(self.original.path, "%s/case%d" % (self.folder.name, self.count))
        case.replace(ELECTROSTATIC, "fieldMethod him;", entries)
        case.replace("system/controlDict", "writeInterval 2;", "writeInterval 1;")
        if ranks > 1:
            case.decompose(ranks)
        result = case.run(*options, ranks=ranks)
        self.assertEqual(result.code, code, result.text)
        return case, result.text

    def fields(self, case):
        return [value for _, one in sorted(case.particles("0.001").items()) for value in one["electricField"]]

    def test_the_choice_is_the_same_as_its_entries_written_out(self):
        chosen, text = self.run_with("accuracy 0.014;")
        self.assertIn("Field method p3m, clouds of 3 cells, quartic gather, deferred correction", text)
        self.assertIn("Accuracy 0.014 asked for (relative RMS field error): expected at most 0.012 between plane walls", text)
        self.assertNotIn("WARNING: the entries", text)
        written, text = self.run_with(
            "fieldMethod p3m; p3mCoeffs { cloudCells 3; gather quartic; deferredCorrection yes; nearPrecision single; }")
        self.assertNotIn("Accuracy", text)
        self.assertEqual(self.fields(chosen), self.fields(written))
        coarse, _ = self.run_with("fieldMethod p3m; accuracy 0.1;")
        self.assertNotEqual(self.fields(chosen), self.fields(coarse))

    def test_two_ranks_choose_and_get_the_same(self):
        serial = self.fields(self.run_with("accuracy 0.014;")[0])
        parallel = self.fields(self.run_with("accuracy 0.014;", ranks=2)[0])
        largest = max(map(abs, serial))
        self.assertEqual(len(serial), len(parallel))
        for one, other in zip(serial, parallel):
            self.assertAlmostEqual(one, other, delta=1e-6 * largest)

    def test_few_particles_in_a_grounded_box_get_the_pair_sum_with_images(self):
        case, text = self.run_with("accuracy 0.02; fieldError { interval 1; }")
        self.assertIn("Field method pairwiseSum", text)
        self.assertIn("expected at most 0.015", text)
        rows = (case.path / "postProcessing/fieldError/0/fieldError.dat").read_text().splitlines()
        errors = [float(row.split()[2]) for row in rows if not row.startswith("#")]
        self.assertEqual(len(errors), 3)
        self.assertLess(max(errors), 0.015)
        strict, _ = self.run_with("accuracy 0.0012;")
        fields, exact = self.fields(case), self.fields(strict)
        largest = max(map(abs, exact))
        self.assertNotEqual(fields, exact)
        for one, other in zip(fields, exact):
            self.assertAlmostEqual(one, other, delta=0.02 * largest)

    def test_sides_that_are_not_grounded_keep_the_mesh(self):
        Accuracy.count += 1
        case = TinyCase.copy(self.original.path, "%s/case%d" % (self.folder.name, self.count))
        case.replace(ELECTROSTATIC, "fieldMethod him;", "accuracy 0.02;")
        case.replace("0/electricPotential", "top { type fixedValue; value uniform 0; }", "top { type fixedValue; value uniform 5; }")
        result = case.run("-dry-run")
        self.assertEqual(result.code, 0, result.text)
        self.assertIn("Field method p3m", result.text)

    def test_without_a_mesh_one_plane_is_exact_and_a_cylinder_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            case = TinyCase(folder, "pairwiseSum")
            case.replace(ELECTROSTATIC, "fieldMethod pairwiseSum;", "accuracy 0.001;")
            text = case.run("-dry-run").text
            self.assertIn("accuracy: found 0.001, the smallest", text)
            case.replace(ELECTROSTATIC, "accuracy 0.001;", "accuracy 0.01;")
            result = case.run("-dry-run")
            self.assertEqual(result.code, 0, result.text)
            self.assertIn("Field method pairwiseSum", result.text)
            self.assertIn("exact here", result.text)
            case.replace("constant/couplingProperties", "lid noTransfer;", "lid grounded;")
            result = case.run("-dry-run")
            self.assertEqual(result.code, 1, result.text)
            self.assertIn("its error here is up to 0.015 (parallel walls)", " ".join(result.text.split()))
            case.replace(ELECTROSTATIC, "accuracy 0.01;", "accuracy 0.01; fieldMethod pairwiseSum; pairwiseSumCoeffs { images yes; }")
            result = case.run("-dry-run")
            self.assertEqual(result.code, 0, result.text)
            self.assertIn("expected at most 0.015. WARNING: fieldMethod wins over accuracy", result.text)
            case.replace(ELECTROSTATIC, "images yes;", "images no;")
            self.assertIn("without images, exact where there is no conductor", case.run("-dry-run").text)

    def test_entries_of_the_method_win_and_are_warned_of(self):
        _, text = self.run_with("accuracy 0.014; p3mCoeffs { gather cubic; }", "-dry-run")
        self.assertIn("clouds of 3 cells, cubic gather, deferred correction", text)
        self.assertIn("expected at most 0.055", text)
        self.assertIn("WARNING: the entries of p3mCoeffs win over accuracy", text)

    def test_cells_smaller_than_the_particles_get_larger_clouds_or_a_warning(self):
        # Cells of 10 mm and spheres of 15 mm: errors are taken as 1.5 times those of cells of a diameter.
        with tempfile.TemporaryDirectory() as folder:
            case = TinyCase(folder, "him", diameter=0.015)
            case.tool("blockMesh")
            case.replace(ELECTROSTATIC, "fieldMethod him;", "fieldMethod p3m; accuracy 0.06;")
            text = case.run("-dry-run").text
            self.assertIn("clouds of 3 cells, quartic gather, deferred correction, pairs in single precision", text)
            self.assertIn("expected at most 0.018 between plane walls without re-entrant edges, about 0.018 between curved ones, in cells of 1/1.5 of a", text)
            case.replace(ELECTROSTATIC, "accuracy 0.06;", "accuracy 0.06; p3mCoeffs { cloudCells 2; }")
            text = case.run("-dry-run").text
            self.assertIn("clouds of 2 cells", text)
            self.assertIn("expected at most 0.0825", text)
            self.assertIn("WARNING: the entries of p3mCoeffs win over accuracy", text)
            case.replace(ELECTROSTATIC, "accuracy 0.06; p3mCoeffs { cloudCells 2; }", "accuracy 0.0012;")
            text = case.run("-dry-run").text
            self.assertIn("clouds of 6 cells", text)
            self.assertIn("WARNING: no clouds are known to give as little in such cells", text)

    def test_another_method_wins_and_is_warned_of(self):
        _, text = self.run_with("accuracy 0.014; fieldMethod him;", "-dry-run")
        self.assertIn("Field method him", text)
        self.assertIn("WARNING: nothing is known of the error of these settings. Leave out fieldMethod", text)

    def test_an_accuracy_that_nothing_reaches_is_refused(self):
        _, text = self.run_with("accuracy 1e-4;", "-dry-run", code=1)
        self.assertIn("accuracy: found 0.0001, the smallest relative RMS field error that a method is known to reach is 0.0012",
                      text)

    def test_an_accuracy_that_is_not_positive_is_refused(self):
        _, text = self.run_with("accuracy -0.1;", "-dry-run", code=1)
        self.assertIn("accuracy: found -0.1, but a number above zero is expected", text)


if __name__ == "__main__":
    unittest.main()
