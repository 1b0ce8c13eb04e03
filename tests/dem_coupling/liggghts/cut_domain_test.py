# SPDX-License-Identifier: GPL-3.0-or-later
"""Command cut_domain: parts of the box of unequal size for the ranks."""
import random
import re
import unittest

from scene import PTFE, Run, plate, script

RADIUS = PTFE["radius"]
CHARGING = "fix tribo all charge/gran/contact pair 1 1 gamma 0 kappa 50 pair 1 2 gamma -2.34e6 kappa 9.64"
FLOOR = "fix floor all wall/gran MODEL primitive type 2 zplane -0.019"
STL = """fix cad all mesh/surface file plate.stl type 2
fix floor all wall/gran MODEL mesh n_meshes 1 meshes cad"""


def crowd():
    """Sixty spheres that fall, most of them in the lower third of the box; some hit the floor and one another."""
    rng = random.Random(7)
    spots = [(x, y, z) for z in (-0.0171, -0.0135, -0.0099, 0.004) for x in (-0.009, -0.0045, 0.0, 0.0045, 0.009)
             for y in (-0.006, 0.0, 0.006)]
    return [(x + 2e-4 * rng.random(), y + 2e-4 * rng.random(), z, rng.uniform(-1, 1), rng.uniform(-1, 1), -2.0,
             1e-11 * rng.uniform(-1, 1)) for x, y, z in spots]


def most_on_a_rank(run):
    return int(re.search(r"Nlocal:\s+\S+ ave (\d+) max \d+ min", run.out).group(1))


def cut(text, lines):
    return text.replace("communicate single vel yes\n", lines + "\ncommunicate single vel yes\n")


class CutDomain(unittest.TestCase):
    def test_particles_move_and_charge_as_on_one_rank_and_belong_to_the_rank_of_their_slab(self):
        for floor, files in ((FLOOR, {}), (STL, {"plate.stl": plate(size=0.0199, height=-0.0189, cells=4)})):
            def run(lines="", ranks=1, grid="* * *"):
                done = Run(cut(script(crowd(), floor, CHARGING, grid=grid), lines), 200, ranks, files=files)
                self.assertEqual(done.code, 0, done.out[-1500:])
                return done

            alone = run()
            self.assertGreater(sum(alone.charge(tag) != row[6] for tag, row in enumerate(crowd(), 1)), 12)
            slabs = run("cut_domain z -0.0123", 2, "1 1 2")
            blocks = run("cut_domain z -0.0123\ncut_domain x 0.003", 4, "2 1 2")
            ignored = run("cut_domain z -0.0123", 1)
            self.assertEqual({tag: row["z"] for tag, row in ignored.last.items()}, {tag: row["z"] for tag, row in alone.last.items()})
            for found in (slabs, blocks):
                self.assertEqual(set(found.last), set(alone.last))
                for tag, row in alone.last.items():
                    for name in ("x", "y", "z", "vx", "vy", "vz", "q"):
                        size = 1e-11 if name == "q" else RADIUS
                        self.assertAlmostEqual(found.last[tag][name], row[name], delta=1e-6 * size, msg=f"{tag} {name}")
            # Half of the spheres lie below -12.3 mm, three quarters below the middle. One that crosses a cut goes over at the next exchange.
            self.assertLessEqual(most_on_a_rank(slabs), 32)
        self.assertGreaterEqual(most_on_a_rank(run(ranks=2, grid="1 1 2")), 43)

    def refused(self, text, lines, ranks=2, grid="1 1 2", before=True):
        scene = script(crowd()[:2], FLOOR, CHARGING, grid=grid)
        scene = cut(scene, lines) if before else scene.replace("neighbor", lines + "\nneighbor", 1)
        run = Run(scene, 1, ranks)
        self.assertNotEqual(run.code, 0, run.out[-800:])
        self.assertIn(text, run.out)

    def test_wrong_cuts_are_refused_with_what_is_allowed(self):
        self.refused("expected an axis, x, y or z, and one or more places [m] after it", "cut_domain w 0.1")
        self.refused("expected an axis, x, y or z, and one or more places [m] after it", "cut_domain z")
        self.refused("a place must be a number [m], found 'half'", "cut_domain z half")
        self.refused("makes 3 parts, but the grid of ranks has 2 along this axis", "cut_domain z 0.0 0.01")
        self.refused("a cut at 0.5 m, but cuts must ascend between -0.02 and 0.02 m", "cut_domain z 0.5")
        self.refused("a cut at -0.01 m, but cuts must ascend", "cut_domain z 0.0 -0.01", ranks=3, grid="1 1 3")
        self.refused("must stand before `processors`, `communicate` and the box", "cut_domain z 0.0", before=False)


if __name__ == "__main__":
    unittest.main()
