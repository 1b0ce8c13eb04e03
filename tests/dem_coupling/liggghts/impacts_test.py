# SPDX-License-Identifier: GPL-3.0-or-later
"""One impact, one charge: on every kind of wall, across every kind of boundary."""
import math
import unittest

from scene import EPSILON0, PA66, PTFE, Run, plate, rayleigh_step, script, trough

# Rasera et al. 2022, Table 1, PTFE on aluminium (the 3.18 mm column is a diameter).
SPEED, CHARGE, SATURATION, KAPPA = 2.56, -1.71e-10, -6.57e-10, 9.64
GAMMA = SATURATION / (4 * math.pi * EPSILON0 * PTFE["radius"] ** 2)
CHARGING = f"fix tribo all charge/gran/contact pair 1 1 none pair 1 2 gamma {GAMMA!r} kappa {KAPPA}"
PLANE = "fix floor all wall/gran MODEL primitive type 2 zplane 0.0"
MESH = """fix floor all mesh/surface file floor.stl type 2 curvature 10
fix walls all wall/gran MODEL mesh n_meshes 1 meshes floor"""


def falling(x=0.0, y=0.0, charge=CHARGE):
    return [(x, y, PTFE["radius"] + 5e-5, 0.0, 0.0, -SPEED, charge)]


def impact(walls=PLANE, files=None, particles=None, ranks=1, charging=CHARGING, **options):
    steps = int(1.6e-4 / (0.05 * rayleigh_step(PTFE)))
    return Run(script(particles or falling(), walls, charging, **options), steps, ranks, files)


class WallImpact(unittest.TestCase):
    reference = None

    @classmethod
    def setUpClass(cls):
        cls.reference = impact().charge() - CHARGE

    def test_ptfe_on_a_rigid_wall_gains_the_charge_of_the_updated_law(self):
        # physics: updated law -2.628e-11 C (experiment -2.70e-11)
        self.assertAlmostEqual(self.reference / -2.628e-11, 1, delta=2e-3)

    def test_overlap_area_and_contact_time_are_those_of_hertz(self):
        step = 0.05 * rayleigh_step(PTFE)
        run = Run(script(falling(), PLANE, CHARGING), int(1.6e-4 / step), dump_every=1)
        heights = [frame[1]["z"] for frame in run.frames]
        overlap = PTFE["radius"] - min(heights)
        self.assertAlmostEqual(overlap / 36.7e-6, 1, delta=3e-3)
        self.assertAlmostEqual(math.pi * PTFE["radius"] * overlap / 1.832e-7, 1, delta=3e-3)
        touching = sum(height < PTFE["radius"] for height in heights) * step
        self.assertAlmostEqual(touching / 42.2e-6, 1, delta=3e-2)

    def test_the_wall_is_given_exactly_what_the_particle_lost(self):
        run = Run(script(falling(), PLANE, CHARGING), 700, thermo="f_tribo[2]")
        self.assertAlmostEqual(float(run.thermo[-1][2]) / (CHARGE - run.charge()), 1, delta=1e-14)

    def test_the_doubled_area_law_doubles_the_exponent(self):
        doubled = impact(charging=CHARGING + " area doubled").charge()
        share = lambda q: (q - SATURATION) / (CHARGE - SATURATION)
        self.assertAlmostEqual(math.log(share(doubled)), 2 * math.log(share(CHARGE + self.reference)), places=9)

    def test_a_mesh_wall_charges_like_a_primitive_wall(self):
        for name, (x, y) in {"inside a triangle": (4e-3, -3e-3), "on the diagonal": (1e-3, 1e-3), "on a corner": (0.0, 0.0)}.items():
            run = impact(MESH, {"floor.stl": plate(cells=2)}, falling(x, y))
            with self.subTest(name):
                self.assertAlmostEqual((run.charge() - CHARGE) / self.reference, 1, delta=1e-9)

    def test_facets_of_a_curved_wall_charge_like_a_smooth_one(self):
        # 64 strips of 5.6 degrees; the ball lands in the middle of a strip and in the corner between two.
        radius, facets = 0.018, 64
        wall = MESH + "\n"
        for name, turn in {"middle of a facet": 0.5, "edge between two": 0.0}.items():
            angle = 2 * math.pi * (48 + turn) / facets
            depth = radius * (math.cos(math.pi / facets) if turn else 1.0)
            # In the corner the ball rests on both strips, before it would reach the edge itself.
            reach = depth - PTFE["radius"] - 5e-5 if turn else (radius * math.cos(math.pi / facets)
                                                              - PTFE["radius"] - 5e-5) / math.cos(math.pi / facets)
            c, s = math.cos(angle), math.sin(angle)
            start = [(reach * c, 0.0, reach * s, SPEED * c, 0.0, SPEED * s, CHARGE)]
            run = impact(wall, {"floor.stl": trough(radius, facets, 0.018, 21)}, start)
            with self.subTest(name):
                self.assertAlmostEqual((run.charge() - CHARGE) / self.reference, 1, delta=5e-3)

    def test_a_ball_that_changes_rank_or_period_in_mid_contact_gains_the_same_charge(self):
        # 0.5 m/s sideways carries it over x = 0 (a rank boundary) or x = 0.02 (a periodic face) within the contact of
        # 42 us; neighbour lists are built anew in every step, so that it migrates at once.
        every_step = "neigh_modify every 1 delay 0 check no\n"
        still = impact(after=every_step).charge() - CHARGE
        scenes = {"primitive wall, rank boundary": (PLANE, -2.0e-5), "mesh wall, rank boundary": (MESH, -2.0e-5),
                  "primitive wall, periodic face": (PLANE, 0.02 - 2.0e-5)}   # LIGGGHTS meshes end at periodic faces
        for name, (walls, x) in scenes.items():
            start = [(x, 1e-4, PTFE["radius"] + 5e-5, 0.5, 0.0, -SPEED, CHARGE)]
            for ranks, grid in ((1, "1 1 1"), (2, "2 1 1"), (4, "2 2 1")):
                run = impact(walls, {"floor.stl": plate(size=0.0199, cells=7)}, start, ranks, boundary="p p f", grid=grid,
                             after=every_step)
                with self.subTest(f"{name}, {ranks} ranks"):
                    self.assertGreater(abs(run.last[1]["x"] - x), 2.0e-5, "the ball must have crossed")
                    self.assertAlmostEqual((run.charge() - CHARGE) / still, 1, delta=1e-9)

    def test_every_contact_model_combination_charges(self):
        for model in ("model hertz tangential history", "model hertz tangential no_history"):
            for rolling in ("", "rolling_friction cdt", "rolling_friction epsd2"):
                for cohesion in ("charge", "charge/sjkr"):
                    run = impact(model=model, rolling=rolling, cohesion=cohesion)
                    with self.subTest(f"{model} {rolling} {cohesion}"):
                        self.assertAlmostEqual((run.charge() - CHARGE) / self.reference, 1, delta=1e-9)

    def test_hooke_contacts_charge_too(self):
        before = "fix m8 all property/global characteristicVelocity scalar 2.0"
        for tangential in ("history", "no_history"):
            run = impact(model=f"model hooke tangential {tangential}", before=before)
            with self.subTest(tangential):
                self.assertLess(run.charge(), CHARGE)

    def test_ten_times_the_length_saturates_at_a_hundred_times_the_charge(self):
        # kappa so large that one impact saturates: q = 4 pi eps0 r^2 Gamma (R17).
        saturating = f"fix tribo all charge/gran/contact pair 1 1 none pair 1 2 gamma {GAMMA!r} kappa 1e6"
        small = impact(particles=falling(charge=0.0), charging=saturating).charge()
        big_ball = dict(PTFE, radius=10 * PTFE["radius"])
        start = [(0.0, 0.0, 10 * (PTFE["radius"] + 5e-5), 0.0, 0.0, -SPEED, 0.0)]
        big = impact(particles=start, charging=saturating, material=big_ball, box=(-0.2, 0.2)).charge()
        self.assertAlmostEqual(small / SATURATION, 1, delta=1e-12)
        self.assertAlmostEqual(big / small, 100, delta=1e-9)


class PairImpact(unittest.TestCase):
    # physics: PA66 pair, v_n = 1.71 cos(0.33) m/s, updated law 8.522e-13 C (experiment 8.57e-13)
    charging = "fix tribo all charge/gran/contact pair 1 1 gamma 0 kappa 27.79 pair 1 2 none"
    difference = 2.548e-11

    def pair(self, left, right, ranks=1, boundary="p p p", y=0.0):
        speed = 1.71 * math.cos(0.33)
        particles = [(left, y, 0.0, speed, 0.0, 0.0, self.difference), (right, y, 0.0, 0.0, 0.0, 0.0, 0.0)]
        grid = {1: "1 1 1", 2: "2 1 1", 4: "2 2 1"}[ranks]
        return Run(script(particles, "", self.charging, boundary=boundary, material=PA66, step=2e-7, grid=grid), 1500, ranks)

    def moved(self, run):
        return self.difference - run.charge(1)

    def test_pa66_pair_moves_the_charge_of_the_updated_law(self):
        run = self.pair(-1.62e-3, 1.62e-3)
        self.assertAlmostEqual(self.moved(run) / 8.522e-13, 1, delta=2e-3)
        self.assertAlmostEqual((run.charge(1) + run.charge(2)) / self.difference, 1, delta=1e-15)

    def test_overlap_and_area_of_two_spheres_are_those_of_hertz(self):
        # delta = (15 m* v^2 / (16 Y* sqrt(r*)))^0.4, A = pi r* delta
        radius, speed = PA66["radius"], 1.71 * math.cos(0.33)
        mass = 4 / 3 * math.pi * radius ** 3 * PA66["density"] / 2
        modulus = PA66["young"] / (2 * (1 - PA66["poisson"] ** 2))
        exact = (15 * mass * speed ** 2 / (16 * modulus * math.sqrt(radius / 2))) ** 0.4
        particles = [(-1.62e-3, 0.0, 0.0, speed, 0.0, 0.0, 0.0), (1.62e-3, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)]
        run = Run(script(particles, "", self.charging, material=PA66, step=2e-7), 1500, dump_every=1)
        overlap = 2 * radius - min(frame[2]["x"] - frame[1]["x"] for frame in run.frames)
        self.assertAlmostEqual(overlap / exact, 1, delta=2e-3)

    def test_a_pair_that_changes_ranks_in_mid_contact_moves_the_same_charge(self):
        # Both spheres drift over y = 0, a boundary of four ranks, while they touch; lists are built anew in every step.
        speed = 1.71 * math.cos(0.33)
        moved = {}
        for ranks, drift, grid in ((1, 0.0, "1 1 1"), (1, 0.5, "1 1 1"), (4, 0.5, "2 2 1")):
            particles = [(-1.62e-3, -3e-5, 0.0, speed, drift, 0.0, self.difference), (1.62e-3, -3e-5, 0.0, 0.0, drift, 0.0, 0.0)]
            run = Run(script(particles, "", self.charging, boundary="p p p", material=PA66, step=2e-7, grid=grid,
                             after="neigh_modify every 1 delay 0 check no\n"), 1500, ranks)
            moved[ranks, drift] = self.moved(run)
            self.assertAlmostEqual((run.charge(1) + run.charge(2)) / self.difference, 1, delta=1e-14)
        self.assertAlmostEqual(moved[1, 0.5] / moved[1, 0.0], 1, delta=1e-9)
        self.assertAlmostEqual(moved[4, 0.5] / moved[1, 0.5], 1, delta=1e-12)

    def test_rank_boundaries_change_no_bit(self):
        alone = self.pair(-1.62e-3, 1.62e-3)
        for ranks in (2, 4):
            run = self.pair(-1.62e-3, 1.62e-3, ranks)   # cut at x = 0, between the two
            with self.subTest(ranks=ranks):
                self.assertEqual(alone.last, run.last)

    def test_a_periodic_face_moves_the_same_charge(self):
        alone = self.pair(-1.62e-3, 1.62e-3)
        for ranks in (1, 2, 4):
            run = self.pair(0.0185, -0.01826, ranks)   # the same gap of 3.24 mm
            with self.subTest(ranks=ranks):
                self.assertAlmostEqual(self.moved(run) / self.moved(alone), 1, delta=1e-9)
                self.assertAlmostEqual((run.charge(1) + run.charge(2)) / self.difference, 1, delta=1e-12)

    def test_the_pair_charges_the_same_whichever_particle_comes_first(self):
        run = self.pair(-1.62e-3, 1.62e-3)
        speed = 1.71 * math.cos(0.33)
        swapped = Run(script([(1.62e-3, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0), (-1.62e-3, 0.0, 0.0, speed, 0.0, 0.0, self.difference)],
                             "", self.charging, boundary="p p p", material=PA66, step=2e-7), 1500)
        self.assertAlmostEqual(swapped.charge(2) / run.charge(1), 1, delta=1e-14)

    def test_gamma_between_types_charges_the_first_type_with_its_sign(self):
        for first, second, sign in ((1, 2, 1), (2, 1, -1)):
            charging = f"fix tribo all charge/gran/contact pair 1 1 none pair 2 2 none pair {first} {second} gamma 1e6 kappa 5"
            run = Run(script([(-1.62e-3, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0), (1.62e-3, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0)], "", charging,
                             material=PTFE, wall_material=PTFE, after="set atom 2 type 2\n"), 900)
            with self.subTest(f"pair {first} {second}"):
                self.assertGreater(sign * run.charge(1), 0)
                self.assertEqual(run.charge(1), -run.charge(2))


if __name__ == "__main__":
    unittest.main(verbosity=2)
