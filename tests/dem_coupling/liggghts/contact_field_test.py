# SPDX-License-Identifier: GPL-3.0-or-later
"""Field of the others at contacts: an isolated sphere stops at q_sat whatever its own images do, at any update interval."""
import math
import unittest

from scene import EPSILON0, PTFE, Run, rayleigh_step, script

RADIUS = PTFE["radius"]
STEP = 0.05 * rayleigh_step(PTFE)
SPEED, SATURATION, KAPPA = 2.56, -6.57e-10, 100.0
GAMMA = SATURATION / (4 * math.pi * EPSILON0 * RADIUS ** 2)
CHARGING = f"fix tribo all charge/gran/contact pair 1 1 none pair 1 2 gamma {GAMMA!r} kappa {KAPPA!r}\n"
GAP = 1e-4   # [m] of free flight between the plates
PLATES = f"""fix floor all wall/gran MODEL primitive type 2 zplane 0.0
fix lid all wall/gran MODEL primitive type 2 zplane {2 * RADIUS + GAP!r}"""
INTERVALS = (1, 10, 1000)


def field(words):
    return CHARGING + "fix field all efield/him method pairwiseSum images yes " + words


class IsolatedSphere(unittest.TestCase):
    def bounce(self, line, walls, start, steps, along):
        run = Run(script([start], walls, line, step=STEP), steps, dump_every=5)
        frames = [frame[1] for frame in run.frames]
        turns = [n for n in range(1, len(frames)) if frames[n][along] * frames[n - 1][along] < 0]
        return run, frames, turns

    def test_ping_pong_between_plates_follows_the_formula_of_n_contacts_and_ends_at_saturation(self):
        start = (0.0, 0.0, RADIUS + GAP / 2, 0.0, 0.0, -SPEED, 0.0)
        for name, line in [("no field", CHARGING)] + [(f"every {n}", field(f"every {n}")) for n in INTERVALS]:
            run, frames, turns = self.bounce(line, PLATES, start, 2600, "vz")
            with self.subTest(name):
                self.assertGreater(len(turns), 15)
                # between contacts: the frame in the middle of two turns
                middle = [frames[(a + b) // 2]["q"] for a, b in zip(turns, turns[1:])]
                x = -math.log(1 - middle[0] / SATURATION)
                self.assertGreater(x, 0.4)
                for n, charge in enumerate(middle, start=1):
                    self.assertAlmostEqual(charge / SATURATION, 1 - math.exp(-n * x), delta=5e-3)
                self.assertAlmostEqual(run.charge() / SATURATION, 1, delta=5e-3)
                self.assertLess(abs(middle[3] / SATURATION), 0.95)   # saturation is approached, not begun with

    def test_in_a_cylinder_it_ends_at_saturation_too(self):
        inner = RADIUS + GAP / 2 + 1e-5
        wall = f"fix cyl all wall/gran MODEL primitive type 2 zcylinder {inner!r} 0. 0."
        start = (2e-5, 0.0, 0.0, SPEED, 0.0, 0.0, 0.0)
        for interval in INTERVALS:
            run, _, turns = self.bounce(field(f"every {interval}"), wall, start, 2600, "vx")
            with self.subTest(interval):
                self.assertGreater(len(turns), 15)
                self.assertAlmostEqual(run.charge() / SATURATION, 1, delta=2e-2)

    def test_the_image_still_pulls_at_the_sphere(self):
        # The response is left out of charging only: F = q^2/(16 pi eps0 a^2) towards the floor, so E points up at a negative charge.
        charge = -6e-10
        floor = PLATES.splitlines()[0]
        run = Run(script([(0.0, 0.0, 2e-3, 0.0, 0.0, 0.0, charge)], floor, field(""), step=STEP), 1, extra="f_field[3] f_field[10]")
        image = -charge / (16 * math.pi * EPSILON0 * 2e-3 ** 2)
        self.assertAlmostEqual(run.last[1]["f_field[3]"] / image, 1, delta=1e-6)
        self.assertEqual(run.last[1]["f_field[10]"], run.last[1]["f_field[3]"])

    def test_charges_of_others_and_their_images_still_oppose(self):
        # A fixed charge and its image in the floor, seen from the ball at the floor; kappa saturates in one contact.
        other = (6e-3, 0.0, 4e-3, 0.0, 0.0, 0.0, -2e-9)
        start = (0.0, 0.0, RADIUS + 5e-5, 0.0, 0.0, -SPEED, 0.0)
        text = script([start, other], PLATES.splitlines()[0], field("").replace(f"kappa {KAPPA!r}", "kappa 1e6"), step=STEP,
                      after="group free id 1\n")
        run = Run(text.replace("fix integrate all nve/sphere\ngroup free id 1\n", "group free id 1\nfix integrate free nve/sphere\n"),
                  int(1.6e-4 / STEP))
        coulomb = -2e-9 / (4 * math.pi * EPSILON0)
        vertical = 0.0
        for height, sign in ((4e-3, 1), (-4e-3, -1)):
            apart = RADIUS - height
            vertical += sign * coulomb * apart / (apart ** 2 + 6e-3 ** 2) ** 1.5
        gamma = run.charge(1) / (4 * math.pi * EPSILON0 * RADIUS ** 2)
        self.assertAlmostEqual((gamma - GAMMA) / vertical, 1, delta=3e-2)   # E.n = -Ez; the ball is up to 37 um off


class ContactPoint(unittest.TestCase):
    """`wallField atContactPoint`: a ball falls on a grounded floor beside a fixed charge. kappa is so large that the first steps of the
    contact move all charge, and Gamma less the drive that is left is the field of the others."""

    OTHER = (4e-3, 0.0, 2.5e-3)
    CHARGE = -2e-9

    def driven(self, where, ranks=1, words="images yes", own=0.0, every=1):
        line = f"{CHARGING.rstrip()} {where}\nfix field all efield/him method pairwiseSum {words} every {every}"
        start = (0.0, 0.0, RADIUS + 2e-6, 0.0, 0.0, -0.05, own)
        text = script([start, (*self.OTHER, 0.0, 0.0, 0.0, self.CHARGE)], PLATES.splitlines()[0],
                      line.replace(f"kappa {KAPPA!r}", "kappa 1e8"), step=STEP, after="group free id 1\n", grid=f"{ranks} 1 1")
        text = text.replace("fix integrate all nve/sphere\ngroup free id 1\n", "group free id 1\nfix integrate free nve/sphere\n")
        run = Run(text, int(4.2e-5 / STEP), ranks=ranks)
        self.assertEqual(run.code, 0, run.out[-800:])
        self.assertGreater(abs(run.charge() - own), 1e-11, "it must have touched the floor")
        return run.charge() / (4 * math.pi * EPSILON0 * RADIUS ** 2) - GAMMA   # Ez of the others

    def analytic(self, height, images=True):
        x, _, z = self.OTHER
        coulomb = self.CHARGE / (4 * math.pi * EPSILON0)
        places = ((z, 1), (-z, -1)) if images else ((z, 1),)
        return sum(sign * coulomb * (height - place) / ((height - place) ** 2 + x ** 2) ** 1.5 for place, sign in places)

    def test_the_field_at_the_contact_point_and_at_the_centre_are_the_analytic_ones(self):
        at_point, at_centre = self.analytic(0), self.analytic(RADIUS)
        self.assertGreater(abs(at_point / at_centre - 1), 0.1, "the two must differ for the test to tell")
        self.assertAlmostEqual(self.driven("wallField atContactPoint") / at_point, 1, delta=1e-3)
        self.assertAlmostEqual(self.driven("wallField centre") / at_centre, 1, delta=1e-3)

    def test_centre_is_the_default_to_the_last_bit(self):
        self.assertEqual(self.driven(""), self.driven("wallField centre"))

    def test_neither_the_own_charge_nor_its_images_count(self):
        for own in (5e-10, -9e-10):
            self.assertAlmostEqual(self.driven("wallField atContactPoint", own=own) / self.analytic(0), 1, delta=1e-3)

    def test_without_images_it_is_that_of_the_charge_and_a_uniform_field_is_added(self):
        found = self.driven("wallField atContactPoint", words="external 0 0 3e5")
        self.assertAlmostEqual(found / (self.analytic(0, images=False) + 3e5), 1, delta=1e-3)

    def test_a_truncated_sum_leaves_out_what_is_farther_than_that_from_the_contact_point(self):
        self.assertAlmostEqual(self.driven("wallField atContactPoint", words="cutoff 4.5e-3"), 0, delta=1e-3 * abs(self.analytic(0)))

    def test_it_comes_from_the_charges_that_made_a_held_field_and_is_the_same_on_two_ranks(self):
        once = self.driven("wallField atContactPoint")
        self.assertAlmostEqual(self.driven("wallField atContactPoint", every=1000) / once, 1, delta=3e-3)
        self.assertAlmostEqual(self.driven("wallField atContactPoint", ranks=2) / once, 1, delta=1e-12)

    def test_an_isolated_sphere_saturates_at_q_sat(self):
        start = (0.0, 0.0, RADIUS + GAP / 2, 0.0, 0.0, -SPEED, 0.0)
        line = field("every 10").replace(f"kappa {KAPPA!r}", f"kappa {KAPPA!r} wallField atContactPoint")
        run = Run(script([start], PLATES, line, step=STEP), 2600)
        self.assertAlmostEqual(run.charge() / SATURATION, 1, delta=5e-3)

    def test_it_is_refused_where_nobody_knows_the_field_or_where_it_does_not_count(self):
        floor = PLATES.splitlines()[0]
        for words, text in (("method directTruncation cutoff 0.01", "directTruncation gives fields at centres only. pairwiseSum and p3m have it"),
                            ("method pairwiseSum wall_contact_field self", "has nothing to act on")):
            line = f"{CHARGING.rstrip()} wallField atContactPoint\nfix field all efield/him {words}"
            run = Run(script([(0.0, 0.0, 2e-3, 0.0, 0.0, 0.0, 0.0)], floor, line, step=STEP), 1)
            self.assertNotEqual(run.code, 0)
            self.assertIn(text, " ".join(run.out.split()))


class Stability(unittest.TestCase):
    def test_a_sphere_among_twelve_never_passes_the_common_mean_at_any_kappa(self):
        # Twelve neighbours on the corners of a cuboctahedron, moving in together.
        reach = 2 * RADIUS * 1.002
        corners = [(a, b, 0) for a in (-1, 1) for b in (-1, 1)]
        corners += [(a, 0, b) for a, b, _ in corners] + [(0, a, b) for a, b, _ in corners]
        scale = reach / math.sqrt(2)
        balls = [(0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1e-10)] + [(a * scale, b * scale, c * scale, -2.0 * a, -2.0 * b, -2.0 * c, 0.0)
                                                           for a, b, c in corners]
        mean = 1e-10 / 13
        for kappa in (3600, 1e5):
            for share in (0.05, 0.4, 1.0):   # of the Rayleigh step; the last is far beyond what the motion bears
                run = Run(script(balls, "", f"fix tribo all charge/gran/contact pair 1 1 gamma 0 kappa {kappa!r} pair 1 2 none",
                                 step=share * rayleigh_step(PTFE)), int(60 / share), dump_every=1)
                with self.subTest(f"kappa {kappa}, {share} of the Rayleigh step"):
                    self.assertEqual(run.code, 0)
                    charges = [frame[1]["q"] for frame in run.frames]
                    self.assertGreaterEqual(min(charges), mean * (1 - 1e-9))
                    self.assertLess(charges[-1], 1e-10)
                    for frame in run.frames:
                        total = sum(row["q"] for row in frame.values())
                        self.assertAlmostEqual(total / 1e-10, 1, delta=1e-13)
                        self.assertLessEqual(max(frame[tag]["q"] for tag in range(2, 14)), 1e-10)

    def test_the_books_of_a_million_shaken_steps_close_to_1e_12(self):
        heap = [(-1.7e-3, 0.0, 2e-3, 0.0, 0.0, 0.0, 1e-11), (1.7e-3, 0.0, 2e-3, 0.0, 0.0, 0.0, -3e-11), (0.0, 0.0, 5.2e-3, 0.0, 0.0, 0.0, 2e-11)]
        walls = PLATES.splitlines()[0] + """
fix lid all wall/gran MODEL primitive type 2 zplane 0.009
fix cyl all wall/gran MODEL primitive type 2 zcylinder 0.0042 0. 0."""
        shaking = """variable down equal 9.81-2e-4*600*600*sin(600*step*dt)
fix g all gravity v_down vector 0 0 -1"""
        line = "fix tribo all charge/gran/contact pair 1 1 gamma 0 kappa 3600 pair 1 2 gamma -2e6 kappa 20 relaxationTime 0.5 breakdownField 2e5"
        run = Run(script(heap, walls, line, step=0.2 * rayleigh_step(PTFE), restitution=0.8, friction=0.3, before=shaking), 1000000,
                  thermo=" ".join(f"f_tribo[{n}]" for n in range(2, 8)))
        self.assertEqual(run.code, 0, run.out[-500:])
        books = [float(value) for value in run.thermo[-1][2:]]
        charges = [row["q"] for row in run.last.values()]
        scale = sum(map(abs, charges)) + sum(map(abs, books[:5]))
        self.assertGreater(books[3], -1)
        self.assertLess(books[3], 0, "charge must have leaked to ground")
        self.assertGreater(books[5], 0, "breakdown must have acted")
        self.assertLess(abs(sum(charges) + sum(books[:5])) / scale, 1e-12)   # the opening charges add to nothing


if __name__ == "__main__":
    unittest.main(verbosity=2)
