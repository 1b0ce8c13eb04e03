# SPDX-License-Identifier: GPL-3.0-or-later
"""himField mirrors charges in the tangent planes of a circular cylinder with flat ends, whatever its direction, and in no other
curved wall."""

import csv
import math
import re
import unittest

from tiny_case import SoundCaseTests

EPSILON0 = 8.8541878128e-12
RADIUS = 0.05  # [m]
CHARGE = 1e-9  # [C]
FACETS = 24
UNIT = CHARGE / (4 * math.pi * EPSILON0 * RADIUS**2)  # [V/m]
VARIANTS = """mirrored { fieldMethod pairwiseSum; images yes; }
free { fieldMethod pairwiseSum; }
strict { fieldMethod p3m; cloudCells 4; gather quartic; deferredCorrection yes; }
"""
QUADRANTS = ((-1, -1), (1, -1), (1, 1), (-1, 1))
UPRIGHT = ((1, 0, 0), (0, 1, 0), (0, 0, 1))
LEANING = ((2 / 3, -1 / 3, 2 / 3), (2 / 3, 2 / 3, -1 / 3), (-1 / 3, 2 / 3, 2 / 3))  # rows: where x, y and the axis point to


def turned(frame, point):
    return tuple(sum(point[n] * frame[n][axis] for n in range(3)) for axis in range(3))


def o_grid(length, layers, frame=UPRIGHT, top=1.0, facets=FACETS):
    """blockMeshDict of a cylinder around the origin in radii: a square core and four blocks around it; `top`: the radius of the upper
    end over that of the lower one."""
    def written(x, y, z):
        size = top if z > 0 else 1
        return "(%.15g %.15g %.15g)" % turned(frame, (size * x, size * y, z))

    wall, core = math.sqrt(0.5), 0.45
    heights = (-0.5 * length, 0.5 * length)
    points = [written(size * x, size * y, z) for z in heights for size in (core, wall) for x, y in QUADRANTS]
    side = facets // 4
    blocks = "hex (0 1 2 3 8 9 10 11) (%d %d %d) simpleGrading (1 1 1)\n" % (side, side, layers)
    rim, ends, arcs = "", "(0 3 2 1) (8 9 10 11)", ""
    for a, b in ((0, 1), (1, 2), (2, 3), (3, 0)):
        blocks += "hex (%d %d %d %d %d %d %d %d) (%d 4 %d) simpleGrading (1 1 1)\n" % (
            a + 4, b + 4, b, a, a + 12, b + 12, b + 8, a + 8, side, layers)
        rim += "(%d %d %d %d) " % (a + 4, b + 4, b + 12, a + 12)
        ends += " (%d %d %d %d) (%d %d %d %d)" % (a + 4, a, b, b + 4, a + 12, b + 12, b + 8, a + 8)
        middle = ((QUADRANTS[a][0] + QUADRANTS[b][0]) / 2, (QUADRANTS[a][1] + QUADRANTS[b][1]) / 2)
        for first, z in ((4, heights[0]), (12, heights[1])):
            arcs += "arc %d %d %s\n" % (a + first, b + first, written(*middle, z))
    return """scale %.12g;\nvertices (%s);\nblocks (%s);\nedges (%s);
        boundary ( sides { type wall; faces (%s); } bottom { type wall; faces (%s); } );\n""" % (
        RADIUS, " ".join(points), blocks, arcs, rim, ends)


def cube():
    points = " ".join("(%d %d %d)" % (x, y, z) for z in (-1, 1) for x, y in QUADRANTS)
    return """scale %.12g; vertices (%s); blocks (hex (0 1 2 3 4 5 6 7) (6 6 6) simpleGrading (1 1 1));
        boundary ( sides { type wall; faces ((0 3 2 1) (4 5 6 7) (0 4 7 3) (1 2 6 5) (0 1 5 4) (3 7 6 2)); } );\n""" % (RADIUS, points)


def rounded(text):
    """The points file of the mesh of cube(), every cube inside it blown into a sphere."""
    head, rows, tail = re.match(r"(.*?\n\d+\n\(\n)(.*?)(\n\).*)", text, re.S).groups()
    points = [tuple(map(float, row.strip("()").split())) for row in rows.split("\n")]
    sizes = [max(map(abs, p)) / math.hypot(*p) if any(p) else 0 for p in points]
    return head + "\n".join("(%.15g %.15g %.15g)" % tuple(size * e for e in p) for size, p in zip(sizes, points)) + tail


class RoundWalls(SoundCaseTests):
    def setUp(self):
        super().setUp()
        self.case.write("constant/electrostaticProperties", "fieldMethod pairwiseSum;\n" + VARIANTS)

    def mesh(self, dictionary, *change):
        self.case.write("system/blockMeshDict", dictionary)
        self.case.tool("blockMesh")
        if change:
            self.case.tool(*change)

    def run_on(self, places, *options, ranks=1):
        """himField for unit charges of alternating sign at places in radii."""
        rows = ["%.16g,%.16g,%.16g,%r" % (*(RADIUS * e for e in place), CHARGE * (-1) ** n) for n, place in enumerate(places)]
        (self.case.path / "in.csv").write_text("x,y,z,q\n" + "\n".join(rows) + "\n")
        return self.case.run("-particles", "in.csv", *options, ranks=ranks, program="himField")

    def field(self, places, ranks=1):
        """Of the mirrored pair sum, in q/(4 pi eps0 RADIUS^2)."""
        result = self.run_on(places, "-method", "mirrored", "-output", "out.csv", ranks=ranks)
        self.assertEqual(result.code, 0, result.text)
        with open(self.case.path / "out.csv", newline="") as file:
            return [tuple(float(row[name]) / UNIT for name in ("Ex", "Ey", "Ez")) for row in csv.DictReader(file)]

    def assert_near(self, found, expected, tolerance):
        self.assertLess(math.dist(found, expected), tolerance * math.hypot(*expected))

    # --- images

    def test_a_charge_near_the_wall_of_a_long_cylinder_has_the_image_force_of_a_plane(self):
        # Exact in an endless cylinder of radius a, a tenth of it from the wall: 24.9357 q^2/(4 pi eps a^2), from the series over
        # K_m(ka)/I_m(ka) I_m(kr)^2 (the plane has 25). The facets lie up to 0.0086 a inside the circle: images in them would be
        # off by up to 20 %.
        for frame in (UPRIGHT, LEANING):
            self.mesh(o_grid(40, 8, frame))
            for angle in (0, 5, 7.5, 200):  # facets meet at odd multiples of 15 degrees from 45
                outward = turned(frame, (math.cos(math.radians(angle)), math.sin(math.radians(angle)), 0))
                found = self.field([tuple(0.9 * e for e in outward)])[0]
                self.assert_near(found, tuple(25 * e for e in outward), 1e-6)
                self.assert_near(found, tuple(24.9357 * e for e in outward), 3e-3)

    def test_a_charge_near_the_axis_keeps_one_image_where_all_round_it_cancels(self):
        # Exact at a hundredth of the radius: 0.0100 q^2/(4 pi eps a^2); the tangent plane's image gives a quarter.
        self.mesh(o_grid(40, 8))
        edges = 2 * 1.98 / math.hypot(1.98, 40) ** 3  # its images in the edges of both ends
        self.assert_near(self.field([(0.01, 0, 0)])[0], (0.25 / 0.99**2 - edges, 0, 0), 1e-8)

    def test_flat_ends_mirror_too_in_a_cylinder_as_long_as_it_is_wide(self):
        places = [(0.3, 0.5, -0.8), (-0.2, 0.1, 0.4), (0.1, -0.9, 0.7)]
        expected = [[0, 0, 0] for _ in places]
        for n, (x, y, z) in enumerate(places):
            stretch = 2 / math.hypot(x, y) - 1
            charges = [(1, (x, y, z)), (-1, (stretch * x, stretch * y, z))]
            charges += [(-sign, (*place[:2], 2 * end - z)) for sign, place in charges for end in (-1, 1)]
            for m, target in enumerate(places):
                for sign, place in charges[m == n:]:
                    for axis in range(3):
                        expected[m][axis] += sign * (-1) ** n * (target[axis] - place[axis]) / math.dist(target, place) ** 3
        for frame in (UPRIGHT, LEANING):
            self.mesh(o_grid(2, 6, frame))
            for found, here in zip(self.field([turned(frame, place) for place in places]), expected):
                self.assert_near(found, turned(frame, here), 1e-9)

    def test_ranks_without_an_end_or_a_side_find_the_same_cylinder(self):
        for length, frame in ((40, UPRIGHT), (2, LEANING)):
            self.mesh(o_grid(length, 8, frame))
            places = [turned(frame, place) for place in ((0.3, 0.5, -0.8), (-0.2, 0.1, 0.4), (0.1, -0.9, 0.7), (0.6, 0.6, -0.9))]
            serial = self.field(places)
            for ranks in (2, 4):
                self.case.decompose(ranks)
                for one, other in zip(serial, self.field(places, ranks)):
                    self.assert_near(other, one, 1e-11)

    def test_images_in_tangent_planes_are_no_reference(self):
        self.mesh(o_grid(2, 8))
        places = [(0.3, 0.5, -0.8), (-0.2, 0.1, 0.4), (0.1, -0.9, 0.7), (0.6, 0.6, -0.9)]
        result = self.run_on(places, "-compare", "-methods", "(mirrored free strict)", "-repeat", "1")
        self.assertEqual(result.code, 0, result.text)
        with open(self.case.path / "postProcessing/himField/compare.csv", newline="") as file:
            rows = {row["name"]: row for row in csv.DictReader(file)}
        self.assertEqual(rows["mirrored"]["left_out"], "")
        self.assertIn("p3m", rows["mirrored"]["reference"])
        self.assertIn("not exact", rows["mirrored"]["reference"])
        self.assertGreater(float(rows["mirrored"]["rms_error"]), 1e-3)
        self.assertLess(float(rows["mirrored"]["rms_error"]), 0.5 * float(rows["free"]["rms_error"]))

    # --- refusals

    def refused(self, reason):
        result = self.run_on([(0.1, 0.2, 0.3)], "-method", "mirrored")
        self.assertEqual(result.code, 1, result.text)
        self.assertIn("mirrored: images: found `yes`, but " + reason, " ".join(result.text.split()))

    def test_a_cone_a_sphere_an_elliptical_tube_and_a_prism_of_eight_sides_are_refused(self):
        for shape in ((o_grid(2, 6, top=0.8),), (o_grid(2, 6), "transformPoints", "-scale", "(1.1 1 1)"), (o_grid(2, 6, facets=8),)):
            self.mesh(*shape)
            self.refused("the walls are curved")
        self.mesh(cube())
        points = self.case.path / "constant/polyMesh/points"
        points.write_text(rounded(points.read_text()))
        self.refused("the walls are curved")

    def test_an_end_at_a_voltage_is_refused(self):
        self.mesh(o_grid(2, 6))
        self.field([(0.1, 0.2, 0.3)])
        self.case.replace("0/electricPotential", "bottom { type fixedValue; value uniform 0; }",
                          "bottom { type fixedValue; value uniform 5; }")
        self.refused("patch bottom is at a voltage")


if __name__ == "__main__":
    unittest.main(verbosity=2)
