# SPDX-License-Identifier: GPL-3.0-or-later
"""p3m where the mesh goes round a corner or a wall ends in it: images stay on their side."""
import csv
import math
import tempfile
import unittest

from tiny_case import TinyCase

EPS0 = 8.8541878128e-12
CHARGE = 1e-12
# An L of three cubes of 50 mm, twice as deep: walls x = 0.05 above y = 0.05 and y = 0.05 beyond x = 0.05 meet in its re-entrant edge.
DUCT = """
scale 0.05;
vertices ((0 0 0)(1 0 0)(2 0 0)(0 1 0)(1 1 0)(2 1 0)(0 2 0)(1 2 0)
          (0 0 2)(1 0 2)(2 0 2)(0 1 2)(1 1 2)(2 1 2)(0 2 2)(1 2 2));
blocks (hex (0 1 4 3 8 9 12 11) (%(n)d %(n)d %(m)d) simpleGrading (1 1 1)
        hex (1 2 5 4 9 10 13 12) (%(n)d %(n)d %(m)d) simpleGrading (1 1 1)
        hex (3 4 7 6 11 12 15 14) (%(n)d %(n)d %(m)d) simpleGrading (1 1 1));
boundary (bottom { type wall; faces ((0 3 4 1)(1 4 5 2)(3 6 7 4)); }
          top { type wall; faces ((8 9 12 11)(9 10 13 12)(11 12 15 14)); }
          sides { type wall; faces ((0 1 9 8)(1 2 10 9)(2 5 13 10)(5 4 12 13)(4 7 15 12)(7 6 14 15)(6 3 11 14)(3 0 8 11)); });
"""
SOLVER = "solvers { electricPotential { solver PCG; preconditioner DIC; tolerance 1e-8; maxIter 2000; } }"
METHODS = """fieldMethod p3m;
two { fieldMethod p3m; cloudCells 2; }
three { fieldMethod p3m; cloudCells 3; gather quartic; deferredCorrection yes; }
four { fieldMethod p3m; cloudCells 4; gather quartic; deferredCorrection yes; }
"""


def norm(vector):
    return math.sqrt(sum(x * x for x in vector))


def own_response(x, y, angle, sign):
    """E of a unit charge's own images or induced charges over q/(4 pi eps0) [1/m2], in a wedge between the rays of polar angles 0 and
    `angle`, conductors (sign -1) or insulated (+1). From H. M. Macdonald's potential of a point charge in a wedge (L. D. Landau and E. M.
    Lifshitz, Electrodynamics of Continuous Media, section 3; insulated: the same with a plus), less that of a half space, which is an image."""
    a = math.pi / angle

    def potential(polar):  # of the charge at itself, times the distance from the edge
        def difference(zeta):
            own = 1 / math.tanh(a * zeta / 2) / angle - 1 / math.tanh(zeta / 2) / math.pi
            image = (math.sinh(a * zeta) / (math.cosh(a * zeta) - math.cos(2 * a * polar)) / angle
                     - math.sinh(zeta) / (math.cosh(zeta) - math.cos(2 * polar)) / math.pi)
            return (own + sign * image) / math.sqrt(math.cosh(zeta) - 1)
        step = 0.01
        return sign / (2 * abs(math.sin(polar))) + step / math.sqrt(2) * sum(difference((n + 0.5) * step) for n in range(6000))

    distance, polar = math.hypot(x, y), math.atan2(y, x)
    outward = 0.5 * potential(polar) / distance ** 2
    around = -0.5 * (potential(polar + 1e-4) - potential(polar - 1e-4)) / 2e-4 / distance ** 2
    return (outward * x - around * y) / distance, (outward * y + around * x) / distance


class Reentrant(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.duct = {cells: cls.make("duct%d" % cells, DUCT % {"n": cells, "m": 2 * cells}) for cells in (10, 20)}

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    @classmethod
    def make(cls, name, mesh):
        case = TinyCase("%s/%s" % (cls.folder.name, name), "p3m", cells=(4, 4, 4))
        case.write("system/blockMeshDict", mesh)
        case.tool("blockMesh")
        case.write("system/fvSolution", SOLVER)
        case.write("constant/electrostaticProperties", METHODS)
        return case

    def field(self, case, charges, method):
        (case.path / "in.csv").write_text("x,y,z,q\n" + "".join("%r,%r,%r,%r\n" % charge for charge in charges))
        result = case.run("-particles", "in.csv", "-method", method, "-output", "out.csv", program="himField")
        self.assertEqual(result.code, 0, result.text)
        with open(case.path / "out.csv", newline="") as file:
            return [tuple(float(row[name]) for name in ("Ex", "Ey", "Ez")) for row in csv.DictReader(file)]

    def test_a_charge_has_no_image_inside_the_mesh_behind_a_reentrant_edge(self):
        # Mirrored in the plane of x = 0.05, which it stands behind, the charge would have an image at `mirror`, in the mesh.
        charge, mirror = (0.06, 0.0485, 0.07), (0.04, 0.0485, 0.07)
        probes = [mirror, (0.0411, 0.0485, 0.07), (0.0385, 0.0485, 0.07), (0.04, 0.0465, 0.072)]
        charges = [(*charge, CHARGE)] + [(*probe, 0.0) for probe in probes]
        smooth = self.field(self.duct[20], charges, "three")[1:]
        for method in ("two", "three", "four"):
            for probe, one, other in zip(probes, self.field(self.duct[10], charges, method)[1:], smooth):
                # A free charge has 19 to 25 V/m there; in the duct the wall above takes most of it.
                free = CHARGE / (4 * math.pi * EPS0 * math.dist(charge, probe) ** 2)
                self.assertLess(norm([a - b for a, b in zip(one, other)]), 0.05 * free, (method, probe))

    def test_a_charge_at_the_mirror_place_of_another_one_is_allowed(self):
        charges = [(0.06, 0.0485, 0.07, CHARGE), (0.04, 0.0485, 0.07, -CHARGE)]
        for method in ("two", "three"):
            for vector in self.field(self.duct[10], charges, method):
                self.assertLess(norm(vector), 2e3)  # of the order of the image of each, 1e3 V/m

    def test_response_in_a_right_angle_is_that_of_three_images(self):
        x, y = 0.003, 0.002
        for sign in (-1, 1):
            across = 1 / (4 * (x * x + y * y) ** 1.5)
            exact = (sign / (4 * x * x) + x * across, sign / (4 * y * y) + y * across)
            for value, image in zip(own_response(x, y, math.pi / 2, sign), exact):
                self.assertAlmostEqual(value / image, 1, delta=1e-6)

    def test_a_charge_beside_a_reentrant_edge_of_insulated_walls_is_pushed_like_in_a_wedge(self):
        # 3 mm from the edge, less than R, it has no image: what pushes it is the gradient on the mesh that cancels the one of its
        # short-range part. Errors are those of the mesh, as p3m.md says.
        case = self.make("insulated", DUCT % {"n": 20, "m": 40})
        ground = "type fixedValue; value uniform 0;"
        case.write("0/electricPotential", "dimensions [1 2 -3 0 0 -1 0]; internalField uniform 0; boundaryField "
                   "{ bottom { %s } top { %s } sides { type zeroGradient; } }" % (ground, ground), "volScalarField")
        for walls, sign in ((case, 1), (self.duct[20], -1)):
            for along, allowed in ((0.01, 0.08), (0.006, 0.08), (0.003, 0.15)):
                gap = 0.0015
                x, y = own_response(along, gap, 1.5 * math.pi, sign)
                exact = [CHARGE / (4 * math.pi * EPS0) * e for e in (x, -y, 0)]
                found = self.field(walls, [(0.05 + along, 0.05 - gap, 0.0501, CHARGE)], "two")[0]
                error = norm([a - b for a, b in zip(found, exact)]) / norm(exact)
                print("sign %d, %g mm from the edge:" % (sign, 1e3 * along), error)
                self.assertLess(error, allowed, (sign, along))


if __name__ == "__main__":
    unittest.main()
