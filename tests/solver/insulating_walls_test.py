# SPDX-License-Identifier: GPL-3.0-or-later
"""Charged insulating walls and zones of other permittivity: the potential and the field against exact solutions."""

import math
import tempfile
import unittest

from tiny_case import SIZE, TinyCase

EPSILON0 = 8.8541878128e-12
INTERFACE = 0.04  # height of the wall [m]

SLABS = """
scale %(size)g;
vertices
(
    (0 0 0) (1 0 0) (1 1 0) (0 1 0) (0 0 0.4) (1 0 0.4) (1 1 0.4) (0 1 0.4) (0 0 1) (1 0 1) (1 1 1) (0 1 1)
);
blocks
(
    hex (0 1 2 3 4 5 6 7) lower (%(nx)d %(nx)d %(lower)d) simpleGrading (1 1 1)
    hex (4 5 6 7 8 9 10 11) upper (%(nx)d %(nx)d %(upper)d) simpleGrading (1 1 1)
);
boundary
(
    bottom { type wall; faces ((0 3 2 1)); }
    top    { type wall; faces ((8 9 10 11)); }
    sides  { type wall; faces ((0 4 7 3) (1 2 6 5) (0 1 5 4) (3 7 6 2) (4 8 11 7) (5 6 10 9) (4 5 9 8) (7 11 10 6)); }
);
"""

WALL = "insulatingWalls { middle { betweenZones (lower upper); } }\n"
INSULATED_SIDES = ("sides { type fixedValue; value uniform 0; }", "sides { type zeroGradient; }")


def slabs(folder, method="him", zones="", wall=WALL, lower=4, upper=6, nx=4, voltage=0, particles=None):
    """Two slabs between plates, the lower one at 0 V, with a wall between the slabs."""
    case = TinyCase(folder, method, particles=particles or [((0.05, 0.05, 0.05), (0., 0., 0.), 0.)], diameter=0.001)
    case.write("system/blockMeshDict", SLABS % {"size": SIZE, "lower": lower, "upper": upper, "nx": nx})
    case.tool("blockMesh")
    case.replace("constant/electrostaticProperties", "relativePermittivity 1;", "relativePermittivity 1;\n" + wall + zones)
    case.replace("0/electricPotential", *INSULATED_SIDES)
    case.replace("0/electricPotential", "top { type fixedValue; value uniform 0; }",
                 "top { type fixedValue; value uniform %r; }" % voltage)
    case.replace("constant/electrostaticProperties", "externalField (0 0 1000);", "")
    if method == "him":
        case.replace("constant/electrostaticProperties", "himCoeffs { nearCutoff 0.02; }", "himCoeffs { nearCutoff 0.06; }")
    return case


def probe(case, surface="", density="", ranks=1):
    case.write("constant/probeProperties", "surfaceCharge { %s }\nchargeDensity { %s }\n" % (surface, density))
    if ranks > 1:
        case.decompose(ranks)
    result = case.run(program="wallProbe", ranks=ranks)
    if result.code != 0:
        raise RuntimeError(result.text)
    lines = (line.split() for line in result.text.splitlines())
    return {words[0]: float(words[1]) for words in lines if len(words) == 2 and words[0][0].isalpha() and "." not in words[1][:1]
            and words[1][0] in "-0123456789"}


def fourier_field_y(x, y, side, width, density, sigma):
    """E_y [V/m] at (x, y) in a grounded square 0..side, in whose middle a square of `width` holds `density` [C/m3] and its rim
    `sigma` [C/m2]: sine series across, Green's function of y'' - k^2 along, both integrals in closed form."""
    lo, hi = 0.5 * (side - width), 0.5 * (side + width)
    field = 0.0
    for m in range(1, 6001, 2):  # even terms vanish by symmetry
        k = m * math.pi / side
        bulk = (math.cos(k * lo) - math.cos(k * hi)) * 2 / (k * side)
        rim = 2 / side * (math.sin(k * lo) + math.sin(k * hi)) * sigma
        slab = bulk * density + rim

        def ratio(a, b):
            """sinh(k a)/sinh(k b) for a <= b, without overflow; cosh in place of the first one."""
            return math.exp(k * (a - b)) / (1 - math.exp(-2 * k * b))

        def sinh_over(a):
            return ratio(a, side) * (1 - math.exp(-2 * k * a))

        def cosh_over(a):
            return ratio(a, side) * (1 + math.exp(-2 * k * a))

        def slope(source):
            """d/dy of G(y, source), G = sinh(k y<) sinh(k (side - y>))/(k sinh(k side)); products of two exponentials."""
            below, above = min(y, source), side - max(y, source)
            near = math.exp(k * (below + above - side)) / (2 * (1 - math.exp(-2 * k * side)))
            if y < source:
                return near * (1 + math.exp(-2 * k * below)) * (1 - math.exp(-2 * k * above))
            return -near * (1 - math.exp(-2 * k * below)) * (1 + math.exp(-2 * k * above))

        def slope_of_slab(a, b):
            """Integral of slope over the sources a..b that lie on one side of y, in closed form."""
            def antiderivative(source):
                below, above = min(y, source), side - max(y, source)
                near = math.exp(k * (below + above - side)) / (2 * (1 - math.exp(-2 * k * side)) * k)
                return -near * (1 + math.exp(-2 * k * below)) * (1 + math.exp(-2 * k * above))
            return antiderivative(b) - antiderivative(a)

        total = bulk * sigma * (slope(lo) + slope(hi))
        cuts = [lo] + ([y] if lo < y < hi else []) + [hi]
        total += slab * sum(slope_of_slab(a, b) for a, b in zip(cuts, cuts[1:]))
        field -= math.sin(k * x) * total / EPSILON0
    return field


class InsulatingWalls(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def test_a_charged_interface_of_two_slabs_has_the_exact_potential(self):
        sigma = 1e-6
        for below, voltage in ((1.0, 0.0), (3.0, 0.0), (6.5, -700.0)):
            case = slabs("%s/%g" % (self.folder, below), zones="zonePermittivity { lower %g; }" % below, voltage=voltage)
            found = probe(case, "middle %r;" % sigma)
            a, b = below * EPSILON0 / INTERFACE, EPSILON0 / (SIZE - INTERFACE)
            exact = (b * voltage + sigma) / (a + b)  # S2.25 with the plates in place of the cells
            for name in ("potential", "least", "most"):
                self.assertAlmostEqual(found["middle." + name] / exact, 1, delta=1e-9)
            field = case.field_values("0/electricField")
            for cell in range(4 * 16):
                self.assertAlmostEqual(field[cell][2] / (-exact / INTERFACE), 1, delta=1e-7)
            for cell in range(4 * 16, 10 * 16):
                self.assertAlmostEqual(field[cell][2] / ((exact - voltage) / (SIZE - INTERFACE)), 1, delta=1e-7)

    def test_the_exact_potential_does_not_need_equal_cells_at_the_two_sides(self):
        case = slabs(self.folder, zones="zonePermittivity { lower 4; }", lower=7, upper=3)
        found = probe(case, "middle 2e-6;")
        self.assertAlmostEqual(found["middle.potential"] / (2e-6 / (4 * EPSILON0 / 0.04 + EPSILON0 / 0.06)), 1, delta=1e-9)

    def test_flux_through_any_closed_set_of_patches_and_walls_is_the_charge_inside(self):
        """Gauss' law, with sides at 0 V so that the field is nowhere simple, on one to four ranks."""
        reference = None
        for ranks in (1, 2, 4):
            case = slabs("%s/%d" % (self.folder, ranks), zones="zonePermittivity { upper 3; }", lower=5, upper=5, nx=6)
            case.replace("0/electricPotential", *reversed(INSULATED_SIDES))
            found = probe(case, "middle -3e-6;", "lower 2e-5; upper 7e-5;", ranks)
            charge = -3e-6 * SIZE**2 + (2e-5 * 0.4 + 7e-5 * 0.6) * SIZE**3
            self.assertAlmostEqual(found["charge"] / charge, 1, delta=1e-12)
            flux = found["bottom.flux"] + found["top.flux"] + found["sides.flux"]
            self.assertAlmostEqual(flux / charge, 1, delta=1e-9)
            # Around each slab, the charged wall being outside of both: plate, its part of the sides, its side of the wall.
            self.assertAlmostEqual(found["lower.flux"] / (2e-5 * 0.4 * SIZE**3), 1, delta=1e-8)
            self.assertAlmostEqual(found["upper.flux"] / (7e-5 * 0.6 * SIZE**3), 1, delta=1e-8)
            reference = reference or found
            for name, value in reference.items():
                self.assertAlmostEqual(found[name], value, delta=1e-9 * max(abs(value), 1e-9), msg="%s, %d ranks" % (name, ranks))

    def test_a_plate_at_the_edge_holds_the_charge_of_a_capacitor(self):
        """insulatingWall in place of the bottom: gas of 0.1 m in series with a plate of 2 mm."""
        sigma, thickness, relative = 5e-7, 2e-3, 6.5
        case = slabs(self.folder, wall="")
        case.replace("0/electricPotential", "bottom { type fixedValue; value uniform 0; }",
                     "bottom { type insulatingWall; thickness %r; relativePermittivity %r; outerPotential 50; }"
                     % (thickness, relative))
        found = probe(case, "bottom %r;" % sigma)
        plate, gas = relative * EPSILON0 / thickness, EPSILON0 / SIZE
        exact = (plate * 50 + sigma) / (plate + gas)
        potential = case.field_values("0/electricPotential")
        self.assertAlmostEqual(potential[0] / (exact * (1 - 0.1 * 0.5)), 1, delta=1e-9)
        self.assertAlmostEqual(found["top.flux"] / (gas * exact * SIZE**2), 1, delta=1e-9)
        self.assertAlmostEqual(found["charge"] / (sigma * SIZE**2), 1, delta=1e-12)

    def square_column(self, cells):
        """RMS and largest error of the field, over its largest value, of a filled column with opposite charge on its wall."""
        side, width, density = 0.04, 0.01, 1e-3
        sigma = -0.25 * width * density
        lines = [0, 0.015, 0.025, 0.04]
        counts = [3 * cells // 2, cells, 3 * cells // 2]
        vertices = "".join("(%g %g %g)" % (x, y, z) for z in (0, 0.004) for y in lines for x in lines)
        blocks = ""
        for j in range(3):
            for i in range(3):
                v = [4 * (j + b) + i + a for b, a in ((0, 0), (0, 1), (1, 1), (1, 0))]
                zone = "bed" if (i, j) == (1, 1) else "outside"
                blocks += "hex (%s) %s (%d %d 2) simpleGrading (1 1 1)\n" % (
                    " ".join(map(str, v + [n + 16 for n in v])), zone, counts[i], counts[j])
        case = TinyCase("%s/%d" % (self.folder, cells), particles=[((0.02, 0.02, 0.002), (0., 0., 0.), 0.)], diameter=1e-4)
        case.write("system/blockMeshDict", "scale 1; vertices (%s); blocks (%s); defaultPatch { name sides; type wall; } boundary "
                   "( bottom { type wall; faces (%s); } top { type wall; faces (%s); } );"
                   % (vertices, blocks,
                      "".join("(%d %d %d %d)" % (n, n + 4, n + 5, n + 1) for n in range(12) if n % 4 < 3),
                      "".join("(%d %d %d %d)" % (n + 16, n + 17, n + 21, n + 20) for n in range(12) if n % 4 < 3)))
        case.tool("blockMesh")
        case.replace("constant/electrostaticProperties", "relativePermittivity 1;",
                     "relativePermittivity 1; insulatingWalls { column { betweenZones (bed outside); } }")
        text = (case.path / "0/electricPotential").read_text()
        for plate in ("bottom", "top"):
            text = text.replace("%s { type fixedValue; value uniform 0; }" % plate, "%s { type zeroGradient; }" % plate)
        (case.path / "0/electricPotential").write_text(text)
        found = probe(case, "column %r;" % sigma, "bed %r;" % density)
        inside = density * width**2 * 0.004
        self.assertAlmostEqual(found["bed.flux"] / inside, 1, delta=1e-8)
        self.assertAlmostEqual(found["outside.flux"] / inside, 0, delta=1e-8)
        self.assertAlmostEqual(found["sides.flux"] / inside, 0, delta=1e-8)     # the wall has the opposite charge
        case.tool("postProcess", "-func", "writeCellCentres", "-time", "0")
        fields = case.field_values("0/electricField")
        centres = list(zip(case.field_values("0/Cx"), case.field_values("0/Cy"), case.field_values("0/Cz")))
        row = max(y for x, y, z in centres if y < 0.5 * side)  # the row of cells beside the middle
        errors, largest = [], 0
        for (x, y, z), field in zip(centres, fields):
            if y != row or z > 0.002 or not 0.008 < x < 0.5 * side:
                continue
            # By symmetry the field along x at (x, y) is the one along y at (y, x).
            exact = fourier_field_y(y, x, side, width, density, sigma)
            largest = max(largest, abs(exact))
            errors.append(abs(field[0] - exact))
        self.assertGreater(len(errors), cells // 2)
        return math.sqrt(sum(e * e for e in errors) / len(errors)) / largest, max(errors) / largest

    def test_the_field_of_a_charged_column_is_right_on_both_sides_of_its_wall(self):
        coarse, fine = self.square_column(10), self.square_column(20)
        print("RMS and largest error of the field with 10 and 20 cells across:", coarse, fine)
        self.assertLess(fine[0], coarse[0] / 2.5)
        self.assertLess(fine[0], 0.01)
        self.assertLess(fine[1], 0.03)

    def fields_at(self, method, heights, entry=""):
        """Field along z at particles without charge in a column over a wall of 1e-6 C/m2; plates at 0 V."""
        particles = [((0.031 + 0.007 * n, 0.047, z), (0., 0., 0.), 0.) for n, z in enumerate(heights)]
        case = slabs("%s/%s%d" % (self.folder, method, len(entry)), method, zones=entry, lower=8, upper=12, nx=10,
                     particles=particles)
        probe(case, "middle 1e-6;")
        case.replace("DEM/in.cube", "fix move all nve/sphere\n", "")
        case.replace("system/controlDict", "endTime 2e-3; deltaT 1e-3;", "endTime 1e-5; deltaT 1e-5;")
        case.replace("system/controlDict", "writeInterval 2;", "writeInterval 1;")
        result = case.run()
        self.assertEqual(result.code, 0, result.text)
        found = case.particles("1e-05")
        return [found[n + 1]["electricField"][2] for n in range(len(heights))]

    def test_particles_beside_a_charged_wall_feel_its_field_to_the_last_cell(self):
        potential = 1e-6 / (EPSILON0 / INTERFACE + EPSILON0 / (SIZE - INTERFACE))
        heights = [0.011, 0.0321, 0.0389, 0.0399, 0.0401, 0.0412, 0.0487, 0.08]
        exact = [-potential / INTERFACE if z < INTERFACE else potential / (SIZE - INTERFACE) for z in heights]
        corrected = "p3mCoeffs { cloudCells 3; gather quartic; deferredCorrection yes; }"
        # What the finite volumes make of an even wall is exact; the clouds of p3m have the error of their radius.
        for method, entry, error in (("him", "", 1e-6), ("himCell", "", 1e-6), ("p3m", "", .04), ("p3m", corrected, .010)):
            for z, field, value in zip(heights, self.fields_at(method, heights, entry), exact):
                self.assertAlmostEqual(field / value, 1, delta=error, msg="%s at %g" % (method, z))

    def test_wall_charge_is_written_with_all_its_digits(self):
        case = slabs("%s/whole" % self.folder)
        probe(case, "middle 1.2345678901234567e-6;")
        written = (case.path / "0/wallSurfaceCharge").read_text()
        self.assertIn("1.2345678901234567e-06", written)


class Refusals(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def refused(self, expected, **changes):
        case = slabs("%s/%d" % (self.folder, abs(hash(str(changes)))), **changes)
        result = case.run("-dry-run")
        self.assertEqual(result.code, 1, result.text)
        self.assertIn(expected, result.text)

    def test_permittivities_must_be_positive(self):
        self.refused("zonePermittivity: lower", zones="zonePermittivity { lower 0; }")
        self.refused("zonePermittivity: lower", zones="zonePermittivity { lower -2; }")

    def test_walls_must_have_faces_to_carry_their_charge(self):
        self.refused("the mesh has no face zone glass", wall="insulatingWalls { w { faceZone glass; } }")
        self.refused("the mesh has no cell zone glass; it has: lower, upper", wall="insulatingWalls { w { betweenZones (lower glass); } }")
        self.refused("the wall has no face of the mesh", wall="insulatingWalls { w { betweenZones (lower none); } }")
        self.refused("an insulating wall needs faces of the mesh to carry its charge", wall="insulatingWalls { w { } }")

    def test_unknown_zones_are_named(self):
        self.refused("the mesh has no cell zone of this name; it has: lower, upper", zones="zonePermittivity { glass 2; }")

    def test_a_plate_at_the_edge_says_what_was_found_and_what_is_allowed(self):
        for entries, complaint in (("thickness 0; relativePermittivity 6.5;", "bottom: thickness: found `0`, but a number above zero is expected"),
                                   ("thickness 1e-3; relativePermittivity -1;",
                                    "bottom: relativePermittivity: found `-1`, but a number above zero is expected"),
                                   ("thickness thin; relativePermittivity 6.5;", "bottom: thickness: found `thin`, but"),
                                   ("thickness 1e-3;", "bottom: relativePermittivity: the entry is missing")):
            case = slabs("%s/%d" % (self.folder, abs(hash(entries))), wall="")
            case.replace("0/electricPotential", "bottom { type fixedValue; value uniform 0; }",
                         "bottom { type insulatingWall; %s }" % entries)
            result = case.run("-dry-run")
            self.assertEqual(result.code, 1, result.text)
            self.assertIn("0/electricPotential: " + complaint, " ".join(result.text.split()))

    def test_p3m_refuses_what_it_does_not_know(self):
        self.refused("p3m knows one permittivity", method="p3m", zones="zonePermittivity { lower 2; }")


if __name__ == "__main__":
    unittest.main(verbosity=2)
