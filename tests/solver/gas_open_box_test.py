# SPDX-License-Identifier: GPL-3.0-or-later
"""Momentum of gas and particles where particles are inserted and leave during the run, through himFoam.

The gas is a box without a boundary; the DEM's box is shorter in x, and whatever passes its end is taken out. What leaves takes
its momentum along, which LIGGGHTS' own dump of every step tells: particles go after the first half of a step.
"""

import tempfile
import unittest

from gas_box import GasBox, vector

SIZE, STEP = 0.04, 1e-5

FEED = """region feed block 0.002 0.02 0.004 0.036 0.004 0.036 units box
fix shape all particletemplate/sphere 15485863 atom_type 1 density constant 1000 radius constant 1.5e-3
fix sizes all particledistribution/discrete 15485867 1 shape 1.0
fix fill all insert/pack seed 32452843 distributiontemplate sizes insert_every 150 overlapcheck yes vel constant 1.5 0.2 -0.3 &
    region feed particles_in_region 12 ntry_mc 1000
"""

DUMP = """dump each all custom 1 DEM/each.txt id mass vx vy vz fx fy fz
dump_modify each format "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g"
"""


def sums(vectors):
    return [sum(parts) for parts in zip(*vectors)] if vectors else [0.0, 0.0, 0.0]


class OpenBox(unittest.TestCase):
    def box(self, **entries):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        stays = [((0.004, 0.02, 0.02), (0.05, 0, 0), 3e-3, 1000.0)]   # something that what has left can be owed to
        leave = [((0.026, 0.008 + 0.006*n, 0.008 + 0.006*n), (2.0, 0.1*n, -0.1), 3e-3, 1000.0) for n in range(4)]
        box = GasBox(folder.name, stays + leave, size=SIZE, cells=4, U="uniform (1 0.5 -0.2)", step=1e-4, demStep=STEP, end=6e-3,
                     outer=2, **entries)
        box.replace("DEM/in.box", "boundary p p p", "boundary f p p")
        box.replace("DEM/in.box", "block 0.0 0.04 ", "block 0.0 0.034 ")
        box.replace("DEM/in.box", "fix move all", FEED + "fix move all")
        box.replace("DEM/in.box", "thermo 100000", DUMP + "thermo 100000")
        box.replace("constant/couplingProperties", "demCheckpoint yes;", "demCheckpoint no; allowRemovals yes;")
        return box

    def frames(self, box):
        """Per DEM step the particles by id: mass, velocity, force."""
        frames, lines = [], iter((box.path / "DEM/each.txt").read_text().splitlines())
        for line in lines:
            if line.startswith("ITEM: NUMBER"):
                count = int(next(lines))
            elif line.startswith("ITEM: ATOMS"):
                rows = [[float(word) for word in next(lines).split()] for _ in range(count)]
                frames.append({int(row[0]): (row[1], row[2:5], row[5:8]) for row in rows})
        return frames

    def moved(self, frames):
        """Momentum that came and that left, and how many did."""
        came, left = [], []
        for before, after in zip(frames, frames[1:]):
            for tag in after.keys() - before.keys():
                mass, velocity, force = after[tag]      # half a step with the force at its end, from the velocity of its insertion
                came.append([mass*v - 0.5*STEP*f for v, f in zip(velocity, force)])
                for momentum, v in zip(came[-1], (1.5, 0.2, -0.3)):
                    self.assertAlmostEqual(momentum/mass, v, delta=1e-10)
            for tag in before.keys() - after.keys():
                mass, velocity, force = before[tag]
                left.append([mass*v + 0.5*STEP*f for v, f in zip(velocity, force)])
        return came, left

    def check(self, box, ranks):
        rows = box.rows(ranks)
        frames = self.frames(box)
        self.assertEqual(len(frames) - 1, 600)
        came, left = self.moved(frames)
        self.assertGreater(len(came), 10)
        self.assertGreater(len(left), 3)
        start = sums([[mass*v for v in velocity] for mass, velocity, _ in frames[0].values()])
        gas = [1.0*part for part in vector(rows[0], "gasMomentum")]
        for axis, name in enumerate("XYZ"):
            last = rows[-1]
            scale = abs(sums(came)[axis]) + abs(sums(left)[axis]) + abs(start[axis]) + abs(last["got" + name])
            # Particles: what is there, and what left, is what was there, what came and what the gas gave.
            has = last["particleMomentum" + name] + sums(left)[axis]
            self.assertAlmostEqual(has, start[axis] + sums(came)[axis] + last["got" + name], delta=1e-12*scale)
            # The gas: what it has less, it gave.
            gave = last["given" + name] - rows[0]["given" + name]
            self.assertAlmostEqual(last["gasMomentum" + name] + gave, gas[axis], delta=1e-12*abs(gas[axis]))
        # Nothing that was not got stays with the gas: it is ahead by its last solve.
        self.assertLess(last["mismatch"], 1e-4)

    def test_momentum_of_gas_particles_and_what_left_is_kept_on_every_number_of_ranks(self):
        for ranks in (1, 2, 4):
            with self.subTest(ranks=ranks):
                self.check(self.box(), ranks)

    def test_with_added_mass_and_the_velocity_at_the_particle_too(self):
        self.check(self.box(voidFraction="divided;", more="virtualMass 0.5; lift Saffman; velocityInterpolation cellPoint;"), 1)


if __name__ == "__main__":
    unittest.main()
