# SPDX-License-Identifier: GPL-3.0-or-later
"""p3m on meshes of a box whose cells lean, stretch and taper, against the exact field of the box."""

import csv
import math
import random
import re
import tempfile
import unittest

from tiny_case import TinyCase

ELECTROSTATIC = "constant/electrostaticProperties"
PARTICLES = 120


def leaning(slope, height=1.0):
    """Two blocks in a cube of 0.1 m, or a box of a share of that height; their common face leans so that its foot and top lie
    `slope` apart, in side lengths."""
    foot, top = 0.5 - slope / 2, 0.5 + slope / 2
    return """
scale 0.1;
vertices ((0 0 0) (%(f)g 0 0) (%(f)g 1 0) (0 1 0) (0 0 %(h)g) (%(t)g 0 %(h)g) (%(t)g 1 %(h)g) (0 1 %(h)g)
          (1 0 0) (1 1 0) (1 0 %(h)g) (1 1 %(h)g));
blocks (hex (0 1 2 3 4 5 6 7) (10 20 %(n)d) simpleGrading (1 1 1) hex (1 8 9 2 5 10 11 6) (10 20 %(n)d) simpleGrading (1 1 1));
boundary
(
    bottom { type wall; faces ((0 3 2 1) (1 2 9 8)); }
    top    { type wall; faces ((4 5 6 7) (5 10 11 6)); }
    sides  { type wall; faces ((0 4 7 3) (8 9 11 10) (0 1 5 4) (1 8 10 5) (3 7 6 2) (2 6 11 9)); }
);
""" % {"f": foot, "t": top, "h": height, "n": round(20 * height)}


def cloud(height=1.0):
    """Charges of both signs at least 8 mm apart."""
    generator = random.Random(5)
    places = []
    while len(places) < PARTICLES * height:
        place = [generator.uniform(0.004, 0.096), generator.uniform(0.004, 0.096), generator.uniform(0.004, 0.1 * height - 0.004)]
        if all(math.dist(place, other) > 0.008 for other in places):
            places.append(place)
    return "x,y,z,q\n" + "".join("%r,%r,%r,%r\n" % (*place, (-1) ** n * 1e-12) for n, place in enumerate(places))


class HardMeshes(unittest.TestCase):
    def errors(self, mesh=None, grading="1 1 1", height=1.0):
        """RMS errors by method, and the largest angle [degrees] between a face's normal and its cell centres."""
        with tempfile.TemporaryDirectory() as folder:
            case = TinyCase(folder, "p3m", cells=(20, 20, 20))
            if mesh:
                case.write("system/blockMeshDict", mesh)
            else:
                case.replace("system/blockMeshDict", "simpleGrading (1 1 1)", "simpleGrading (%s)" % grading)
            case.tool("blockMesh")
            checked = case.tool("checkMesh").text
            angle = float(re.search(r"non-orthogonality Max: (\S+)", checked).group(1))
            case.replace("system/fvSolution", "nNonOrthogonalCorrectors 0", "nNonOrthogonalCorrectors 4")
            case.replace(ELECTROSTATIC, "relativePermittivity 1;", """relativePermittivity 1;
                p3mCubic { fieldMethod p3m; cloudCells 2; }
                p3mQuartic { fieldMethod p3m; cloudCells 3; gather quartic; deferredCorrection yes; }""")
            (case.path / "in.csv").write_text(cloud(height))
            result = case.run("-particles", "in.csv", "-compare", "-methods", "(p3mCubic p3mQuartic)", program="himField")
            self.assertEqual(result.code, 0, result.text)
            with open(case.path / "postProcessing/himField/compare.csv", newline="") as file:
                return {row["name"]: float(row["rms_error"]) for row in csv.DictReader(file)}, angle

    @classmethod
    def setUpClass(cls):
        cls.upright, _ = cls.errors(cls())

    def expect_little_worse(self, errors):
        """Leaning and stretching costs little beside what upright cells of that size leave."""
        for method in ("p3mCubic", "p3mQuartic"):
            self.assertLess(errors[method], 1.3 * self.upright[method], method)

    def test_upright_cells_for_comparison(self):
        # Charges far from each other in cells: fields are weak, and errors relative to them are larger than in a dense scene.
        self.assertLess(self.upright["p3mCubic"], 0.10)
        self.assertLess(self.upright["p3mQuartic"], 0.25 * self.upright["p3mCubic"])

    def test_cells_that_lean_by_thirty_degrees(self):
        errors, angle = self.errors(leaning(0.6))
        self.assertGreater(angle, 28)
        self.expect_little_worse(errors)

    def test_cells_that_lean_by_sixty_degrees(self):
        upright, _ = self.errors(leaning(0, 0.4), height=0.4)
        errors, angle = self.errors(leaning(0.7, 0.4), height=0.4)
        print("upright", upright, "leaning by", angle, errors)
        self.assertGreater(angle, 58)
        # The finite volumes are less exact here, at the walls that the cells lean on most of all; p3m.md states these factors.
        self.assertLess(errors["p3mCubic"], 2 * upright["p3mCubic"])
        self.assertLess(errors["p3mQuartic"], 4.5 * upright["p3mQuartic"])

    def test_cells_ten_times_as_long_at_one_end(self):
        errors, _ = self.errors(grading="10 1 1")
        self.expect_little_worse(errors)


if __name__ == "__main__":
    unittest.main(verbosity=2)
