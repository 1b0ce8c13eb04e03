# SPDX-License-Identifier: GPL-3.0-or-later
"""Laws and options of fix charge/gran/contact in scenes: impacts, walls, losses, initial charges, limiter."""
import math
import re
import unittest

from scene import EPSILON0, PTFE, Run, rayleigh_step, script

RADIUS = PTFE["radius"]
STEP = 0.05 * rayleigh_step(PTFE)
SPEED, CHARGE, SATURATION, KAPPA = 2.56, -1.71e-10, -6.57e-10, 9.64   # R Table 1, PTFE on aluminium
PLANE = "fix floor all wall/gran MODEL primitive type 2 zplane 0.0"
FIX = "fix tribo all charge/gran/contact pair 1 1 none "
FALLING = [(0.0, 0.0, RADIUS + 5e-5, 0.0, 0.0, -SPEED, CHARGE)]
RESTING = [(0.0, 0.0, 5e-3, 0.0, 0.0, 0.0, 0.0)]
EV = 1.602176634e-19
IMPACT = int(1.6e-4 / STEP)


def gamma_of(charge, radius=RADIUS):
    return charge / (4 * math.pi * EPSILON0 * radius ** 2)


def impact(words, particles=FALLING, **options):
    return Run(script(particles, PLANE, FIX + words, step=STEP, **options), IMPACT)


class Laws(unittest.TestCase):
    def test_every_way_to_give_one_gamma_charges_an_impact_alike(self):
        reference = impact(f"pair 1 2 gamma {gamma_of(SATURATION)!r} kappa {KAPPA}").charge() - CHARGE
        self.assertAlmostEqual(reference / -2.628e-11, 1, delta=2e-3)
        density = SATURATION / (4 * math.pi * RADIUS ** 2)
        difference = -gamma_of(SATURATION) * 500e-9 * EV
        laws = {"R17 with the pair": f"pair 1 2 saturationCharge {SATURATION!r} radius {RADIUS!r} kappa {KAPPA}",
                "R17, wall first": f"pair 2 1 saturationCharge {-SATURATION!r} radius {RADIUS!r} kappa {KAPPA}",
                "R19": f"pair 1 2 sizeLaw {density / 2!r} {gamma_of(SATURATION) / 2 * RADIUS!r} kappa {KAPPA}",
                "R18": f"pair 1 2 saturation kappa {KAPPA} saturationCharge 1 {SATURATION!r} radius {RADIUS!r}",
                "work functions in J": f"pair 1 2 workFunctions kappa {KAPPA} workFunction 1 {7e-19 + difference!r} workFunction 2 7e-19",
                "in eV, other deltaE": f"pair 1 2 workFunctions kappa {KAPPA} deltaE 250e-9 workFunctionEV 1 {4.0 + difference / EV / 2!r} "
                                       "workFunctionEV 2 4.0"}
        for name, words in laws.items():
            run = impact(words)
            with self.subTest(name):
                self.assertAlmostEqual((run.charge() - CHARGE) / reference, 1, delta=1e-9)

    def test_the_log_describes_laws_and_options_before_the_first_step(self):
        run = impact(f"pair 1 2 sizeLaw -7e-6 -800 kappa {KAPPA} acceleration 10 update frozen ownImage included relaxationTime 3 "
                     "breakdownField 3e6 spread 1 gamma 1e5 seed 4 realModulus 1 1e12 wall floor conductor")
        text = " ".join(run.out.split())
        for words in ("types 1 and 2: Gamma -790586 V/m + -800 V/radius of type 1 (for type 1, from saturation at the wall, R17 R19), kappa 9.64, "
                      "a_corr", "types 1 and 1: no charge transfer", "update frozen, own image at walls included",
                      "ACCELERATED: every charge transfer is multiplied by a = 10", "leakage to ground, relaxation time 3 s",
                      "breakdown above a surface field of 3e+06 V/m",
                      "spread over the particles of type 1: standard deviation 100000 V/m of Gamma, seed 4"):
            self.assertIn(words, text)
        self.assertLess(run.out.index("Contact charging, fix tribo"), re.search(r"\n *Step ", run.out).start())
        self.assertIn("Contact charging was ACCELERATED by a = 10", re.split(r"\n *Step ", run.out)[1])

    def test_a_wall_named_none_transfers_nothing(self):
        words = f"pair 1 2 gamma {gamma_of(SATURATION)!r} kappa {KAPPA} wall floor "
        self.assertEqual(impact(words + "none").charge(), CHARGE)
        self.assertLess(impact(words + "conductor").charge(), CHARGE)


class Options(unittest.TestCase):
    WALL = f"pair 1 2 gamma {gamma_of(SATURATION)!r} kappa {KAPPA} "

    def exponent(self, words):
        q = impact(self.WALL + words).charge()
        return -math.log((q - SATURATION) / (CHARGE - SATURATION))

    def test_frozen_moves_the_charge_of_the_frozen_law(self):
        # physics: PTFE/Al frozen -2.702e-11 C; x is that of the updated law's exponent
        x = self.exponent("")
        run = impact(self.WALL + "update frozen")
        self.assertAlmostEqual((run.charge() - CHARGE) / -2.702e-11, 1, delta=2e-3)
        self.assertAlmostEqual((run.charge() - CHARGE) / (x * (SATURATION - CHARGE)), 1, delta=1e-9)
        self.assertNotIn("passed x", run.out)

    def test_frozen_ignores_what_a_pair_contact_has_moved(self):
        # Two equal spheres with charges +q and 0: updated moves q/2 (1 - exp(-2x)), frozen x q of the charges before the impact.
        def change(words):
            apart = RADIUS + 1e-6
            balls = [(-apart, 0.0, 5e-3, SPEED / 2, 0.0, 0.0, 1e-11), (apart, 0.0, 5e-3, -SPEED / 2, 0.0, 0.0, 0.0)]
            fix = "fix tribo all charge/gran/contact pair 1 1 gamma 0 kappa 40 pair 1 2 none " + words
            run = Run(script(balls, PLANE, fix, step=STEP), IMPACT)
            self.assertAlmostEqual(run.charge(1) + run.charge(2), 1e-11, delta=1e-23)
            return run.charge(2)

        x = -math.log(1 - 2 * change("") / 1e-11) / 2
        self.assertGreater(x, 0.1)
        self.assertAlmostEqual(change("update frozen") / (x * 1e-11), 1, delta=1e-9)

    def test_frozen_is_refused_after_the_first_run(self):
        late = script(FALLING, PLANE, FIX + "pair 1 2 none", step=STEP)
        late += "run 1\nunfix tribo\n" + FIX + self.WALL + "update frozen\n"
        run = Run(late, 1)
        self.assertNotEqual(run.code, 0)
        self.assertIn("Write this fix before it", run.out)

    def test_a_fix_written_again_between_two_runs_goes_on_with_its_own_law(self):
        # Two spheres meet; the second charging fix takes over before they touch, or in mid-contact. Each law moves a share of the charge
        # difference that depends on the motion alone, so that after the change the difference falls by the same factor as without.
        pair = [(-1.6e-3, 0.0, 0.0, 0.5, 0.0, 0.0, 1e-10), (1.6e-3, 0.0, 0.0, -0.5, 0.0, 0.0, 0.0)]
        fix = "fix tribo all charge/gran/contact pair 1 1 gamma 0 kappa 50 pair 1 2 none pair 2 2 none update "

        def differences(first, second, before, unfix=""):
            run = Run(script(pair, "", fix + first, step=STEP, after=f"run {before}\n{unfix}{fix}{second}\n"), 350, dump_every=before)
            self.assertEqual(run.code, 0, run.out[-1500:])
            return [frame[1]["q"] - frame[2]["q"] for frame in (run.frames[0], run.last)]

        def unchanged(law, before):
            run = Run(script(pair, "", fix + law, step=STEP, after=f"run {before}\n"), 350, dump_every=before)
            return [frame[1]["q"] - frame[2]["q"] for frame in (run.frames[0], run.last)]

        for before in (5, 50):
            updated, frozen = unchanged("updated", before), unchanged("frozen", before)
            self.assertEqual(before == 50, updated[0] != frozen[0], "fifty steps reach into the contact, five do not")
            self.assertNotEqual(updated[1], frozen[1])
            for unfix in ("", "unfix tribo\n"):
                with self.subTest(before=before, unfix=unfix):
                    self.assertEqual(differences("updated", "updated", before, unfix), updated)
                    self.assertEqual(differences("frozen", "frozen", before, unfix), frozen)
                    mixed = differences("frozen", "updated", before, unfix)
                    self.assertEqual(mixed[0], frozen[0])
                    self.assertAlmostEqual(mixed[1] / mixed[0] / (updated[1] / updated[0]), 1, delta=1e-12)

    def test_frozen_warns_above_one_half_and_overshoots_as_the_law_says(self):
        x = self.exponent("") * 1e3 / KAPPA
        run = impact(f"pair 1 2 gamma {gamma_of(SATURATION)!r} kappa 1e3 update frozen")
        self.assertGreater(x, 1)
        self.assertAlmostEqual((run.charge() - CHARGE) / (x * (SATURATION - CHARGE)), 1, delta=1e-9)
        self.assertIn("WARNING: 1 contacts passed x = kappa A/(4 pi r^2) = 0.5 under 'update frozen'", run.out)

    def test_frozen_pairs_swap_where_kappa_says_so_on_one_and_two_ranks(self):
        # A pair of equal spheres at x: the lower tag loses x times the difference.
        pair = [(-1.62e-3, 0.0, 0.0, 0.8, 0.0, 0.0, 3e-11), (1.62e-3, 0.0, 0.0, -0.8, 0.0, 0.0, 0.0)]
        moved = {}
        for update in ("updated", "frozen"):
            for ranks, grid in ((1, "1 1 1"), (2, "2 1 1")):
                run = Run(script(pair, "", f"fix tribo all charge/gran/contact pair 1 1 gamma 0 kappa 300 pair 1 2 none update {update}",
                                 step=STEP, grid=grid), 2 * IMPACT, ranks)
                moved[update, ranks] = (3e-11 - run.charge(1)) / 3e-11
                self.assertAlmostEqual((run.charge(1) + run.charge(2)) / 3e-11, 1, delta=1e-14)
        self.assertEqual(moved["frozen", 1], moved["frozen", 2])
        x = -0.5 * math.log(1 - 2 * moved["updated", 1])
        self.assertGreater(x, 0.01)
        self.assertAlmostEqual(moved["frozen", 1] / x, 1, delta=1e-9)

    def test_own_image_doubles_the_exponent_and_halves_saturation(self):
        x = self.exponent("")
        q = impact(self.WALL + "ownImage included").charge()
        self.assertAlmostEqual(-math.log((q - SATURATION / 2) / (CHARGE - SATURATION / 2)) / (2 * x), 1, delta=1e-9)
        q = impact(f"pair 1 2 gamma {gamma_of(SATURATION)!r} kappa 1e6 ownImage included").charge()
        self.assertAlmostEqual(q / (SATURATION / 2), 1, delta=1e-12)

    def test_acceleration_multiplies_the_exponent(self):
        self.assertAlmostEqual(self.exponent("acceleration 3") / self.exponent(""), 3, delta=1e-9)

    def test_real_moduli_give_the_corrections_of_the_fluidized_bed(self):
        # S2.12: soft 0.1 MPa, real 0.5 and 74 GPa, nu 0.46 and 0.22: a_corr 0.0331 between particles, 0.0242 at the wall.
        soft = dict(PTFE, young=1e5, poisson=0.46)
        text = script(RESTING, PLANE, "fix tribo all charge/gran/contact pair 1 1 gamma 0 kappa 1 pair 1 2 gamma 4e5 kappa 1 "
                      "realModulus 1 0.5e9 realModulus 2 74e9", material=soft, wall_material=dict(young=1e5, poisson=0.22), step=1e-6)
        run = Run(text.replace("hard_particles yes", "soft_particles yes"), 1)
        found = [float(value) for value in re.findall(r"a_corr ([0-9.e-]+)", run.out)]
        self.assertEqual([round(value, 4) for value in found], [0.0331, 0.0242])
        below = "realModulus 1 1e3"
        refused = impact(self.WALL + below)
        self.assertNotEqual(refused.code, 0)
        self.assertIn("realModulus 1: the real modulus is below the script's youngsModulus", refused.out)

    def test_softening_multiplies_the_exponent_of_an_impact(self):
        factor = ((PTFE["young"]) / 1e12) ** 0.4   # rigid wall: Y* follows the particle's modulus (to 1e-4)
        self.assertAlmostEqual(self.exponent("realModulus 1 1e12") / self.exponent("") / factor, 1, delta=1e-3)


class Losses(unittest.TestCase):
    WALL = "pair 1 2 gamma -1e6 kappa 1 "

    def test_leakage_goes_to_ground_and_the_books_close(self):
        ball = [(0.0, 0.0, 5e-3, 0.0, 0.0, 0.0, 4e-10)]
        run = Run(script(ball, PLANE, FIX + self.WALL + "relaxationTime 1e-3", step=STEP), 500,
                  thermo="f_tribo[3] f_tribo[4] f_tribo[5]")
        self.assertAlmostEqual(run.charge() / (4e-10 * math.exp(-500 * STEP / 1e-3)), 1, delta=1e-12)
        self.assertAlmostEqual((run.charge() + float(run.thermo[-1][2])) / 4e-10, 1, delta=1e-13)
        self.assertEqual([float(v) for v in run.thermo[-1][3:]], [0, 0])

    def test_breakdown_holds_the_surface_field_and_is_booked_and_counted(self):
        limit = 4 * math.pi * EPSILON0 * RADIUS ** 2 * 3e6
        balls = [(-5e-3, 0.0, 5e-3, 0.0, 0.0, 0.0, 1.5 * limit), (5e-3, 0.0, 5e-3, 0.0, 0.0, 0.0, 0.5 * limit)]
        run = Run(script(balls, PLANE, FIX + self.WALL + "breakdownField 3e6", step=STEP), 3, thermo="f_tribo[4] f_tribo[5]")
        self.assertAlmostEqual(run.charge(1) / limit, 1, delta=1e-14)
        self.assertEqual(run.charge(2), 0.5 * limit)
        self.assertAlmostEqual(float(run.thermo[-1][2]) / (0.5 * limit), 1, delta=1e-13)
        self.assertEqual(float(run.thermo[-1][3]), 1)
        self.assertIn("Breakdown limited the charge of particles 1 times", run.out)


class InitialCharge(unittest.TestCase):
    WALL = "pair 1 2 gamma -1e6 kappa 1 "
    INSERT = """
fix pts all particletemplate/sphere 15485863 atom_type 1 density constant 2150 radius constant 0.0005
fix pdd all particledistribution/discrete 32452843 1 pts 1.0
region where block -0.01 0.01 -0.01 0.01 0.005 0.015 units box
fix ins all insert/pack seed 49979687 distributiontemplate pdd insert_every once overlapcheck yes all_in yes particles_in_region 40 region where
"""

    def test_particles_of_the_script_get_theirs_unless_they_bring_one(self):
        balls = [(-5e-3, 0.0, 5e-3, 0.0, 0.0, 0.0, 0.0), (5e-3, 0.0, 5e-3, 0.0, 0.0, 0.0, 7e-11)]
        run = Run(script(balls, PLANE, FIX + self.WALL + "initialCharge 1 equilibriumFraction 0.25 wallType 2", step=STEP), 3)
        self.assertAlmostEqual(run.charge(1) / (0.25 * 4 * math.pi * EPSILON0 * RADIUS ** 2 * -1e6), 1, delta=1e-13)
        self.assertEqual(run.charge(2), 7e-11)

    def test_inserted_particles_get_theirs_and_are_booked_as_inserted_on_any_number_of_ranks(self):
        charges = {}
        for ranks, grid in ((1, "1 1 1"), (2, "2 1 1")):
            text = script(RESTING, PLANE, FIX + self.WALL + "initialCharge 1 normal -2e-12 5e-13 seed 11", step=STEP, grid=grid,
                          after=self.INSERT)
            run = Run(text, 10, ranks)
            with self.subTest(ranks=ranks):
                self.assertEqual(len(run.last), 40)   # the one of the script counts
                charges[ranks] = {tag: row["q"] for tag, row in run.last.items()}
                self.assertGreater(len(set(charges[ranks].values())), 39)
                self.assertAlmostEqual(float(run.thermo[-1][2]) / sum(charges[ranks].values()), 1, delta=1e-12)
                self.assertAlmostEqual(sum(charges[ranks].values()) / 40 / -2e-12, 1, delta=0.2)
        self.assertEqual(charges[1], charges[2])


class Limiter(unittest.TestCase):
    PAIR = [(-4e-3, 0.0, 0.0, 0.0, 0.0, 0.0, 4e-9), (4e-3, 0.0, 0.0, 0.0, 0.0, 0.0, 1e-9)]
    NONE = "fix tribo all charge/gran/contact pair 1 1 none pair 1 2 none\nfix field all efield/him method pairwiseSum "

    def speed(self, words, steps=1):
        run = Run(script(self.PAIR, "", self.NONE + words, step=STEP), steps, thermo="f_field[3]")
        return run.last[2]["vx"], float(run.thermo[-1][2]), run.out

    def test_the_force_is_at_most_factor_m_skin_over_dt_squared_and_hits_are_counted(self):
        free, hits, _ = self.speed("")
        self.assertEqual(hits, 0)
        skin = 0.5 * RADIUS
        mass = 4 / 3 * math.pi * RADIUS ** 3 * PTFE["density"]
        force = 4e-9 * 1e-9 / (4 * math.pi * EPSILON0 * 8e-3 ** 2)
        factor = 0.1 * force / (mass * skin / STEP ** 2)
        limited, hits, out = self.speed(f"limit_field_force yes field_force_limit_factor {factor!r}")
        self.assertAlmostEqual(limited / free, 0.1, delta=1e-9)
        self.assertEqual(hits, 4)   # both particles in the set-up and in the step
        self.assertIn("fix field limited the field force 4 times", out)

    def test_a_limit_above_the_force_changes_no_bit(self):
        self.assertEqual(self.speed("limit_field_force yes field_force_limit_factor 1", 20)[:2], (self.speed("", 20)[0], 0))


class Refusals(unittest.TestCase):
    def refused(self, text, words):
        run = Run(script(RESTING, PLANE, FIX + words), 1)
        self.assertNotEqual(run.code, 0, run.out[-800:])
        self.assertIn(text, " ".join(run.out.split()))

    def test_every_option_refuses_what_has_no_meaning(self):
        wall = "pair 1 2 gamma -1e6 kappa 1 "
        for text, words in {
                "pair 1 2: type 1 has no work function": "pair 1 2 workFunctions kappa 1 workFunction 2 7e-19",
                "work function of type 1 is 4.5 J, more than 600 eV": "pair 1 2 workFunctions kappa 1 workFunction 1 4.5 workFunction 2 7e-19",
                "found 7e-19 eV, and work functions of solids are a few eV": "pair 1 2 workFunctions kappa 1 workFunctionEV 1 7e-19 workFunctionEV 2 4",
                "pair 1 2: neither type has a saturation": "pair 1 2 saturation kappa 1",
                "radius: found -1, but a number above zero is expected [m]": "pair 1 2 saturationCharge 1e-9 radius -1 kappa 1",
                "type 1: its saturation is used by no pair": wall + "sizeLaw 1 1e-6 3",
                'unknown form of the charging law "slow"': wall + "update slow",
                "ownImage: unknown word 'yes'; known: excluded, included": wall + "ownImage yes",
                "wallField: unknown word 'surface'; known: centre, atContactPoint": wall + "wallField surface",
                "acceleration must be a number above zero": wall + "acceleration -2",
                "realModulus: there is no type 5": wall + "realModulus 5 1e9",
                "relaxationTime [s] must be > 0 and finite, found 0": wall + "relaxationTime 0",
                "breakdownField [V/m] must be > 0 and finite, found -1": wall + "breakdownField -1",
                "initialCharge: there is no type 9": wall + "initialCharge 9 value 1e-9",
                "after 'initialCharge <type>' comes": wall + "initialCharge 1 uniform 3",
                "an equilibrium fraction needs a Gamma against type 1": wall + "initialCharge 1 equilibriumFraction 0.5 wallType 1",
                "spread: unknown word 'kappa'; known: gamma, workFunction": wall + "spread 1 kappa 3 seed 1",
                "a spread of the work function needs all its pairs": wall + "spread 1 workFunction 1e-20 seed 1",
                "wall lid: the script has no such wall": wall + "wall lid none",
                "wall floor: unknown kind 'insulating'": wall + "wall floor insulating",
                "gamma: found 'much', but a finite number is expected": "pair 1 2 gamma much kappa 1",
                "area: given twice": wall + "area hertz area doubled"}.items():
            with self.subTest(words):
                self.refused(text, words)


if __name__ == "__main__":
    unittest.main(verbosity=2)
