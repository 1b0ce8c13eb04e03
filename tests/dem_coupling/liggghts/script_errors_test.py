# SPDX-License-Identifier: GPL-3.0-or-later
"""A wrong script gets one clear sentence, also when the output goes to a file."""
import unittest

from scene import PTFE, Run, rayleigh_step, script

BALL = [(0.0, 0.0, 2e-3, 0.0, 0.0, -1.0, 0.0)]
WALL = "fix floor all wall/gran MODEL primitive type 2 zplane 0.0"
GOOD = "fix tribo all charge/gran/contact pair 1 1 none pair 1 2 gamma -1e6 kappa 10"


class ScriptErrors(unittest.TestCase):
    def refused(self, text, charging, **options):
        run = Run(script(BALL, WALL, charging, **options), 1)
        self.assertNotEqual(run.code, 0, run.out[-800:])
        self.assertIn(text, run.out)

    def test_the_good_script_runs(self):
        run = Run(script(BALL, WALL, GOOD), 1)
        self.assertEqual(run.code, 0, run.out[-800:])

    def test_unknown_keywords_list_the_known_ones(self):
        self.refused("unknown keyword 'gama'; known: pair, area, reloading, curvature", GOOD + " gama 3")
        self.refused("unknown contact area law \"hert\"; known: hertz, doubled", GOOD + " area hert")
        self.refused("unknown reloading 'never'; known: counted, beyondMaximum", GOOD + " reloading never")
        self.refused("after 'pair I J' comes 'gamma <V/m> kappa <->' or 'none', found 'kappa'",
                     "fix tribo all charge/gran/contact pair 1 1 kappa 3")

    def test_missing_words_say_what_is_missing(self):
        self.refused("something is missing after 'kappa'", "fix tribo all charge/gran/contact pair 1 2 gamma 1 kappa")
        self.refused("expected 'kappa' after 'gamma <V/m>', found 'pair'",
                     "fix tribo all charge/gran/contact pair 1 2 gamma 1 pair 1 1 none")

    def test_pairs_without_gamma_are_listed_together(self):
        more = [(x, 0.0, 5e-3, 0.0, 0.0, 0.0, 0.0) for x in (0.0, 0.01)]
        run = Run(script(BALL + more, WALL, "fix tribo all charge/gran/contact pair 2 2 none", after="set atom 2 type 2\n"), 1)
        self.assertNotEqual(run.code, 0)
        for types in ("1 and 1", "1 and 2"):
            self.assertIn(f"Gamma and kappa are missing for types {types}, which can touch. Add 'pair", run.out)
        self.assertNotIn("types 2 and 2", run.out)

    def test_a_type_that_is_not_there_yet_is_warned_of(self):
        run = Run(script(BALL, "", "fix tribo all charge/gran/contact pair 1 1 none"), 1)
        self.assertEqual(run.code, 0, run.out[-800:])
        self.assertEqual(run.out.count("WARNING: no charge will move between these, should such particles be inserted"), 1)
        self.assertIn("types 1 and 2", run.out)
        run = Run(script(BALL, WALL, GOOD), 1)
        self.assertNotIn("WARNING", run.out)

    def test_a_time_step_that_misses_the_largest_overlap_is_warned_of(self):
        for share, warned in ((0.2, False), (0.25, True)):
            run = Run(script(BALL, WALL, GOOD, step=share * rayleigh_step(PTFE)), 1)
            self.assertEqual(run.code, 0, run.out[-800:])
            with self.subTest(share):
                self.assertEqual("is 25 % of the shortest Rayleigh step" in run.out, warned)
                self.assertEqual("WARNING" in run.out, warned)

    def test_numbers_that_make_no_sense_are_refused(self):
        self.refused("kappa must be a finite number >= 0, found -3", "fix tribo all charge/gran/contact pair 1 2 gamma 1 kappa -3")
        self.refused("there is no type 7; the box has types 1 to 2", "fix tribo all charge/gran/contact pair 1 7 none")
        self.refused("gamma must be 0 between equal types", "fix tribo all charge/gran/contact pair 1 1 gamma 5 kappa 1")
        self.refused("pair 2 1 is given twice", GOOD + " pair 2 1 none")
        self.refused("curvature must be an angle between 0 and 90 degrees", GOOD + " curvature 0")

    def test_a_negative_radius_is_refused(self):
        text = script(BALL, WALL, GOOD).replace(f"diameter {2 * PTFE['radius']!r}", "diameter -0.001")
        run = Run(text, 1)
        self.assertNotEqual(run.code, 0)
        self.assertIn("ERROR", run.out)

    def test_charged_spheres_are_demanded_by_the_line_to_write(self):
        text = script(BALL, WALL, GOOD).replace("atom_style hybrid granular charge", "atom_style granular")
        run = Run(text, 1)
        self.assertNotEqual(run.code, 0)
        self.assertIn("write 'atom_style hybrid granular charge'", run.out)

    def test_discs_are_refused_with_the_line_to_write(self):
        text = script(BALL, WALL, GOOD).replace("units si", "units si\ndimension 2").replace("-0.02 0.02 units", "-0.001 0.001 units")
        run = Run(text.replace("boundary f f f", "boundary f f p"), 1)
        self.assertNotEqual(run.code, 0)
        self.assertIn("found 'dimension 2', which makes discs of unit length", run.out)
        self.assertIn("fix constrain/plane", run.out)

    def test_a_contact_model_that_records_needs_the_fix(self):
        run = Run(script(BALL, WALL, ""), 1, thermo="ke")
        self.assertNotEqual(run.code, 0)
        self.assertIn("contact model 'cohesion charge' needs a 'fix <id> all charge/gran/contact ...'", run.out)

    def test_a_second_charging_fix_is_refused(self):
        self.refused("there is already a fix charge/gran/contact", GOOD + "\nfix again all charge/gran/contact pair 1 1 none")

    def test_an_unknown_contact_model_stops_the_run(self):
        run = Run(script(BALL, WALL.replace("MODEL", "model thornton_ning cohesion charge"), GOOD,
                         model="model thornton_ning tangential history"), 1)
        self.assertNotEqual(run.code, 0)
        self.assertIn("ERROR", run.out)


if __name__ == "__main__":
    unittest.main(verbosity=2)
