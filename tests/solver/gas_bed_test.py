# SPDX-License-Identifier: GPL-3.0-or-later
"""A small fluidised column by both pressure models, through himFoam: the gas carries the weight of the bed.

Spheres on a lattice, one in the middle of each cell, so that every cell of the bed has the same void fraction; no floor, no walls.
"""

import math
import tempfile
import unittest

from gas_box import GasBox

WIDTH, HEIGHT, D, RHO, GAS, MU, G = 8e-3, 40e-3, 1.5e-3, 1000.0, 1.2, 1.8e-5, 9.81
SIDE, LAYERS, CELL = 4, 14, 2e-3    # spheres along x and y, and on top of one another
VOLUME = math.pi/6*D**3
ALPHA = 1 - VOLUME/CELL**3
NUMBER = SIDE*SIDE*LAYERS
WEIGHT = NUMBER*(RHO - GAS)*VOLUME*G


def resistance(speed):
    """Of all spheres by Ergun at a superficial speed: beta/alpha slip each."""
    slip = speed/ALPHA
    beta = VOLUME*(150*(1 - ALPHA)*MU/(ALPHA*D*D) + 1.75*GAS*slip/D)
    return NUMBER*beta/ALPHA*slip


def hovering():
    """Superficial speed that carries the weight [m/s]."""
    low, high = 0.0, 10.0
    for _ in range(60):
        middle = 0.5*(low + high)
        low, high = (middle, high) if resistance(middle) < WEIGHT else (low, middle)
    return low


class Bed(unittest.TestCase):
    def column(self, model, speed, end):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        spheres = [(((i + 0.5)*CELL, (j + 0.5)*CELL, (k + 3.5)*CELL), (0, 0, 0), D, RHO)
                   for k in range(LAYERS) for j in range(SIDE) for i in range(SIDE)]
        box = GasBox(folder.name, spheres, size=WIDTH, cells=SIDE, walls=("bottom", "top"), U="uniform (0 0 %r)" % speed, density=GAS,
                     viscosity=MU, gravity=-G, step=2e-4, demStep=1e-5, end=end, outer=2, more="pressureModel %s;" % model)
        box.replace("constant/gasProperties", "drag SchillerNaumann", "drag Gidaspow")
        box.replace("system/blockMeshDict", "(0 0 1) (1 0 1) (1 1 1) (0 1 1)",
                    " ".join("(%d %d %r)" % (x, y, HEIGHT/WIDTH) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))))
        box.replace("system/blockMeshDict", "(4 4 4)", "(%d %d %d)" % (SIDE, SIDE, round(HEIGHT/CELL)))
        for patch in ("top    ", "bottom "):
            box.replace("system/blockMeshDict", patch + "{ type wall;", patch + "{ type patch;")
        box.tool("blockMesh")
        box.field("U", "volVectorField", "0 1 -1 0 0 0 0", "uniform (0 0 %r)" % speed,
                  {"bottom": "fixedValue; value uniform (0 0 %r)" % speed, "top": "zeroGradient"})
        box.field("p", "volScalarField", "1 -1 -2 0 0 0 0", "uniform 0",
                  {"bottom": "fixedFluxPressure; value uniform 0", "top": "fixedValue; value uniform 0"})
        box.replace("DEM/in.box", "-0.001 %r" % (WIDTH + 0.001), "-0.001 %r" % HEIGHT)
        return box

    def lift(self, row):
        return (row["p_bottom"] - row["p_top"])*WIDTH**2

    def test_the_pressure_drop_of_a_fluidised_bed_carries_its_weight_by_model_a_and_by_model_b(self):
        for model in ("modelA", "modelB"):
            with self.subTest(model=model):
                late = [row for row in self.column(model, hovering(), end=0.04).rows() if row["Time"] > 0.01]
                first, last = late[0], late[-1]
                mean = sum(self.lift(row) for row in late[1:])/(len(late) - 1)
                gained = (last["particleMomentumZ"] - first["particleMomentumZ"])/(last["Time"] - first["Time"])
                self.assertLess(abs(gained), 0.05*WEIGHT)
                self.assertAlmostEqual(mean, WEIGHT + gained, delta=1e-3*WEIGHT)

    def test_a_bed_that_is_held_resists_the_gas_alike_by_both_models(self):
        """Less than a bed without ends by what the outer layers miss: on their outer faces the gas has the mean of both void
        fractions, which slows it by 6 % in two of fourteen layers."""
        lifts = []
        for model in ("modelA", "modelB"):
            box = self.column(model, 0.5, end=0.01)
            box.replace("DEM/in.box", "fix move all nve/sphere", "")
            last = box.rows()[-1]
            lifts.append(self.lift(last)/resistance(0.5))
            self.assertAlmostEqual(last["forceZ"]/resistance(0.5), lifts[-1], delta=1e-3)
            self.assertGreater(lifts[-1], 0.975)
            self.assertLess(lifts[-1], 1)
        self.assertAlmostEqual(lifts[0], lifts[1], delta=0.01)


if __name__ == "__main__":
    unittest.main()
