# SPDX-License-Identifier: GPL-3.0-or-later
"""Momentum of gas and particles together, in boxes without a boundary, through himFoam."""

import math
import random
import tempfile
import unittest

from gas_box import GasBox, vector


def spheres(number, size, diameter, speed=0.5, seed=1):
    """Spheres on a shaken lattice, so that they meet now and then."""
    random.seed(seed)
    side = math.ceil(number**(1/3))
    places = [((i + 0.5)*size/side, (j + 0.5)*size/side, (k + 0.5)*size/side)
              for i in range(side) for j in range(side) for k in range(side)]
    return [(tuple(x + 0.1*diameter*random.uniform(-1, 1) for x in place), tuple(random.uniform(-speed, speed) for _ in range(3)),
             diameter, 1000.0) for place in random.sample(places, number)]


def difference(a, b):
    return [x - y for x, y in zip(a, b)]


def size(vector):
    return math.sqrt(sum(x*x for x in vector))


def skew_mesh(size, cells, slide=0.12):
    """A cube of eight blocks whose middle points are displaced: faces across one another, cyclic pairs alike."""
    middle = {(1, 1, 1): (slide, -0.8*slide, 0.6*slide)}
    for axis in range(3):
        shift = [0.0, 0.0, 0.0]
        shift[(axis + 1) % 3], shift[(axis + 2) % 3] = slide, -0.7*slide
        for side in (0, 2):
            middle[tuple(side if direction == axis else 1 for direction in range(3))] = shift
    points = [(i, j, k) for k in range(3) for j in range(3) for i in range(3)]
    number = {point: n for n, point in enumerate(points)}
    corner = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
    faces = {"left": (0, (0, 4, 7, 3)), "right": (0, (1, 2, 6, 5)), "front": (1, (0, 1, 5, 4)), "back": (1, (3, 7, 6, 2)),
             "bottom": (2, (0, 3, 2, 1)), "top": (2, (4, 5, 6, 7))}
    blocks, patches = [], {name: [] for name in faces}
    for base in ((i, j, k) for i in range(2) for j in range(2) for k in range(2)):
        here = [number[tuple(b + c for b, c in zip(base, at))] for at in corner]
        blocks.append("hex (%s) (%d %d %d) simpleGrading (1 1 1)" % (" ".join(map(str, here)), cells//2, cells//2, cells//2))
        for name, (axis, of) in faces.items():
            if base[axis] == (1 if name in ("right", "back", "top") else 0):
                patches[name].append("(%s)" % " ".join(str(here[n]) for n in of))
    places = ["(%r %r %r)" % tuple(0.5*p + s for p, s in zip(point, middle.get(point, (0, 0, 0)))) for point in points]
    partner = {"left": "right", "right": "left", "front": "back", "back": "front", "bottom": "top", "top": "bottom"}
    boundary = ["%s { type cyclic; neighbourPatch %s; faces (%s); }" % (name, partner[name], " ".join(patches[name])) for name in faces]
    return "scale %r;\nvertices (%s);\nblocks (%s);\nboundary (%s);\n" % (size, " ".join(places), " ".join(blocks), "\n".join(boundary))


class Momentum(unittest.TestCase):
    def box(self, *arguments, **entries):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        return GasBox(folder.name, *arguments, **entries)

    def check_books(self, rows):
        """Gas: what it has less than at the start it gave. Particles: what they have more they got. Both to rounding."""
        first, scale = rows[0], max(size(vector(row, "gasMomentum")) + size(vector(row, "particleMomentum")) for row in rows)
        for row in rows:
            for has, moved, sign in (("gasMomentum", "given", -1), ("particleMomentum", "got", 1)):
                gained = difference(vector(row, has), vector(first, has))
                booked = [sign*x for x in difference(vector(row, moved), vector(first, moved))]
                self.assertLess(size(difference(gained, booked)), 1e-12*scale, "%s at %g s" % (has, row["Time"]))

    def test_in_a_box_without_walls_momentum_of_gas_and_particles_is_kept_for_ten_thousand_steps(self):
        rows = self.box(spheres(6, 0.02, 3e-3), size=0.02, cells=4, U="uniform (1 0.5 -0.2)", step=2e-5, demStep=2e-5, end=0.2,
                        more="virtualMass 0.5; lift Saffman;").rows()
        self.assertEqual(len(rows), 10000)
        self.check_books(rows)
        # The sum of both moves by no more than what one solve gives ahead of the DEM, and does not drift.
        total = [[x + y for x, y in zip(vector(row, "gasMomentum"), vector(row, "particleMomentum"))] for row in rows]
        ahead = [difference(vector(row, "given"), vector(row, "got")) for row in rows]
        start = [x + y for x, y in zip(total[0], ahead[0])]
        for now, owed in zip(total, ahead):
            self.assertLess(size(difference([x + y for x, y in zip(now, owed)], start)), 1e-12*size(start))
        typical = sorted(size(owed) for owed in ahead[-1000:])[500]      # some steps move a sphere to another cell
        self.assertLess(typical, 1e-4*size(start))

    def test_books_close_for_every_void_fraction_model_and_both_pressure_models(self):
        for model in ("centre;", "divided;", "smoothed; smoothingLength 8e-3;"):
            for pressure in ("modelA", "modelB"):
                with self.subTest(model=model, pressure=pressure):
                    box = self.box(spheres(40, 0.04, 4e-3), U="uniform (1 0.5 -0.2)", voidFraction=model,
                                   more="pressureModel %s;" % pressure, end=3e-3)
                    self.check_books(box.rows())

    def test_a_particle_that_feels_the_velocity_at_its_own_place_gets_what_the_gas_gives_for_it(self):
        """Else the mismatch would be that of the two velocities, a tenth of the slip."""
        for model in ("centre;", "divided;", "smoothed; smoothingLength 8e-3;"):
            mismatches = []
            for interpolation in ("cell", "cellPoint"):
                with self.subTest(model=model, interpolation=interpolation):
                    rows = self.box(spheres(40, 0.04, 4e-3), U="uniform (1 0.5 -0.2)", voidFraction=model, outer=2, end=3e-3,
                                    more="velocityInterpolation %s;" % interpolation).rows()
                    self.check_books(rows)
                    mismatches.append(max(row["mismatch"] for row in rows[10:]))
            self.assertLess(mismatches[1], 2*mismatches[0] + 1e-6)

    def test_on_a_mesh_whose_faces_stand_askew_momentum_is_kept_too(self):
        for model in ("centre;", "divided;", "smoothed; smoothingLength 8e-3;"):
            with self.subTest(model=model):
                box = self.box(spheres(40, 0.04, 4e-3), U="uniform (1 0.5 -0.2)", voidFraction=model, outer=2, end=3e-3,
                               more="velocityInterpolation cellPoint; largestParticle 3;")
                box.write("system/blockMeshDict", skew_mesh(0.04, 8))
                box.tool("blockMesh")
                angle = box.tool("checkMesh").text.split("non-orthogonality Max: ")[1].split()[0]
                self.assertGreater(float(angle), 40)
                box.replace("system/fvSolution", "nNonOrthogonalCorrectors 0", "nNonOrthogonalCorrectors 2")
                rows = box.rows()
                self.check_books(rows)
                for row in rows:
                    self.assertAlmostEqual(row["solidVolume"] / (40*math.pi/6*4e-3**3), 1, delta=1e-12)
                # Gas and particles together, without what one solve is ahead by.
                total = [[sum(parts) for parts in zip(vector(row, "gasMomentum"), vector(row, "particleMomentum"))] for row in rows]
                ahead = [difference(vector(row, "given"), vector(row, "got")) for row in rows]
                start = [sum(parts) for parts in zip(total[0], ahead[0])]
                for now, owed in zip(total, ahead):
                    self.assertLess(size(difference([sum(parts) for parts in zip(now, owed)], start)), 1e-12*size(start))
                # Cells do not see the pressure that their faces balance; the next step makes up for it.
                self.assertLess(max(row["mismatch"] for row in rows[10:]), 0.1)

    def test_two_outer_correctors_leave_less_to_give_back(self):
        """What the first iteration's fluxes do wrong, because they do not fit the void fraction of the moment."""
        wrong = []
        for outer in (1, 2):
            rows = self.box(spheres(40, 0.04, 4e-3), U="uniform (1 0.5 -0.2)", outer=outer).rows()
            wrong.append(max(row["mismatch"] for row in rows[20:]))
        self.assertLess(wrong[1], 0.05*wrong[0])

    def test_the_gas_step_follows_the_courant_number_in_whole_dem_steps_up_to_its_bound(self):
        for most, bound in ((0.05, 2e-4), (0.05, 5e-5)):
            with self.subTest(bound=bound):
                rows = self.box(spheres(6, 0.02, 3e-3), size=0.02, cells=4, U="uniform (1 0.5 -0.2)", step=2e-5, end=8e-3,
                                more="adjustTimeStep yes; maxCo %r; maxDeltaT %r;" % (most, bound)).rows()
                steps = [row["deltaT"] for row in rows]
                for step in steps:
                    self.assertAlmostEqual(step/1e-5, round(step/1e-5), delta=1e-6)
                self.assertLess(max(steps), bound*(1 + 1e-9))
                # The Courant number of a step is known after it: where it was too large, the next step would have kept it.
                above = [(row, after) for row, after in zip(rows, rows[1:]) if row["Co"] > most]
                for row, after in above:
                    self.assertLessEqual(after["deltaT"], max(row["deltaT"]*most/row["Co"], 1e-5)*(1 + 1e-9), "at %g s" % row["Time"])
                self.assertLess(len(above), len(rows)/4)
                if bound == 2e-4:
                    self.assertGreater(max(row["Co"] for row in rows[len(rows)//2:]), 0.8*most)
                else:
                    self.assertEqual(round(max(steps)/1e-5), 5)

    def test_a_run_whose_step_follows_the_courant_number_continues_bit_for_bit(self):
        box = self.box(spheres(6, 0.02, 3e-3), size=0.02, cells=4, U="uniform (1 0.5 -0.2)", step=2e-5, end=8e-3, gravity=9.81,
                       more="adjustTimeStep yes; maxCo 0.05; maxDeltaT 2e-4;")
        box.replace("system/controlDict", "writeInterval 100000", "writeInterval 20")
        straight = box.rows()
        self.assertGreater(max(row["deltaT"] for row in straight), 5e-5)
        start = sorted((path.name for path in box.path.glob("0.*")), key=float)[0]
        box.replace("system/controlDict", "startTime 0;", "startTime %s;" % start)
        continued = box.rows(start=start)
        self.assertEqual(len(continued), len(straight) - 20)
        for row, expected in zip(continued, straight[20:]):
            for name in ("deltaT", "forceX", "massCentreX", "massCentreZ", "gasMomentumX", "particleMomentumX", "particleMomentumZ"):
                self.assertEqual(row[name], expected[name], "%s at %g s" % (name, row["Time"]))

    def test_every_number_of_ranks_gives_the_same_gas_where_no_patch_gives_a_pressure(self):
        results = {}
        for ranks in (1, 2, 4):
            rows = self.box(spheres(40, 0.04, 4e-3), U="uniform (1 0.5 -0.2)", voidFraction="divided;",
                            more="velocityInterpolation cellPoint;").rows(ranks)
            self.check_books(rows)
            results[ranks] = rows[-1]
        for ranks in (2, 4):
            for name in ("given", "got"):
                off = size(difference(vector(results[ranks], name), vector(results[1], name)))
                self.assertLess(off, 1e-6*size(vector(results[1], name)), "%s on %d ranks" % (name, ranks))

    def test_a_mesh_that_is_cut_anew_through_its_cyclic_patches_goes_on_with_the_same_gas(self):
        """decomposePar gives the values of the own cells to what it cuts out of a cyclic patch."""
        box = self.box(spheres(40, 0.04, 4e-3), walls=("bottom", "top"), U="uniform (1 0.5 -0.2)", voidFraction="divided;", end=4e-3)
        box.replace("system/controlDict", "writeInterval 100000;", "writeInterval 20;")
        straight = {round(row["Time"], 7): row for row in box.rows()}
        box.replace("system/controlDict", "startTime 0;", "startTime 0.002;")
        box.write("system/decomposeParDict", "numberOfSubdomains 4; method simple; simpleCoeffs { n (2 2 1); delta 0.001; }")
        box.tool("decomposePar", "-force", "-time", "0.002")
        result = box.run(ranks=4)
        self.assertEqual(result.code, 0, result.text[-2000:])
        rows = box.table("0.002")
        self.assertGreater(len(rows), 15)
        for row in rows:
            expected = straight[round(row["Time"], 7)]
            for name in ("gasMomentum", "particleMomentum"):
                off = size(difference(vector(row, name), vector(expected, name)))
                self.assertLess(off, 1e-7*size(vector(straight[0.002], name)), "%s at %g s" % (name, row["Time"]))
            for name in ("p_bottom", "p_top"):
                self.assertAlmostEqual(row[name], expected[name], delta=1e-5*max(abs(line["p_bottom"]) for line in straight.values()))

    def test_a_box_that_gas_can_enter_but_not_leave_stops_the_run(self):
        box = self.box([((0.02, 0.02, 0.02), (0, 0, 0), 1e-3, 1000.0)], walls=("left", "right", "front", "back", "bottom", "top"),
                       wall_U={"bottom": "(0 0 0.1)"})
        result = box.run()
        self.assertNotEqual(result.code, 0)
        self.assertIn("no patch gives the pressure of the gas, but 0.00016 m3/s more enter than leave", " ".join(result.text.split()))


if __name__ == "__main__":
    unittest.main()
