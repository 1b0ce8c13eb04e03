# SPDX-License-Identifier: GPL-3.0-or-later
"""fix enable_electric_field: a script of that command does what the fixes of himFoam do by their own names."""
import unittest

from scene import PTFE, Run, plate, rayleigh_step, script

RADIUS = PTFE["radius"]
STEP = 0.05 * rayleigh_step(PTFE)
WORK = "fix work all property/global workFunction peratomtype 7.2e-19 6.8e-19\n"
FLOOR = """fix floor all mesh/surface file floor.stl type 2 curvature 10
fix walls all wall/gran MODEL mesh n_meshes 1 meshes floor"""
LID = "\nfix lid all wall/gran MODEL primitive type 2 zplane 0.018"
FALLING = [(0.0, 0.0, RADIUS + 5e-5, 0.0, 0.0, -2.56, 0.0), (6e-3, 0.0, 5e-3, 0.0, 0.0, 0.0, 3e-11)]
STEPS = int(1.6e-4 / STEP)


def run(line, particles=FALLING, walls=FLOOR + LID, steps=STEPS, **options):
    return Run(script(particles, walls, line, step=STEP, **options), steps, files={"floor.stl": plate()}, thermo="ke")


class EnableElectricField(unittest.TestCase):
    def test_it_does_the_same_as_the_fixes_by_their_own_names_to_the_bit(self):
        by_page = run(WORK + "fix e all enable_electric_field field_cutoff_radius 0.01 enable_collision_charge_transfer yes "
                             "charge_transfer_cutoff 2e-9 limit_field_force yes field_force_limit_factor 0.5")
        own = run("fix tribo all charge/gran/contact pair 1 1 workFunctions kappa 1 pair 1 2 workFunctions kappa 1 pair 2 2 none "
                  "workFunction 1 7.2e-19 workFunction 2 6.8e-19 deltaE 2e-9\n"
                  "fix field all efield/him method directTruncation cutoff 0.01 limit_field_force yes field_force_limit_factor 0.5")
        self.assertEqual(by_page.code, 0, by_page.out[-800:])
        self.assertEqual(by_page.last, own.last)
        self.assertLess(by_page.charge(1), 0, "the higher work function of the ball charges it negatively")

    def test_the_reversed_sign_is_said_when_it_is_read(self):
        out = run(WORK + "fix e all enable_electric_field field_cutoff_radius 0.01 enable_collision_charge_transfer yes").out
        self.assertIn("The sign of (phi_i - phi_j) on the command's page is reversed", out)
        self.assertIn("near field of pairs up to 0.01 m alone, without a mesh", out)

    def test_without_charge_transfer_it_gives_the_force_only(self):
        # The examples of the page, with 'fix ID group' in front. The contact model of the scene asks for a charging fix.
        none = "fix tribo all charge/gran/contact pair 1 1 none pair 1 2 none pair 2 2 none\n"
        pair = [(-1.8e-3, 0.0, 5e-3, 0.0, 0.0, 0.0, 1e-9), (1.8e-3, 0.0, 5e-3, 0.0, 0.0, 0.0, 1e-9)]
        own = run(none + "fix field all efield/him method directTruncation cutoff 0.004", pair, steps=20)
        for words in ("", " use_without_cfd_coupling yes", " enable_collision_charge_transfer no id mine particle_group all"):
            page = run(none + "fix e all enable_electric_field field_cutoff_radius 4e-3" + words, pair, steps=20)
            with self.subTest(words):
                self.assertEqual(page.last, own.last)
                self.assertGreater(page.last[2]["vx"], 0)

    def test_primitive_walls_are_ignored_and_mesh_walls_charge_as_on_the_page(self):
        line = WORK + "fix e all enable_electric_field field_cutoff_radius 0.01 enable_collision_charge_transfer yes"
        primitive = "fix floor all wall/gran MODEL primitive type 2 zplane 0.0"
        self.assertEqual(run(line, walls=primitive).charge(1), 0)
        self.assertLess(run(line).charge(1), 0)

    def test_particle_group_limits_charging_and_force(self):
        # Only sphere 2 is in the group: sphere 1 hits the floor without charging.
        text = script(FALLING, FLOOR, WORK, step=STEP, after="group some id 2\nfix e all enable_electric_field field_cutoff_radius 0.01 "
                      "enable_collision_charge_transfer yes particle_group some\n")
        outcome = Run(text, STEPS, files={"floor.stl": plate()}, thermo="ke")
        self.assertEqual(outcome.code, 0, outcome.out[-800:])
        self.assertEqual(outcome.charge(1), 0)

    def test_what_has_no_meaning_is_refused(self):
        for text, line in {
                "field_cutoff_radius: it is obligatory": "fix e all enable_electric_field id e",
                "found -1, but a number above zero is expected [m]": "fix e all enable_electric_field field_cutoff_radius -1",
                "unknown keyword 'cutoff'; known: field_cutoff_radius, id, particle_group": "fix e all enable_electric_field cutoff 1",
                "use_without_cfd_coupling: unknown word 'maybe'; known: no, yes":
                    "fix e all enable_electric_field field_cutoff_radius 1e-3 use_without_cfd_coupling maybe",
                "'use_without_cfd_coupling no' demands the field of a mesh":
                    "fix e all enable_electric_field field_cutoff_radius 1e-3 use_without_cfd_coupling no",
                "found 0, but a number above 0 and up to 1 is expected":
                    "fix e all enable_electric_field field_cutoff_radius 1e-3 field_force_limit_factor 0",
                "it says nothing without 'enable_collision_charge_transfer yes'":
                    "fix e all enable_electric_field field_cutoff_radius 1e-3 charge_transfer_cutoff 1e-9",
                "charge transfer needs the work function of every type":
                    "fix e all enable_electric_field field_cutoff_radius 1e-3 enable_collision_charge_transfer yes",
                "there is no group 'moved'": "fix e all enable_electric_field field_cutoff_radius 1e-3 particle_group moved",
                "there is already a fix charge/gran/contact": WORK + "fix tribo all charge/gran/contact pair 1 1 none\n"
                    "fix e all enable_electric_field field_cutoff_radius 1e-3 enable_collision_charge_transfer yes"}.items():
            outcome = run(line, steps=1)
            with self.subTest(line):
                self.assertNotEqual(outcome.code, 0, outcome.out[-500:])
                self.assertIn(text, " ".join(outcome.out.split()))


if __name__ == "__main__":
    unittest.main(verbosity=2)
