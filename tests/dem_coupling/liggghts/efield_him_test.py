# SPDX-License-Identifier: GPL-3.0-or-later
"""fix efield/him: the field of all charges and their images without a mesh, and what it does to motion and charging."""
import math
import pathlib
import re
import subprocess
import tempfile
import unittest

from scene import EPSILON0, PROGRAM, PTFE, Run, plate, rayleigh_step, script

COULOMB = 1 / (4 * math.pi * EPSILON0)
RADIUS = PTFE["radius"]
STEP = 0.2 * rayleigh_step(PTFE)
NO_CHARGING = "fix tribo all charge/gran/contact pair 1 1 none pair 1 2 none pair 2 2 none"
FIELD = NO_CHARGING + "\nfix field all efield/him method pairwiseSum"
FLOOR = "fix floor all wall/gran MODEL primitive type 2 zplane 0.0"
CORNER = FLOOR + """
fix left all wall/gran MODEL primitive type 2 xplane -0.015
fix back all wall/gran MODEL primitive type 2 yplane -0.015"""
COLUMNS = "f_field[1] f_field[2] f_field[3]"

# Eight spheres apart from each other, in motion, in the corner x, y > -15 mm, z > 0.
CLOUD = [(-9e-3 + 8e-3 * i + 1e-3 * j, -8e-3 + 9e-3 * j - 1e-3 * k, 4e-3 + 7e-3 * k + 5e-4 * i,
          0.4 * (-1) ** i, 0.3 * (-1) ** j, 0.2 * (-1) ** k, 1e-10 * (1 + i - 2 * j + 0.5 * k))
         for i in (0, 1) for j in (0, 1) for k in (0, 1)]


def mirror(charges, axis, place):
    """Charges (x, y, z, q) with their images in a grounded plane."""
    return charges + [(*(2 * place - c if d == axis else c for d, c in enumerate(p[:3])), -p[3]) for p in charges]


def field(at, charges):
    """Coulomb field [V/m] at a point of all charges but the first."""
    total = [0.0, 0.0, 0.0]
    for charge in charges[1:]:
        apart = [a - c for a, c in zip(at, charge)]
        distance = math.sqrt(sum(d * d for d in apart))
        total = [t + COULOMB * charge[3] * d / distance ** 3 for t, d in zip(total, apart)]
    return total


def found(row):
    return [row[f"f_field[{axis}]"] for axis in (1, 2, 3)]


class Field(unittest.TestCase):
    def expect(self, run, exact, share=1e-12):
        """Field at every sphere of the last frame against exact(tag, row, all rows)."""
        for tag, row in run.last.items():
            others = [(r["x"], r["y"], r["z"], r["q"]) for t, r in run.last.items() if t != tag]
            want = exact((row["x"], row["y"], row["z"], row["q"]), others)
            size = math.sqrt(sum(w * w for w in want))
            for a, b in zip(found(row), want):
                self.assertAlmostEqual(a, b, delta=share * size)

    def test_the_dumped_field_is_the_pair_sum_at_the_dumped_positions(self):
        run = Run(script(CLOUD, "", FIELD, step=STEP), 50, extra=COLUMNS)
        self.expect(run, lambda own, others: field(own, [own] + others))

    def test_images_in_a_corner_of_three_walls_are_seven_for_every_charge(self):
        run = Run(script(CLOUD, CORNER, FIELD + " images yes", step=STEP), 50, extra=COLUMNS)

        def exact(own, others):
            charges = [own] + others
            for axis, place in ((2, 0.0), (0, -0.015), (1, -0.015)):
                charges = mirror(charges, axis, place)
            return field(own, charges)

        self.expect(run, exact)

    def test_a_wall_without_image_and_the_others_with(self):
        run = Run(script(CLOUD, CORNER, FIELD + " images yes without_image left without_image back", step=STEP), 50, extra=COLUMNS)
        self.expect(run, lambda own, others: field(own, mirror([own] + others, 2, 0.0)))

    def test_a_cylinder_mirrors_in_its_tangent_plane(self):
        # R section 2.4: the image at the distance of the sphere from the wall, behind it.
        height, reach = 3e-3, 0.009
        start = [(reach * math.cos(1.0), reach * math.sin(1.0), height, 0.0, 0.0, 0.0, 2e-10)]
        wall = "fix cyl all wall/gran MODEL primitive type 2 zcylinder 0.012 0. 0."
        run = Run(script(start, wall, FIELD + " images yes", step=STEP), 0, extra=COLUMNS, thermo="f_field")
        strength = COULOMB * 2e-10 / (2 * (0.012 - reach)) ** 2   # towards the wall
        for a, b in zip(found(run.last[1]), (strength * math.cos(1.0), strength * math.sin(1.0), 0.0)):
            self.assertAlmostEqual(a, b, delta=1e-12 * strength)
        self.assertAlmostEqual(float(run.thermo[-1][2]) / (-2e-10 * strength * (0.012 - reach)), 1, delta=1e-12)

    def test_truncation_leaves_out_pairs_beyond_the_cutoff_in_both_methods(self):
        pair = [(-4e-3, 0.0, 0.0, 0.0, 0.0, 0.0, 1e-10), (4e-3, 0.0, 0.0, 0.0, 0.0, 0.0, 1e-10)]
        for method in ("pairwiseSum", "directTruncation"):
            for cutoff, strength in ((7.9e-3, 0.0), (8.1e-3, COULOMB * 1e-10 / 8e-3 ** 2)):
                run = Run(script(pair, "", f"{NO_CHARGING}\nfix field all efield/him method {method} cutoff {cutoff}", step=STEP), 0,
                          extra=COLUMNS)
                with self.subTest(f"{method} {cutoff}"):
                    self.assertAlmostEqual(run.last[2]["f_field[1]"], strength, delta=1e-12 * COULOMB * 1e-10 / 8e-3 ** 2)

    def test_permittivity_divides_and_the_external_field_adds(self):
        pair = [(-4e-3, 0.0, 0.0, 0.0, 0.0, 0.0, 1e-10), (4e-3, 0.0, 0.0, 0.0, 0.0, 0.0, 1e-10)]
        run = Run(script(pair, "", FIELD + " relative_permittivity 2.5 external 1000 200 -3", step=STEP), 0, extra=COLUMNS,
                  thermo="f_field[1] f_field[2]")
        strength = COULOMB / 2.5 * 1e-10 / 8e-3 ** 2
        for a, b in zip(found(run.last[2]), (1000 + strength, 200, -3)):
            self.assertAlmostEqual(a, b, delta=1e-9)
        self.assertAlmostEqual(float(run.thermo[-1][2]), math.hypot(1000 + strength, 200, 3), delta=1e-6)
        self.assertEqual(float(run.thermo[-1][3]), 2)  # the one pair, counted at each of its two charges

    def test_the_field_is_the_same_on_one_two_and_four_ranks(self):
        # Fast enough to cross rank boundaries at x = 0 and y = 0 within the run.
        cloud = [(x, y, z, 10 * vx, 10 * vy, vz, q) for x, y, z, vx, vy, vz, q in CLOUD]
        for name, line in {"sum": FIELD + " images yes", "truncation": FIELD.replace("pairwiseSum", "directTruncation cutoff 0.012")}.items():
            text = lambda grid: script(cloud, CORNER, line + " every 5", step=STEP, grid=grid)
            alone = Run(text("1 1 1"), 400, extra=COLUMNS, thermo="f_field")
            for ranks, grid in ((2, "2 1 1"), (4, "2 2 1")):
                run = Run(text(grid), 400, ranks, extra=COLUMNS, thermo="f_field")
                with self.subTest(f"{name}, {ranks} ranks"):
                    self.assertAlmostEqual(float(run.thermo[-1][2]) / float(alone.thermo[-1][2]), 1, delta=1e-9)
                    for tag, row in alone.last.items():
                        for key in ("x", "vy", "f_field[1]", "f_field[3]"):
                            self.assertAlmostEqual(run.last[tag][key] / row[key], 1, delta=1e-8)

    def test_the_field_is_held_between_updates(self):
        run = Run(script(CLOUD, "", FIELD + " every 4", step=STEP), 12, dump_every=1, extra=COLUMNS)
        history = [found(frame[3]) for frame in run.frames]
        for step in range(1, 13):
            same = self.assertEqual if step % 4 else self.assertNotEqual
            same(history[step], history[step - 1], f"step {step}")


class Motion(unittest.TestCase):
    def test_kinetic_and_electrostatic_energy_together_stay_constant(self):
        start = [(-4e-3, 1e-3, 5e-3, 0.0, 0.02, 0.0, 3e-9), (4e-3, 0.0, 6e-3, 0.0, 0.0, 0.0, -3e-9), (0.0, 6e-3, 9e-3, 0.0, 0.0, 0.0, 2e-9)]
        run = Run(script(start, FLOOR, FIELD + " images yes", step=STEP / 2), 3000, dump_every=100, thermo="ke f_field")
        energies = [(float(line[2]), float(line[3])) for line in run.thermo]
        total = [kinetic + potential for kinetic, potential in energies]
        change = abs(energies[-1][0] - energies[0][0])
        self.assertGreater(change, 0.1 * abs(energies[0][1]), "the charges must have moved")
        self.assertLess(max(abs(t - total[0]) for t in total), 1e-6 * change)

    def test_the_energy_error_falls_with_the_square_of_the_time_step(self):
        # An unlike pair on an eccentric path about each other, never touching: a force that lags behind by one step would make
        # the error fall with the step itself, and pile up.
        charge, apart = 3e-9, 6e-3
        mass = 4 / 3 * math.pi * RADIUS ** 3 * PTFE["density"]
        speed = 0.4 * charge * math.sqrt(COULOMB / (mass * apart))
        start = [(-apart / 2, 0.0, 0.0, 0.0, -speed, 0.0, charge), (apart / 2, 0.0, 0.0, 0.0, speed, 0.0, -charge)]
        start = [(1.6 * x, *rest) for x, *rest in start]
        errors = []
        for halvings in (0, 1):
            run = Run(script(start, "", FIELD, step=STEP / 2 ** halvings), 4000 * 2 ** halvings, dump_every=200 * 2 ** halvings,
                      thermo="ke f_field")
            energies = [(float(line[2]), float(line[3])) for line in run.thermo]
            self.assertGreater(max(k for k, _ in energies), 1.2 * energies[0][0], "the charges must have moved")
            total = [sum(energy) for energy in energies]
            errors.append(max(abs(t - total[0]) for t in total) / max(k for k, _ in energies))
        self.assertLess(errors[0], 1e-5)
        self.assertAlmostEqual(errors[0] / errors[1], 4, delta=0.2)

    def test_only_the_group_feels_the_force_and_all_make_the_field(self):
        text = script(CLOUD[:2], "", NO_CHARGING, step=STEP,
                      after="group moved id 1\nfix field moved efield/him method pairwiseSum\n")
        run = Run(text, 20)
        self.assertEqual(run.last[2]["vz"], CLOUD[1][5])
        self.assertNotEqual(run.last[1]["vz"], CLOUD[0][5])

    def test_a_restart_between_two_updates_goes_on_bit_for_bit(self):
        head = script(CLOUD, FLOOR, FIELD + " images yes every 7", step=STEP)
        report = """
dump out all custom 1 out.{name} id x y z vx vy vz q f_field[1] f_field[3]
dump_modify out format "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g %.17g" sort id
thermo_style custom step f_field f_field[1]
thermo_modify format float %.17g
run {steps}
"""
        with tempfile.TemporaryDirectory() as folder:
            def liggghts(text):
                pathlib.Path(folder, "in.scene").write_text(text)
                done = subprocess.run([PROGRAM, "-in", "in.scene", "-log", "none"], cwd=folder, stdout=subprocess.PIPE,
                                      stderr=subprocess.STDOUT, encoding="latin-1", timeout=120)
                self.assertEqual(done.returncode, 0, done.stdout[-1500:])
                return [line for line in done.stdout.splitlines() if line.strip().startswith("38 ")]

            first = liggghts(head + "run 38\nwrite_restart state.restart\n" + report.format(name="straight", steps=30))
            text = re.sub(r"region box block.*\ncreate_box.*\n", "read_restart state.restart\n", head)
            text = re.sub(r"(create_atoms|set group|set atom|atom_style|boundary|units|atom_modify).*\n", "", text)
            second = liggghts(text + report.format(name="again", steps=30))
            frames = [pathlib.Path(folder, f"out.{name}").read_text().split("ITEM: ATOMS")[-1] for name in ("straight", "again")]
        self.assertEqual(frames[0], frames[1])
        self.assertEqual(first[-1].split(), second[-1].split())


class Charging(unittest.TestCase):
    GAMMA = -2.0e6

    def saturated(self, extra="", others=(), walls=FLOOR):
        """Charge of a ball that one impact on the floor saturates: kappa is so large that nothing is left to move."""
        charging = f"fix tribo all charge/gran/contact pair 1 1 none pair 1 2 gamma {self.GAMMA!r} kappa 1e6\n" \
                   f"fix field all efield/him method pairwiseSum {extra}"
        start = [(0.0, 0.0, RADIUS + 5e-5, 0.0, 0.0, -2.56, 0.0)]
        step = 0.05 * rayleigh_step(PTFE)
        return Run(script(start + list(others), walls, charging, step=step), int(1.6e-4 / step)).charge()

    def test_an_external_field_shifts_saturation_at_a_wall_by_its_normal_part(self):
        # The floor's n points down, E.n = -Ez: q = 4 pi eps0 r^2 (Gamma + Ez).
        q = self.saturated("external 1e5 0 3e5")
        self.assertAlmostEqual(q / (RADIUS ** 2 / COULOMB * (self.GAMMA + 3e5)), 1, delta=1e-9)

    def test_wall_contact_field_self_leaves_it_out(self):
        q = self.saturated("external 1e5 0 3e5 wall_contact_field self")
        self.assertAlmostEqual(q / (RADIUS ** 2 / COULOMB * self.GAMMA), 1, delta=1e-9)

    def test_permittivity_scales_the_saturation_charge(self):
        self.assertAlmostEqual(self.saturated("relative_permittivity 3") / (3 * RADIUS ** 2 / COULOMB * self.GAMMA), 1, delta=1e-9)

    def test_a_charge_overhead_opposes_charging_with_its_field_at_the_ball(self):
        # A frozen sphere 10 mm above; the field moves by less than 1 % within the contact.
        q = self.saturated(others=[(0.0, 0.0, RADIUS + 0.01, 0.0, 0.0, 0.0, -1e-9)])
        above = COULOMB * 1e-9 / 0.01 ** 2   # Ez, towards the negative charge
        self.assertAlmostEqual((q / (RADIUS ** 2 / COULOMB) - self.GAMMA) / above, 1, delta=2e-2)

    def test_partners_do_not_oppose_each_other_twice(self):
        # Two equal touching spheres, one charged: the field hands both the other's Coulomb field, charging must take it out.
        speed = 1.0
        pair = [(-1.62e-3, 0.0, 0.0, speed, 0.0, 0.0, 1e-13), (1.62e-3, 0.0, 0.0, -speed, 0.0, 0.0, 0.0)]
        charging = "fix tribo all charge/gran/contact pair 1 1 gamma 0 kappa 50 pair 1 2 none"
        step = 0.05 * rayleigh_step(PTFE)
        without = Run(script(pair, "", charging, step=step), int(1.6e-4 / step))
        with_field = Run(script(pair, "", charging + "\nfix field all efield/him method pairwiseSum", step=step), int(1.6e-4 / step))
        self.assertGreater(without.charge(2), 1e-15)
        # 1e-13 C moves the spheres by far less than the last digits that charge depends on
        self.assertAlmostEqual(with_field.charge(2) / without.charge(2), 1, delta=1e-6)


class ExampleOfThePage(unittest.TestCase):
    def test_the_script_on_the_documentation_page_runs_and_charges_both_spheres(self):
        page = pathlib.Path(__file__).resolve().parents[3] / "dem_coupling/doc/liggghts_him.md"
        lines = page.read_text().split("becomes a charged one")[1].split("Charging is on")[0].splitlines()
        text = "\n".join(line[4:].split("#+")[0] for line in lines if line.startswith("    "))
        with tempfile.TemporaryDirectory() as folder:
            pathlib.Path(folder, "in.page").write_text(text + "\n")
            done = subprocess.run([PROGRAM, "-in", "in.page", "-log", "none"], cwd=folder, stdout=subprocess.PIPE,
                                  stderr=subprocess.STDOUT, encoding="latin-1", timeout=120)
        self.assertEqual(done.returncode, 0, done.stdout[-1500:])
        last = [line.split() for line in done.stdout.splitlines() if line.split()[:1] == ["5000"]][0]
        self.assertGreater(float(last[3]), 0, "the floor must have been given what the spheres lost")
        self.assertGreater(float(last[4]), 0, "the charged spheres must feel a field")


class Refusals(unittest.TestCase):
    def refused(self, text, line, walls=FLOOR, **options):
        files = {"floor.stl": plate()}
        run = Run(script(CLOUD, walls, line, **options), 1, files=files)
        self.assertNotEqual(run.code, 0, run.out[-800:])
        self.assertIn(text, " ".join(run.out.split()))

    def field(self, words):
        return NO_CHARGING + "\nfix field all efield/him " + words

    def test_unknown_and_missing_methods_list_the_known_ones(self):
        self.refused("unknown field method 'pairSum'; known: pairwiseSum, directTruncation", self.field("method pairSum"))
        self.refused("method: the keyword is missing; known methods: pairwiseSum, directTruncation", self.field("every 3"))

    def test_methods_of_a_mesh_are_refused_with_the_reason(self):
        self.refused("him solves Poisson's equation on a mesh, and liggghtsHim has none. Use one of pairwiseSum, directTruncation, or "
                     "run the scene with himFoam", self.field("method him cutoff 0.01"))

    def test_a_missing_cutoff_is_asked_for(self):
        self.refused("cutoff: directTruncation needs it", self.field("method directTruncation"))

    def test_unknown_keywords_list_the_known_ones(self):
        self.refused("unknown keyword 'cutof'; known: method, cutoff, images", self.field("method pairwiseSum cutof 3"))

    def test_everything_that_is_wrong_comes_together(self):
        self.refused("1. every: found 0, but a number above zero is expected [DEM steps] 2. external <Ex> <Ey> <Ez>: found 'much', but "
                     "a finite number is expected 3. images: unknown word 'maybe'; known: no, yes 4. relative_permittivity: found -1, "
                     "but a number above zero is expected [-]",
                     self.field("method pairwiseSum every 0 external 1 2 much images maybe relative_permittivity -1"))
        self.refused("every: a whole number of DEM steps", self.field("method pairwiseSum every 1.5"))
        self.refused("something is missing after 'cutoff'", self.field("method pairwiseSum cutoff"))
        self.refused("images: only pairwiseSum mirrors charges in walls; method is 'directTruncation'",
                     self.field("method directTruncation cutoff 0.01 images yes"))

    def test_images_need_primitive_walls_that_exist(self):
        mesh = "fix floor all mesh/surface file floor.stl type 2 curvature 10\n" \
               "fix walls all wall/gran MODEL mesh n_meshes 1 meshes floor"
        self.refused("wall floor is a mesh, and the pair sum mirrors charges in planes and cylinders only",
                     self.field("method pairwiseSum images yes"), mesh)
        self.refused("the script has no primitive granular wall to mirror charges in", self.field("method pairwiseSum images yes"), "")
        self.refused("without_image lid: the script has no such wall; it has: floor",
                     self.field("method pairwiseSum images yes without_image lid"))

    def test_periodic_boxes_are_refused_by_the_sum_and_bound_the_cutoff(self):
        self.refused("Use a DEM box without periodic directions", self.field("method pairwiseSum"), boundary="p p f")
        self.refused("cutoff: 0.05 m is longer than the periodic DEM box in x", self.field("method directTruncation cutoff 0.05"),
                     boundary="p p f")

    def test_the_field_must_stand_below_the_charging(self):
        self.refused("Write this line below fix tribo charge/gran/contact", "fix field all efield/him method pairwiseSum\n" + NO_CHARGING)

    def test_other_units_are_refused(self):
        text = script(CLOUD, "", "fix field all efield/him method pairwiseSum", cohesion="off").replace("units si", "units cgs")
        run = Run(text, 1, thermo="ke")
        self.assertNotEqual(run.code, 0)
        self.assertIn("works in 'units si' only", run.out)

    def test_two_spheres_in_one_place_are_named(self):
        twice = [CLOUD[0], CLOUD[0]]
        run = Run(script(twice, "", FIELD), 1)
        self.assertNotEqual(run.code, 0)
        self.assertIn("particle 1 and particle 2 are at the same position", run.out)


if __name__ == "__main__":
    unittest.main(verbosity=2)
