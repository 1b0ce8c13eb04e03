# SPDX-License-Identifier: GPL-3.0-or-later
"""himField: fields of a table of particles by the methods of a case, through the program itself."""

import csv
import math
import re
import tempfile
import unittest

from tiny_case import PARTICLES, SIZE, SoundCaseTests, TinyCase

EPSILON0 = 8.8541878128e-12
ELECTROSTATIC = "constant/electrostaticProperties"


def table(particles=PARTICLES, header="x,y,z,q"):
    return header + "\n" + "".join("%r,%r,%r,%r\n" % (*position, charge) for position, _, charge in particles)


class HimField(SoundCaseTests):
    def field(self, text, *options, ranks=1):
        """Rows of the output as dictionaries of text."""
        (self.case.path / "in.csv").write_text(text)
        result = self.case.run("-particles", "in.csv", "-output", "out.csv", *options, ranks=ranks, program="himField")
        self.assertEqual(result.code, 0, result.text)
        with open(self.case.path / "out.csv", newline="") as file:
            return list(csv.DictReader(file))

    def vectors(self, *arguments, **options):
        return [tuple(float(row[name]) for name in ("Ex", "Ey", "Ez")) for row in self.field(*arguments, **options)]

    def refused(self, text, *messages, options=(), ranks=1):
        if text is not None:
            (self.case.path / "in.csv").write_text(text)
        result = self.case.run("-particles", "in.csv", *options, ranks=ranks, program="himField")
        flat = " ".join(result.text.split())
        for message in messages:
            self.assertIn(message, flat, result.text)
        self.assertEqual(result.code, 1, result.text)
        return flat

    def test_facets_of_a_curved_wall_are_no_planes_to_mirror_at(self):
        # A prism whose floor and ceiling are bent in the middle, by 44 degrees.
        self.case.write("system/blockMeshDict", """scale 0.1;
            vertices ((0 0 0.2) (0.5 0 0) (0.5 1 0) (0 1 0.2) (0 0 0.8) (0.5 0 1) (0.5 1 1) (0 1 0.8) (1 0 0.2) (1 1 0.2) (1 0 0.8) (1 1 0.8));
            blocks (hex (0 1 2 3 4 5 6 7) (5 10 10) simpleGrading (1 1 1) hex (1 8 9 2 5 10 11 6) (5 10 10) simpleGrading (1 1 1));
            boundary (
                bottom { type wall; faces ((0 3 2 1) (1 2 9 8)); } top { type wall; faces ((4 5 6 7) (5 10 11 6)); }
                sides { type wall; faces ((0 4 7 3) (8 9 11 10) (0 1 5 4) (1 8 10 5) (3 7 6 2) (2 6 11 9)); } );""")
        self.case.tool("blockMesh")
        self.case.replace(ELECTROSTATIC, "relativePermittivity 1;",
                          "relativePermittivity 1; mirrored { fieldMethod pairwiseSum; images yes; }")
        (self.case.path / "in.csv").write_text("x,y,z,q\n0.04,0.05,0.05,1e-9\n0.06,0.05,0.04,-1e-9\n")
        result = self.case.run("-particles", "in.csv", "-compare", "-methods", "(mirrored)", program="himField")
        self.assertIn("no images: the walls are curved", " ".join(result.text.split()))

    def assert_same(self, left, right, tolerance):
        scale = math.sqrt(sum(e * e for row in left for e in row) / len(left))
        self.assertEqual(len(left), len(right))
        for one, other in zip(left, right):
            self.assertLess(max(abs(a - b) for a, b in zip(one, other)), tolerance * scale)

    # --- values

    def test_the_field_is_that_of_himfoam_for_the_same_particles(self):
        still = {"DEM/in.cube": ("fix move all nve/sphere\n", ""), "system/controlDict": ("writeInterval 2;", "writeInterval 1;")}
        for file, change in still.items():
            self.case.replace(file, *change)
        self.case.replace("system/controlDict", "endTime 2e-3; deltaT 1e-3;", "endTime 1e-5; deltaT 1e-5;")
        result = self.case.run()
        self.assertEqual(result.code, 0, result.text)
        particles = self.case.particles("1e-05")
        charged = [((*position,), velocity, particles[tag]["charge"]) for tag, (position, velocity, _) in enumerate(PARTICLES, 1)]
        self.assert_same(self.vectors(table(charged)), [particles[tag]["electricField"] for tag in sorted(particles)], 1e-12)

    def test_two_charges_have_their_coulomb_field_potential_and_the_external_field(self):
        rows = self.field("x,y,z,q\n0.03,0.05,0.05,1e-9\n0.07,0.05,0.05,-2e-9\n", "-method", "pairwiseSum")
        unit = 1e-9 / (4 * math.pi * EPSILON0)
        self.assertAlmostEqual(float(rows[0]["Ex"]) / (2 * unit / 0.04**2), 1, delta=1e-9)
        self.assertAlmostEqual(float(rows[1]["Ex"]) / (unit / 0.04**2), 1, delta=1e-9)
        self.assertAlmostEqual(float(rows[0]["Ez"]), 1000, delta=1e-6)
        self.assertAlmostEqual(float(rows[1]["V"]) / (unit / 0.04 - 1000 * 0.05), 1, delta=1e-9)

    def test_a_method_without_a_potential_writes_nan(self):
        self.assertEqual({row["V"] for row in self.field(table(), "-method", "him")}, {"nan"})

    # --- comparison

    def compared(self, text, *options, ranks=1):
        """Rows of the comparison by name."""
        (self.case.path / "in.csv").write_text(text)
        result = self.case.run("-particles", "in.csv", "-compare", *options, ranks=ranks, program="himField")
        self.assertEqual(result.code, 0, result.text)
        folder = self.case.path / "postProcessing/himField"
        self.assertIn("RMS error", (folder / "compare.txt").read_text())
        with open(folder / "compare.csv", newline="") as file:
            return {row["name"]: row for row in csv.DictReader(file)}

    def test_a_comparison_lists_every_method_and_variant_with_times_or_the_reason_why_not(self):
        self.case.replace(ELECTROSTATIC, "fieldMethod him;", "fieldMethod him; wide { fieldMethod him; nearCutoff 0.04; } "
                          "toShort { fieldMethod him; nearCutoff 0.01; }")
        for ranks in (1, 2):
            if ranks > 1:
                self.case.decompose(ranks)
            rows = self.compared(table(), "-repeat", "2", ranks=ranks)
            known = re.search("known: ([^.]*)", self.refused(table(), options=("-method", "hum"))).group(1).split(", ")
            self.assertEqual(list(rows), known)
            self.assertIn("below the largest cell diagonal", rows.pop("toShort")["left_out"])
            for name in ("pairwiseSum", "directTruncation", "him", "p3m", "wide"):
                row = rows[name]
                self.assertEqual((row["left_out"], row["rounds"], row["ranks"]), ("", "2", str(ranks)))
                for start in ("cold", "warm"):
                    phases = sum(float(row["%s_%s_s" % (start, phase)]) for phase in ("near", "deposit", "solve", "gather", "exchange"))
                    # Each phase is that of the slowest rank in it, inside the call of that rank. Medians of two calls are their means.
                    self.assertGreater(phases, 0)
                    self.assertLessEqual(phases, ranks * float(row[start + "_total_s"]) * (1 + 1e-4))
                self.assertGreater(float(row["rms_error"]), 1e-3)
                self.assertGreater(float(row["largest_error"]), float(row["rms_error"]))
            self.assertGreater(float(rows["wide"]["pairs_per_particle"]), float(rows["him"]["pairs_per_particle"]))
            self.assertGreater(float(rows["him"]["cold_solve_s"]), float(rows["him"]["cold_near_s"]))
        try:
            import matplotlib  # noqa: F401
        except ImportError:
            return
        self.assertGreater((self.case.path / "postProcessing/himField/compare.png").stat().st_size, 5000)

    def test_a_list_restricts_the_comparison(self):
        self.assertEqual(list(self.compared(table(), "-methods", "(him directTruncation)", "-repeat", "1")),
                         ["directTruncation", "him"])

    def test_the_error_in_a_grounded_box_is_that_against_the_exact_field(self):
        charge = 1e-9
        one = "x,y,z,q\n%r,%r,%r,%r\n" % (0.25 * SIZE, 0.5 * SIZE, 0.5 * SIZE, charge)
        self.case.replace(ELECTROSTATIC, "externalField (0 0 1000);", "externalField (0 0 0);")
        exact = -3.09959 * charge / (4 * math.pi * EPSILON0 * SIZE**2)
        field = self.vectors(one, "-method", "him")[0]
        error = math.hypot(field[0] - exact, field[1], field[2]) / abs(exact)
        row = self.compared(one, "-methods", "him", "-repeat", "1")["him"]
        self.assertIn("exact", row["reference"])
        self.assertGreater(error, 0.01)
        self.assertAlmostEqual(float(row["rms_error"]), error, delta=1e-4)
        self.assertAlmostEqual(float(row["rms_error_V_per_m"]) / (error * abs(exact)), 1, delta=1e-3)

    def test_without_a_mesh_the_sum_over_all_pairs_is_the_reference(self):
        with tempfile.TemporaryDirectory() as folder:
            self.case = TinyCase(folder, method="directTruncation")
            exact = self.vectors(table(), "-method", "pairwiseSum")
            difference = [[a - b for a, b in zip(one, other)] for one, other in zip(self.vectors(table()), exact)]
            ours = [[a - b for a, b in zip(row, (0, 0, 1000))] for row in exact]
            rms = math.sqrt(sum(e * e for row in difference for e in row) / sum(e * e for row in ours for e in row))
            rows = self.compared(table(), "-repeat", "1")
            self.assertAlmostEqual(float(rows["directTruncation"]["rms_error"]) / rms, 1, delta=1e-6)
            self.assertLess(float(rows["pairwiseSum"]["rms_error"]), 1e-12)
            self.assertIn("needs a mesh", rows["him"]["left_out"])

    def test_options_that_do_not_fit_are_refused(self):
        self.refused(table(), "-output: the option is for one field", options=("-compare", "-output", "out.csv"))
        self.refused(table(), "-methods: the option is for -compare", "-repeat: the option is for -compare",
                     options=("-methods", "him", "-repeat", "2"))

    # --- the table

    def test_rows_keep_their_order_and_text_in_any_order_of_columns(self):
        plain = self.vectors(table())
        lines = ["# a snapshot", "name,q, z,y ,x,radius"]
        lines += ["p%d,%r,%r,%r,%r,0.002" % (n, charge, *reversed(position)) for n, (position, _, charge) in enumerate(PARTICLES)]
        lines.insert(4, "")
        lines = lines[:2] + lines[:1:-1]  # the particles backwards
        rows = self.field("\r\n".join(lines) + "\r\n")
        self.assertEqual([row["name"] for row in rows], ["p%d" % n for n in reversed(range(len(PARTICLES)))])
        self.assertEqual((self.case.path / "out.csv").read_text().splitlines()[1].split(",")[:6], lines[2].split(","))
        self.assert_same(plain, [tuple(float(row[e]) for e in ("Ex", "Ey", "Ez")) for row in reversed(rows)], 1e-12)

    def test_any_number_of_ranks_gives_the_same_rows(self):
        for method in ("him", "p3m", "pairwiseSum", "directTruncation"):
            serial = self.vectors(table(), "-method", method)
            for ranks in (2, 4):
                self.case.decompose(ranks)
                self.assert_same(serial, self.vectors(table(), "-method", method, ranks=ranks), 1e-9)

    def test_the_output_has_a_default_place(self):
        (self.case.path / "in.csv").write_text(table())
        result = self.case.run("-particles", "in.csv", program="himField")
        self.assertEqual(result.code, 0, result.text)
        self.assertEqual(len((self.case.path / "postProcessing/himField/field.csv").read_text().splitlines()), 9)

    # --- methods

    def test_a_variant_of_the_case_is_known_by_its_name(self):
        self.case.replace(ELECTROSTATIC, "fieldMethod him;", "fieldMethod him; short { fieldMethod directTruncation; nearCutoff 0.02; }")
        self.assert_same(self.vectors(table(), "-method", "short"), self.vectors(table(), "-method", "directTruncation"), 1e-15)

    def test_a_method_without_settings_takes_the_cell_diagonal_as_cutoff(self):
        self.case.replace(ELECTROSTATIC, "himCoeffs { nearCutoff 0.02; }", "near { fieldMethod him; nearCutoff 0.0173205080756888; } "
                          "wide { fieldMethod him; nearCutoff 0.06; }")
        self.case.replace(ELECTROSTATIC, "fieldMethod him;\n", "fieldMethod pairwiseSum;\n")
        default = self.vectors(table(), "-method", "him")
        self.assert_same(default, self.vectors(table(), "-method", "near"), 1e-12)
        self.assertNotEqual(default, self.vectors(table(), "-method", "wide"))

    def test_a_cutoff_below_the_cell_diagonal_is_refused(self):
        self.case.replace(ELECTROSTATIC, "fieldMethod him;", "fieldMethod him; short { fieldMethod him; nearCutoff 0.01; }")
        self.refused(table(), "0.01 m is below the largest cell diagonal, 0.0173205 m", options=("-method", "short"))

    def test_a_case_without_a_mesh_serves_methods_that_need_none(self):
        with tempfile.TemporaryDirectory() as folder:
            expected = self.vectors(table(), "-method", "directTruncation")
            self.case = TinyCase(folder, method="directTruncation")
            self.assert_same(self.vectors(table()), expected, 1e-15)
            self.refused(table(), "there is no mesh", options=("-method", "him"))

    def test_unknown_method_lists_methods_and_variants(self):
        self.case.replace(ELECTROSTATIC, "fieldMethod him;", "fieldMethod him; short { fieldMethod directTruncation; nearCutoff 0.02; }")
        self.refused(table(), "unknown name `hum`; known: pairwiseSum, directTruncation,", ", short.", options=("-method", "hum"))

    def test_a_misspelt_entry_of_a_variant_is_refused(self):
        self.case.replace(ELECTROSTATIC, "fieldMethod him;", "fieldMethod him; short { fieldMethod directTruncation; nearCutof 1; }")
        self.refused(table(), "short: nearCutof: unknown entry", "short: nearCutoff: the entry is missing")

    # --- bad tables

    def test_no_such_file(self):
        self.refused(None, "in.csv: the file of the particles cannot be opened")

    def test_empty_file(self):
        self.refused("", "in.csv: the file is empty")

    def test_header_only(self):
        self.refused("x,y,z,q\n\n", "in.csv: there is no particle below the header")

    def test_missing_column_shows_the_header(self):
        self.refused("x,y,charge\n0,0,0\n", "in.csv: line 1: there is no column `z`. Found the header `x,y,charge`", "no column `q`")

    def test_column_that_is_there_twice(self):
        self.refused("x,y,z,q,x\n0,0,0,0,0\n", "line 1: the column `x` is there twice")

    def test_column_of_the_output(self):
        self.refused("x,y,z,q,Ex\n0,0,0,0,0\n", "line 1: the column `Ex` is one that the output gets")

    def test_everything_wrong_with_the_lines_is_said_at_once(self):
        lines = ["x,y,z,q,radius", "0.01,0.01,0.01,1e-9,0.001", "0.02,0.02,0.02", "0.02,left,0.02,1e-9,0.001",
                 "0.02,0.02,nan,1e-9,0.001", "0.02,0.02,0.02,inf,0.001", "0.02,0.02,0.02,,0.001", "0.02,0.02,0.02,1e-9,0",
                 "0.02,0.02,0.2,1e-9,0.001", "0.01,0.01,0.01,2e-9,0.001", "0.03,0.03,0.03,1e-9 C,0.001"]
        for ranks in (1, 2):
            if ranks > 1:
                self.case.decompose(ranks)
            text = self.refused("\n".join(lines),
                                "line 3 (particle 2): found 3 values, but the header has 5 columns",
                                "line 4 (particle 3): y: found `left`, but a number is expected",
                                "line 5 (particle 4): z: found `nan`, but a finite number is expected",
                                "line 6 (particle 5): q: found `inf`, but a finite number is expected",
                                "line 7 (particle 6): q: found ``, but a number is expected",
                                "line 8 (particle 7): radius: found `0`, but a number above zero is expected",
                                "line 9 (particle 8): the particle at (0.02 0.02 0.2) m is in no cell of the mesh, which covers "
                                "(0 0 0) to (0.1 0.1 0.1) m",
                                "line 10 (particle 9): the particle is at the same position as that of line 2 (particle 1)",
                                "line 11 (particle 10): q: found `1e-9 C`, but a number is expected", ranks=ranks)
            self.assertIn("9. in.csv", text)
            self.assertNotIn("10. in.csv", text)

    def test_a_long_list_of_faults_is_cut(self):
        text = self.refused("x,y,z,q\n" + "0,0\n" * 50, "line 21 (particle 20)", "and 30 more faulty lines")
        self.assertNotIn("line 22", text)

    def test_missing_option(self):
        result = self.case.run(program="himField")
        self.assertEqual(result.code, 1)
        self.assertIn("-particles: the option is missing", result.text)


if __name__ == "__main__":
    unittest.main(verbosity=2)
