# SPDX-License-Identifier: GPL-3.0-or-later
"""fix constrain/plane: spheres that move in a plane and rotate about its normal only."""
import math
import unittest

from scene import PTFE, Run, rayleigh_step, script

RADIUS = PTFE["radius"]
STEP = 0.05 * rayleigh_step(PTFE)
CHARGING = "fix tribo all charge/gran/contact pair 1 1 gamma 0 kappa 50 pair 1 2 gamma -2.34e6 kappa 9.64"
FLOOR = "fix floor all wall/gran MODEL primitive type 2 zplane 0.0"
PLANE = "fix flat all constrain/plane normal 0 1 0"
SPIN = "omegax omegay omegaz"


class ConstrainedMotion(unittest.TestCase):
    def test_an_impact_in_the_plane_charges_like_one_in_three_dimensions_to_the_last_bit(self):
        # Same overlap at every step, so the same A_max and the same charge: the spheres stay spheres.
        start = [(0.0, 0.0, RADIUS + 5e-5, 0.3, 0.0, -2.56, -1.71e-10)]
        free, flat = (Run(script(start, FLOOR, CHARGING + line), 800, dump_every=1) for line in ("", "\n" + PLANE))
        self.assertLess(min(frame[1]["z"] for frame in free.frames), RADIUS - 3e-5)
        self.assertEqual([frame[1] for frame in flat.frames], [frame[1] for frame in free.frames])

    def test_a_pair_impact_in_the_plane_is_that_of_three_dimensions(self):
        pair = [(-1.62e-3, 0.0, 0.0, 1.7, 0.0, 0.1, 2.5e-11), (1.62e-3, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)]
        free, flat = (Run(script(pair, "", CHARGING + line), 1000) for line in ("", "\n" + PLANE))
        self.assertNotEqual(free.charge(2), 0)
        self.assertEqual(flat.last, free.last)

    def test_spheres_stay_in_a_tilted_plane_and_spin_about_its_normal(self):
        # Four spheres that collide in a plane through (1, 2, 3) mm, pushed out of it by gravity and their velocities.
        normal = [n / math.sqrt(14) for n in (1.0, 2.0, 3.0)]
        point = (1e-3, 2e-3, 3e-3)
        along, across = (2 / math.sqrt(5), -1 / math.sqrt(5), 0.0), None
        across = [normal[1] * along[2] - normal[2] * along[1], normal[2] * along[0] - normal[0] * along[2],
                  normal[0] * along[1] - normal[1] * along[0]]
        start = []
        for a, b in ((-4e-3, 0.0), (4e-3, 5e-4), (0.0, 4e-3), (0.0, -4.2e-3)):
            place = [p + a * u + b * w for p, u, w in zip(point, along, across)]
            speed = [-250 * (a * u + b * w) + 0.2 * n for u, w, n in zip(along, across, normal)]
            start.append((*place, *speed, 0.0))
        line = "fix flat all constrain/plane normal 2 4 6 point 1e-3 2e-3 3e-3\nfix g all gravity 9.81 vector 0 0 -1"
        for ranks in (1, 2):
            run = Run(script(start, "", CHARGING + "\n" + line, friction=0.3), 6000, ranks, extra=SPIN)
            spins = []
            for row in run.last.values():
                off = sum(n * (row[k] - p) for n, k, p in zip(normal, "xyz", point))
                leaving = sum(n * row[k] for n, k in zip(normal, ("vx", "vy", "vz")))
                spin = [row[k] for k in SPIN.split()]
                about = sum(n * s for n, s in zip(normal, spin))
                spins.append(abs(about))
                with self.subTest(ranks=ranks):
                    self.assertLess(abs(off), 1e-15)
                    self.assertLess(abs(leaving), 1e-15)
                    self.assertLess(math.dist(spin, [about * n for n in normal]), 1e-12 * max(1, abs(about)))
            self.assertGreater(max(spins), 1.0, "collisions must have set the spheres spinning")

    def test_other_fixes_may_push_out_of_the_plane_wherever_they_stand_in_the_script(self):
        push = "fix g all gravity 9.81 vector 0 1 -1"
        start = [(0.0, 0.0, 8e-3, 0.2, 0.0, 0.0, 0.0)]
        first, last = (Run(script(start, FLOOR, CHARGING + "\n" + lines), 2000) for lines in (f"{PLANE}\n{push}", f"{push}\n{PLANE}"))
        self.assertEqual(first.last[1]["y"], 0)
        self.assertEqual(first.last[1]["vy"], 0)
        self.assertLess(first.last[1]["vz"], 0)
        self.assertEqual(first.last, last.last)

    def test_spheres_outside_the_group_move_freely(self):
        start = [(-5e-3, 0.0, 8e-3, 0.0, 0.1, 0.0, 0.0), (5e-3, 0.0, 8e-3, 0.0, 0.1, 0.0, 0.0)]
        text = script(start, FLOOR, CHARGING, after="group flat id 1\nfix flat flat constrain/plane normal 0 1 0\n")
        run = Run(text, 10)
        self.assertEqual((run.last[1]["vy"], run.last[2]["vy"]), (0, 0.1))

    def test_coulomb_forces_keep_to_the_plane_and_have_the_strength_of_three_dimensions(self):
        pair = [(-4e-3, 0.0, 0.0, 0.0, 0.0, 0.0, 1e-9), (4e-3, 0.0, 0.0, 0.0, 0.0, 0.0, 1e-9)]
        walls = "fix side all wall/gran MODEL primitive type 2 zplane -0.01"
        field = CHARGING + "\nfix field all efield/him method pairwiseSum images yes"
        free, flat = (Run(script(pair, walls, field + line), 500) for line in ("", "\n" + PLANE))
        self.assertGreater(flat.last[2]["vx"], 0)
        self.assertLess(flat.last[2]["vz"], 0)   # towards the image
        self.assertEqual(flat.last, free.last)


class Refusals(unittest.TestCase):
    BALL = [(0.0, 0.0, 5e-3, 0.0, 0.0, 0.0, 0.0)]

    def refused(self, text, line, particles=None, **options):
        run = Run(script(particles or self.BALL, FLOOR, CHARGING + "\n" + line, **options), 1)
        self.assertNotEqual(run.code, 0, run.out[-800:])
        self.assertIn(text, " ".join(run.out.split()))

    def test_a_particle_off_the_plane_is_named_with_its_distance(self):
        self.refused("particle 2 at (0.008 0.0002 0.005) m is 0.0002 m off the plane with normal (0 1 0) through (0 0 0) m", PLANE,
                     self.BALL + [(8e-3, 2e-4, 5e-3, 0.0, 0.0, 0.0, 0.0)])

    def test_a_particle_that_appears_off_the_plane_later_is_named_too(self):
        self.refused("particle 2 at", PLANE, after="run 5\ncreate_atoms 1 single 0.008 0.0002 0.005 units box\n"
                                                 "set atom 2 diameter 0.003 density 2000\n")

    def test_an_error_of_rounding_is_mended(self):
        run = Run(script([(0.0, 1e-6 * RADIUS * 0.9, 5e-3, 0.0, 0.0, 0.0, 0.0)], FLOOR, CHARGING + "\n" + PLANE), 1)
        self.assertEqual(run.last[1]["y"], 0)

    def test_discs_are_refused_with_the_reason(self):
        run = Run(script(self.BALL, FLOOR, PLANE).replace("units si", "units si\ndimension 2").replace("-0.02 0.02 units", "-0.001 0.001 units")
                  .replace("boundary f f f", "boundary f f p"), 1, thermo="ke")
        self.assertNotEqual(run.code, 0)
        self.assertIn("found 'dimension 2', which makes discs of unit length", run.out)

    def test_meaningless_words_are_refused(self):
        self.refused("'normal nx ny nz' is missing", "fix flat all constrain/plane")
        self.refused("'normal' is (0 0 0)", "fix flat all constrain/plane normal 0 0 0")
        self.refused("'normal' needs three numbers", "fix flat all constrain/plane normal 0 1")
        self.refused("found 'y'", "fix flat all constrain/plane normal 0 y 0")
        self.refused("unknown keyword 'axis'; known: normal, point", "fix flat all constrain/plane axis 0 1 0")


if __name__ == "__main__":
    unittest.main(verbosity=2)
