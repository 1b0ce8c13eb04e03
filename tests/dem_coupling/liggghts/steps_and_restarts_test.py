# SPDX-License-Identifier: GPL-3.0-or-later
"""What must not move charge, and what must survive: set-up passes, computes, rolling, migration, restart."""
import math
import pathlib
import re
import subprocess
import tempfile
import unittest

from scene import PROGRAM, PTFE, Run, plate, rayleigh_step, script, trough

STEP = 0.2 * rayleigh_step(PTFE)
RADIUS = PTFE["radius"]
CHARGING = "fix tribo all charge/gran/contact pair 1 1 gamma 0 kappa 50 pair 1 2 gamma -2e6 kappa 10"
PLANE = "fix floor all wall/gran MODEL primitive type 2 zplane 0.0"
MESH = """fix floor all mesh/surface file floor.stl type 2 curvature 10
fix walls all wall/gran MODEL mesh n_meshes 1 meshes floor"""

# Three balls that overlap each other and the floor from the start.
HEAP = [(-1.5855e-3, 0.0, RADIUS - 2e-6, 0.0, 0.0, 0.0, 1e-11), (1.5855e-3, 0.0, RADIUS - 2e-6, 0.0, 0.0, 0.0, -3e-11),
        (0.0, 0.0, 4.33e-3, 0.0, 0.0, 0.0, 2e-11)]


def heap(after="", walls=PLANE):
    return script(HEAP, walls, CHARGING, step=STEP, friction=0.3, restitution=0.5,
                  before="fix g all gravity 9.81 vector 0 0 -1", after=after)


class PassesThatMoveNothing(unittest.TestCase):
    def charges(self, run):
        return [run.charge(tag) for tag in (1, 2, 3)]

    def test_run_0_a_hundred_times_moves_no_charge(self):
        for name, walls in {"primitive": PLANE, "mesh": MESH}.items():
            run = Run(heap("run 0\n" * 100, walls), 0, files={"floor.stl": plate(cells=3)})
            with self.subTest(name):
                self.assertEqual(self.charges(run), [1e-11, -3e-11, 2e-11])

    def test_set_ups_between_steps_move_no_charge(self):
        once = Run(heap("run 7\n"), 0)
        again = Run(heap("run 7\n" + "run 0\n" * 20), 0)
        self.assertNotEqual(self.charges(once), [1e-11, -3e-11, 2e-11])
        self.assertEqual(self.charges(once), self.charges(again))

    def test_a_local_compute_on_pairs_and_walls_changes_no_bit(self):
        plain = Run(heap(), 300, thermo="f_tribo[2]")
        watched = Run(heap("compute p all pair/gran/local id force\ncompute w all wall/gran/local id force\n"
                           "compute n all reduce sum c_p[1]\n", MESH), 300, files={"floor.stl": plate(cells=3)}, dump_every=3,
                      thermo="c_n")
        unwatched = Run(heap(walls=MESH), 300, files={"floor.stl": plate(cells=3)}, dump_every=3, thermo="f_tribo[2]")
        self.assertEqual(watched.last, unwatched.last)
        self.assertNotEqual(self.charges(plain), [1e-11, -3e-11, 2e-11])

    def test_intervals_without_set_up_equal_one_long_run(self):
        whole = Run(heap(), 600)
        pieces = Run(heap("run 0\n" + "run 12 pre no post no\n" * 50), 0)
        self.assertEqual(whole.last, pieces.last)


class RollingBall(unittest.TestCase):
    """A ball that moves along a tessellated wall at constant overlap is loaded once."""

    def drive(self, files, start, velocity, steps, walls=MESH):
        # No integrator acts on the ball except `fix move`, so that its overlap is exactly constant.
        text = script([(*start, 0.0, 0.0, 0.0, 0.0)], walls, CHARGING, step=STEP)
        return text.replace("fix integrate all nve/sphere", velocity), steps, files

    def test_over_200_triangles_of_a_plate_it_gains_nothing_after_the_first_loading(self):
        duration = 3000 * STEP
        text, steps, files = self.drive({"floor.stl": plate(cells=80)}, (-0.012, -0.0113, RADIUS - 1e-5),
                                        f"fix integrate all move linear {0.024 / duration!r} {0.022 / duration!r} 0", 3000)
        run = Run(text, steps, files=files, dump_every=10)   # squares of 0.375 mm: more than 200 triangles
        self.assertLess(run.frames[1][1]["q"], 0)
        # z is written once and never changes, so neither may the charge.
        self.assertEqual(run.frames[1][1]["q"], run.last[1]["q"])

    def test_along_a_facetted_cylinder_it_gains_no_more_than_its_overlap_ever_grows(self):
        # The ball circles at constant distance from the axis; its overlap with flat strips breathes by R (1 - cos(pi/n)).
        radius, facets = 0.018, 64
        reach = radius - RADIUS + 3e-5   # deep enough to touch at the edges between strips, too
        period = 0.02
        circle = f"fix integrate all move rotate 0 0 0 0 1 0 {period}"
        text, steps, files = self.drive({"floor.stl": trough(radius, facets, 0.018, 21)}, (reach, 0.0, 0.0), circle,
                                        int(2.0 * period / STEP))
        run = Run(text.replace(CHARGING, CHARGING + " reloading beyondMaximum"), steps, files=files, dump_every=100)
        saturated = [frame[1]["q"] for frame in run.frames]
        one_strip = int(1.5 * period / facets / STEP / 100) + 1
        self.assertLess(saturated[one_strip], 0)
        # More than one loading per facet would add 125 times this share.
        self.assertAlmostEqual(saturated[-1] / saturated[one_strip], 1, delta=0.02)


class Restart(unittest.TestCase):
    def run_in(self, folder, text):
        pathlib.Path(folder, "in.scene").write_text(text)
        done = subprocess.run([PROGRAM, "-in", "in.scene", "-log", "none"], cwd=folder, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, encoding="latin-1", timeout=120)
        self.assertEqual(done.returncode, 0, done.stdout[-1500:])
        return done.stdout

    def test_a_restarted_run_ends_with_the_same_charges_and_books(self):
        # Both runs compute forces anew at the restart step: contacts restart bit-identically only then.
        report = """
dump out all custom 1 out.{name} id x y z vx vy vz q
dump_modify out format "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g" sort id
thermo_style custom step f_tribo[1] f_tribo[2]
thermo_modify format float %.17g
thermo 400
run 400
"""
        with tempfile.TemporaryDirectory() as folder:
            first = heap("run 300\nwrite_restart state.restart\n") + report.format(name="straight")
            whole = self.run_in(folder, first)
            text = heap()
            text = re.sub(r"region box block.*\ncreate_box.*\n", "read_restart state.restart\n", text)
            text = re.sub(r"(create_atoms|set group|set atom|atom_style|boundary|units|atom_modify).*\n", "", text)
            again = self.run_in(folder, text + report.format(name="again"))
            frames = [Run.read(Run, pathlib.Path(folder, f"out.{name}").read_text())[-1] for name in ("straight", "again")]
        for tag in (1, 2, 3):
            for key in ("q", "x", "z", "vz"):
                self.assertAlmostEqual(frames[0][tag][key], frames[1][tag][key], delta=1e-9 * max(abs(frames[0][tag][key]), 1e-12),
                                       msg=f"{key} of {tag}")
        books = [[line.split() for line in out.splitlines() if line.strip().startswith("700 ")][0] for out in (whole, again)]
        self.assertAlmostEqual(float(books[0][2]) / float(books[1][2]), 1, delta=1e-9)


class ParallelBooks(unittest.TestCase):
    def test_a_tumbling_cloud_keeps_its_charge_over_rank_and_periodic_boundaries(self):
        # Fast, so that a thousand steps take them twice through the box: on busy cores a step of four ranks costs milliseconds.
        particles = [((i - 1.5) * 5e-3 + 3e-4 * j, (j - 1.5) * 5e-3 + 2e-4 * k, 2e-3 + k * 4e-3, 12.0 * (-1) ** (i + j),
                      10.0 * (-1) ** (j + k), 8.0 * (-1) ** (i + k), 1e-11 * (i - 1) + 3e-12 * j) for i in range(4) for j in range(4)
                     for k in range(3)]
        text = script(particles, PLANE + "\nfix lid all wall/gran MODEL primitive type 2 zplane 0.018", CHARGING, boundary="p p f",
                      box=(-0.01, 0.01), step=STEP)
        text = re.sub(r"region box block .*", "region box block -0.01 0.01 -0.01 0.01 -0.001 0.02 units box", text)
        opening = sum(p[6] for p in particles)
        for ranks in (1, 2, 4):
            run = Run(text, 1000, ranks, thermo="f_tribo[2] f_tribo[3]")
            charges = [row["q"] for row in run.last.values()]
            scale = sum(map(abs, charges))
            given = float(run.thermo[-1][2]) + float(run.thermo[-1][3])
            with self.subTest(ranks=ranks):
                self.assertEqual(len(charges), len(particles))
                self.assertGreater(abs(given), 0.05 * scale, "the walls must have charged the cloud")
                self.assertLess(abs(sum(charges) + given - opening) / scale, 1e-12)


if __name__ == "__main__":
    unittest.main(verbosity=2)
