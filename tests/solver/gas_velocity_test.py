# SPDX-License-Identifier: GPL-3.0-or-later
"""Which velocity of the gas a particle feels: that of its cell, or one that varies inside it. Through himFoam."""

import math
import random
import tempfile
import unittest

from gas_box import GasBox, vector

SIZE, CELLS = 0.04, 8
RATE = (50.0, -20.0)                # of a shear flow, dU/dz [1/s]
DENSITY, VISCOSITY = 1000.0, 1e-5   # a gas so heavy that the drag of the grains, 1e-9 of its momentum per step, leaves it alone


def flow(z):
    return tuple(rate*z for rate in RATE)


def drag(diameter, u):
    """Schiller and Naumann's force of a velocity on a sphere that is held."""
    speed = math.hypot(*u)
    factor = 3*math.pi*VISCOSITY*diameter*(1 + 0.15*(DENSITY*speed*diameter/VISCOSITY)**0.687)
    return tuple(factor*component for component in u)


class Velocity(unittest.TestCase):
    def grains(self):
        """Anywhere in the box, in cells at the walls too, each with a diameter of its own."""
        random.seed(7)
        return [(tuple(random.uniform(0.002, SIZE - 0.002) for _ in range(3)), (0, 0, 0), random.uniform(5e-7, 1e-6), 1000.0)
                for _ in range(30)]

    def force(self, interpolation, voidFraction="centre;", ranks=1):
        layers = [flow((layer + 0.5)*SIZE/CELLS) for layer in range(CELLS)]
        U = "nonuniform List<vector> %d (%s)" % (CELLS**3, " ".join("(%r %r 0)" % layers[n//CELLS**2] for n in range(CELLS**3)))
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        box = GasBox(folder.name, self.grains(), size=SIZE, cells=CELLS, walls=("bottom", "top"), U=U,
                     wall_U={"top": "(%r %r 0)" % flow(SIZE)}, density=DENSITY, viscosity=VISCOSITY, voidFraction=voidFraction,
                     step=1e-5, end=2e-5, more="velocityInterpolation %s;" % interpolation)
        box.replace("DEM/in.box", "fix move all nve/sphere", "")
        return vector(box.rows(ranks)[-1], "force")

    def expected(self):
        return [sum(parts) for parts in zip(*(drag(diameter, flow(place[2])) for place, _, diameter, _ in self.grains()))]

    def test_every_particle_in_a_linear_flow_feels_the_exact_velocity_by_cell_point_on_every_number_of_ranks(self):
        expected = self.expected()
        scale = math.hypot(*expected)
        for voidFraction in ("centre;", "divided;"):
            for ranks in (1, 2, 4):
                with self.subTest(voidFraction=voidFraction, ranks=ranks):
                    found = self.force("cellPoint", voidFraction, ranks)
                    self.assertLess(math.hypot(found[0] - expected[0], found[1] - expected[1]), 1e-7*scale)

    def test_by_cell_it_feels_that_of_the_centre_of_its_cell(self):
        height = SIZE/CELLS
        centres = [drag(diameter, flow((math.floor(place[2]/height) + 0.5)*height)) for place, _, diameter, _ in self.grains()]
        found, expected = self.force("cell"), [sum(parts) for parts in zip(*centres)]
        scale = math.hypot(*expected)
        self.assertLess(math.hypot(found[0] - expected[0], found[1] - expected[1]), 1e-7*scale)
        self.assertGreater(math.hypot(*(a - b for a, b in zip(expected, self.expected()))), 1e-3*scale)

    def test_an_unknown_interpolation_is_refused_with_the_known(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        result = GasBox(folder.name, self.grains(), more="velocityInterpolation linear;").run("-dry-run")
        self.assertEqual(result.code, 1)
        self.assertIn("velocityInterpolation: unknown name `linear`; known: cell, cellPoint", " ".join(result.text.split()))


if __name__ == "__main__":
    unittest.main()
