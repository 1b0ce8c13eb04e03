# SPDX-License-Identifier: GPL-3.0-or-later
"""A run says how wrong its own field is, against the exact field of the box."""

import tempfile
import unittest

from tiny_case import TinyCase

ELECTROSTATIC = "constant/electrostaticProperties"


def table(case):
    """Rows of fieldError.dat by column name; none when there is no file."""
    file = case.path / "postProcessing/fieldError/0/fieldError.dat"
    if not file.exists():
        return []
    lines = file.read_text().splitlines()
    names = [line for line in lines if line.startswith("#")][-1][1:].split()
    return [dict(zip(names, map(float, line.split()))) for line in lines if not line.startswith("#")]


class FieldErrorOfARun(unittest.TestCase):
    def run_case(self, method="him", entry="fieldError { interval 1; }", ranks=1):
        with tempfile.TemporaryDirectory() as folder:
            case = TinyCase(folder, method)
            case.replace(ELECTROSTATIC, "relativePermittivity 1;", "relativePermittivity 1; " + entry)
            if ranks > 1:
                case.decompose(ranks)
            result = case.run(ranks=ranks)
            return result, table(case)

    def test_is_measured_at_every_interval(self):
        result, rows = self.run_case()
        self.assertEqual(result.code, 0, result.text)
        self.assertEqual([row["Time"] for row in rows], [0, 1e-3, 2e-3])
        self.assertEqual(result.text.count("Field error: rms "), 3)
        for row in rows:
            self.assertEqual(row["sample"], 8)
            self.assertGreater(row["referenceRms"], 1e3)
            self.assertGreater(row["rms"], 1e-3)  # two of the eight touch, whose pair dominates
            self.assertLess(row["rms"], 0.5)
            self.assertGreaterEqual(row["largest"], row["rms"])

    def test_of_p3m_is_small(self):
        result, rows = self.run_case("p3m")
        self.assertEqual(result.code, 0, result.text)
        _, him = self.run_case("him")
        self.assertEqual(len(rows), 3)
        self.assertLess(rows[0]["rms"], 0.2 * him[0]["rms"])

    def test_is_the_same_on_two_ranks(self):
        _, serial = self.run_case()
        result, parallel = self.run_case(ranks=2)
        self.assertEqual(result.code, 0, result.text)
        for name in ("sample", "rms", "largest", "referenceRms"):
            self.assertAlmostEqual(parallel[0][name] / serial[0][name], 1, delta=1e-4, msg=name)

    def test_takes_the_first_field_without_an_entry(self):
        result, rows = self.run_case(entry="")
        self.assertEqual(result.code, 0, result.text)
        self.assertEqual(rows[0]["Time"], 0)

    def test_can_be_switched_off(self):
        result, rows = self.run_case(entry="fieldError { active no; }")
        self.assertEqual(result.code, 0, result.text)
        self.assertEqual(rows, [])
        self.assertNotIn("Field error", result.text)

    def test_above_the_accuracy_asked_for_is_warned_of(self):
        missed, rows = self.run_case("him", "accuracy 0.002; fieldError { interval 1; }")
        self.assertGreater(rows[0]["rms"], 0.002)
        self.assertIn("asks for accuracy 0.002 and the field has", missed.text)
        self.assertIn("Set fieldMethod to p3m", missed.text)
        met, rows = self.run_case("him", "accuracy 0.9; fieldError { interval 1; }")
        self.assertLess(rows[0]["rms"], 0.9)
        self.assertNotIn("asks for accuracy", met.text)

    def run_at_voltage(self, method, entry, interval):
        """A box with a side at 5 V, which has no exact reference: log, table, particles by tag."""
        with tempfile.TemporaryDirectory() as folder:
            case = TinyCase(folder, method)
            case.replace(ELECTROSTATIC, "relativePermittivity 1;", "relativePermittivity 1; " + entry + interval)
            case.replace("0/electricPotential", "top { type fixedValue; value uniform 0; }",
                         "top { type fixedValue; value uniform 5; }")
            case.replace("system/controlDict", "writeInterval 2;", "writeInterval 1;")
            result = case.run()
            self.assertEqual(result.code, 0, result.text)
            return result.text, table(case), case.particles("0.002")

    def test_elsewhere_is_measured_against_a_stricter_p3m_that_leaves_no_trace(self):
        for method, entry, worst in (("him", "", 0.6), ("p3m", "p3mCoeffs { cloudCells 2; }", 0.1)):
            text, rows, with_error = self.run_at_voltage(method, entry, "fieldError { interval 1; }")
            self.assertIn("measured against p3m with clouds of 3 cells", text)
            self.assertEqual(len(rows), 3)
            for row in rows:
                self.assertGreater(row["rms"], 1e-4)
                self.assertLess(row["rms"], worst)
            _, none, without = self.run_at_voltage(method, entry, "fieldError { active no; }")
            self.assertEqual(none, [])
            self.assertEqual(with_error, without)

    def test_of_images_between_planes_of_a_closed_box_is_known_without_a_mesh(self):
        with tempfile.TemporaryDirectory() as folder:
            case = TinyCase(folder, "pairwiseSum")
            case.replace(ELECTROSTATIC, "relativePermittivity 1;",
                         "relativePermittivity 1; pairwiseSumCoeffs { images yes; } fieldError { interval 1; }")
            walls = "".join("fix w%s all wall/gran model hertz tangential history cohesion charge primitive type 2 %splane %s\n"
                            % (n, axis, at) for n, (axis, at) in enumerate([("x", "0.0"), ("x", "0.1"), ("y", "0.0"), ("y", "0.1")]))
            case.replace("DEM/in.cube", "fix tribo", walls + "fix tribo")
            case.replace("constant/couplingProperties", "lid noTransfer;",
                         "lid grounded; w0 grounded; w1 grounded; w2 grounded; w3 grounded;")
            result = case.run()
            self.assertEqual(result.code, 0, result.text)
            self.assertIn("measured against the exact field in the box", result.text)
            rows = table(case)
            self.assertEqual(len(rows), 3)
            self.assertGreater(rows[0]["rms"], 1e-7)
            self.assertLess(rows[0]["rms"], 0.015)

    def test_says_where_nothing_exact_is_known(self):
        result, rows = self.run_case("pairwiseSum")
        self.assertEqual(result.code, 0, result.text)
        self.assertEqual(rows, [])
        self.assertIn("Field error: n/a, there is no exact reference for pairwiseSum here", result.text)

    def test_is_not_known_where_cells_have_another_permittivity(self):
        """p3m, which would be the reference, knows the gas only; the run itself is right, see insulating_walls_test.py."""
        with tempfile.TemporaryDirectory() as folder:
            case = TinyCase(folder)
            case.replace("system/blockMeshDict", "hex (0 1 2 3 4 5 6 7)", "hex (0 1 2 3 4 5 6 7) lower")
            case.tool("blockMesh")
            case.replace(ELECTROSTATIC, "relativePermittivity 1;",
                         "relativePermittivity 1; zonePermittivity { lower 5; } fieldError { interval 1; }")
            result = case.run()
            self.assertEqual(result.code, 0, result.text)
            self.assertEqual(table(case), [])
            self.assertIn("Field error: n/a, there is no exact reference for him here: a stricter p3m would serve, but zonePermittivity "
                          "gives cells another permittivity than the gas, and p3m knows one in all cells", result.text)
            self.assertNotIn("Field error: rms", result.text)

    def test_refuses_nonsense(self):
        result, _ = self.run_case(entry="fieldError { sample 0; interval -1; often yes; }")
        self.assertEqual(result.code, 1)
        flat = " ".join(result.text.split())
        for text in ("fieldError: sample: ", "fieldError: interval: ", "fieldError: often: unknown entry"):
            self.assertIn(text, flat)


if __name__ == "__main__":
    unittest.main(verbosity=2)
