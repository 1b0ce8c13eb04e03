# SPDX-License-Identifier: GPL-3.0-or-later
"""Insulating walls that are not a plane between zones: mesh walls of the scene, face zones, a cylinder. Contacts charge their faces."""

import math
import re
import unittest

from falling_bed import FALLING, bed, faces_of
from insulating_walls_test import INTERFACE, slabs
from tiny_case import CaseTests, TinyCase

PLATE = """solid plate
facet normal 0 0 1
outer loop
vertex 0 0 {0}
vertex 0.1 0 {0}
vertex 0.1 0.1 {0}
endloop
endfacet
facet normal 0 0 1
outer loop
vertex 0 0 {0}
vertex 0.1 0.1 {0}
vertex 0 0.1 {0}
endloop
endfacet
endsolid plate
"""


def with_plate(case, height=INTERFACE):
    """The case with two facets of an STL file in place of the floor's plane."""
    case.write("DEM/floor.stl", PLATE.format(height))
    script = (case.path / "DEM/in.cube").read_text()
    (case.path / "DEM/in.cube").write_text(re.sub(
        "fix floor all .*", "fix floor all mesh/surface file DEM/floor.stl type 2 curvature 10\n"
        "fix walls all wall/gran model hertz tangential history cohesion charge mesh n_meshes 1 meshes floor", script))
    return case


def with_face_zone(case, most=1.0, height=INTERFACE):
    """The case with the face zone `shelf` at a height, up to x = most, as its insulating wall."""
    case.write("system/topoSetDict", """actions
(
    { name shelf; type faceSet; action new; source boxToFace; sourceInfo { box (-1 -1 %r) (%r 1 %r); } }
    { name shelf; type faceZoneSet; action new; source setToFaceZone; sourceInfo { faceSet shelf; } }
);""" % (height - 1e-4, most, height + 1e-4))
    case.tool("topoSet")
    case.replace("constant/electrostaticProperties", "betweenZones (lower upper);", "faceZone shelf;")
    return case


class OtherWallsThatKeepTheirCharge(CaseTests):
    def assertSameFaces(self, case, faces, tolerance):
        found = faces_of(case)
        self.assertEqual(found.keys(), faces.keys())
        for centre, charge in found.items():
            self.assertAlmostEqual(charge, faces[centre], delta=tolerance * max(map(abs, faces.values())))

    def test_a_mesh_wall_of_the_scene_charges_the_faces_like_a_plane(self):
        plane = bed(self.folder + "/plane")
        self.ran(plane)
        faces = faces_of(plane)
        self.assertEqual(sum(charge != 0 for charge in faces.values()), 4)
        for ranks in (1, 2):
            case = with_plate(bed("%s/%d" % (self.folder, ranks)))
            self.ran(case, ranks)
            self.assertSameFaces(case, faces, 1e-6)
            self.assertAlmostEqual(case.charge_table()[1][-1]["wallFaceError"], 0, delta=1e-22)

    def test_a_mesh_wall_off_the_faces_is_refused(self):
        self.refused(with_plate(bed(self.folder), INTERFACE + 0.003),
                     "the DEM wall lies off the insulating wall of the mesh by 0.003 m, more than wallDistance, 0.002 m")

    def test_a_facet_larger_than_the_mesh_is_on_the_faces_that_it_covers(self):
        case = with_plate(bed(self.folder))
        (case.path / "DEM/floor.stl").write_text(PLATE.format(INTERFACE).replace("0.1", "0.3").replace("vertex 0 ", "vertex -0.2 "))
        case.replace("DEM/in.cube", "block -0.001 0.101 -0.001 0.101", "block -0.3 0.4 -0.3 0.4")
        self.ran(case)
        self.assertEqual(sum(charge != 0 for charge in faces_of(case).values()), 4)

    def test_a_face_zone_keeps_charge_like_the_faces_between_zones(self):
        between = bed(self.folder + "/between")
        self.ran(between)
        faces = faces_of(between)
        for ranks, pieces in ((1, None), (2, (2, 1, 1))):
            case = with_face_zone(bed("%s/%d" % (self.folder, ranks)))
            if pieces:
                case.decompose(ranks, pieces)
            result = case.run(ranks=ranks)
            self.assertEqual(result.code, 0, result.text[-2000:])
            self.assertSameFaces(case, faces, 1e-9)

    def test_a_face_zone_between_ranks_keeps_charge_once(self):
        """Five layers of cells below and above, so that two slices of the mesh meet at the wall."""
        rows = {}
        for ranks in (1, 2):
            case = slabs("%s/%d" % (self.folder, ranks), nx=5, lower=5, upper=5, particles=FALLING)
            case.replace("constant/couplingProperties", "floor bottom;", "floor middle;")
            case.replace("DEM/in.cube", "zplane 0.0\n", "zplane %r\n" % INTERFACE)
            self.ran(with_face_zone(case), ranks)
            rows[ranks] = (case.charge_table()[1][-1], faces_of(case))
        self.assertEqual(sum(charge != 0 for charge in rows[1][1].values()), 4)
        self.assertSameFaces(case, rows[1][1], 1e-9)
        self.assertAlmostEqual(rows[2][0]["wallFaces"] / rows[1][0]["wallFaces"], 1, delta=1e-9)
        self.assertAlmostEqual(rows[2][0]["wallFaceError"], 0, delta=1e-22)

    def test_a_face_zone_that_covers_half_of_the_wall_is_refused(self):
        case = with_face_zone(bed(self.folder), most=0.0601)
        self.refused(case, "walls: floor: particles can touch the DEM wall where the insulating wall of the mesh has no face: 38 % of it "
                           "is bare, as at (0.06")
        # Unless a plane of the scene keeps particles off the bare part.
        fence = "fix fence all wall/gran model hertz tangential history cohesion charge primitive type 2 xplane 0.06\n"
        case.replace("DEM/in.cube", "fix tribo", fence + "fix tribo")
        case.replace("constant/couplingProperties", "lid noTransfer;", "lid noTransfer; fence noTransfer;")
        result = case.run("-dry-run")
        self.assertEqual(result.code, 0, result.text)

    def test_a_wall_on_a_periodic_patch_is_refused_on_any_number_of_ranks(self):
        for ranks in (1, 2):
            case = bed("%s/%d" % (self.folder, ranks))
            for patch, other in (("bottom", "top"), ("top", "bottom")):
                case.replace("system/blockMeshDict", patch.ljust(6) + " { type wall;",
                             "%s { type cyclic; neighbourPatch %s;" % (patch, other))
                case.replace("0/electricPotential", patch + " { type fixedValue; value uniform 0; }", patch + " { type cyclic; }")
            case.replace("0/electricPotential", "sides { type zeroGradient; }", "sides { type fixedValue; value uniform 0; }")
            case.tool("blockMesh")
            if ranks > 1:
                case.decompose(ranks)
            result = case.run("-dry-run", ranks=ranks)
            self.assertEqual(result.code, 1, result.text)
            self.assertIn("insulatingWalls: middle: some of its faces lie on a periodic patch", " ".join(result.text.split()))


def cylinder_in_shell(inner, outer, height):
    """blockMeshDict of a cylinder (zone bed) in a shell: a square core, a ring up to the radius `inner`, another up to `outer` [m]."""
    corners = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    sizes = (0.6 * inner * math.sqrt(0.5), inner * math.sqrt(0.5), outer * math.sqrt(0.5))
    points = ["(%.15g %.15g %.15g)" % (size * x, size * y, z) for z in (0, height) for size in sizes for x, y in corners]
    blocks = "hex (0 1 2 3 12 13 14 15) bed (6 6 6) simpleGrading (1 1 1)\n"
    ends, rim, arcs = "(0 3 2 1) (12 13 14 15)", "", ""
    for a, b in ((0, 1), (1, 2), (2, 3), (3, 0)):
        for ring, zone, cells in ((0, "bed", 3), (4, "", 3)):
            blocks += "hex (%d %d %d %d %d %d %d %d) %s (6 %d 6) simpleGrading (1 1 1)\n" % (
                *(corner + ring for corner in (a + 4, b + 4, b, a, a + 16, b + 16, b + 12, a + 12)), zone, cells)
            ends += " (%d %d %d %d) (%d %d %d %d)" % tuple(c + ring for c in (a + 4, a, b, b + 4, a + 12, a + 16, b + 16, b + 12))
        rim += "(%d %d %d %d) " % (a + 8, b + 8, b + 20, a + 20)
        middle = [(corners[a][n] + corners[b][n]) / 2 for n in (0, 1)]
        for first, radius in ((4, inner), (8, outer)):
            for layer, z in ((0, 0), (12, height)):
                arcs += "arc %d %d (%.15g %.15g %.15g)\n" % (a + first + layer, b + first + layer, radius * middle[0], radius * middle[1], z)
    return """scale 1;\nvertices (%s);\nblocks (%s);\nedges (%s);
        boundary ( sides { type wall; faces (%s); } ends { type wall; faces (%s); } );\n""" % (" ".join(points), blocks, arcs, rim, ends)


class InsulatingCylinder(CaseTests):
    RADIUS, OUTER, HEIGHT = 0.03, 0.06, 0.06  # [m]

    def tube(self, name, method, radius=RADIUS):
        """Four spheres that fly outwards to a glass tube in a grounded can, one of them charged."""
        start, tilts = self.RADIUS - 0.0012, (0.13, 1.57, 3.0, 4.4)
        spheres = [((start * math.cos(t), start * math.sin(t), 0.014 + 0.009 * n),
                    (0.5 * math.cos(t), 0.5 * math.sin(t), 0.1), 3e-11 if n == 1 else 0.) for n, t in enumerate(tilts)]
        case = TinyCase("%s/%s" % (self.folder, name), method, particles=spheres, diameter=0.002)
        case.write("system/blockMeshDict", cylinder_in_shell(self.RADIUS, self.OUTER, self.HEIGHT))
        case.tool("blockMesh")
        potential = (case.path / "0/electricPotential").read_text()
        (case.path / "0/electricPotential").write_text(potential[:potential.index("bottom")]
                                                       + "ends { type zeroGradient; }\nsides { type fixedValue; value uniform 0; }\n}\n")
        case.replace("constant/electrostaticProperties", "externalField (0 0 1000);",
                     "insulatingWalls { glass { betweenZones (bed none); } }")
        case.replace("constant/electrostaticProperties", "himCoeffs { nearCutoff 0.02; }", "himCoeffs { nearCutoff 0.03; }")
        case.replace("constant/couplingProperties", "floor bottom;", "floor glass;")
        case.replace("DEM/in.cube", "zplane 0.0\n", "zcylinder %r 0. 0.\n" % radius)
        case.replace("DEM/in.cube", "block -0.001 0.101 -0.001 0.101", "block -0.061 0.061 -0.061 0.061")
        return case

    def test_contacts_charge_the_faces_before_them_on_one_and_two_ranks(self):
        for method in ("him", "p3m"):
            serial = None
            for ranks, pieces in ((1, None), (2, (2, 1, 1))):
                case = self.tube("%s%d" % (method, ranks), method)
                if pieces:
                    case.decompose(ranks, pieces)
                result = case.run(ranks=ranks)
                self.assertEqual(result.code, 0, result.text[-2000:])
                row, faces = case.charge_table()[1][-1], faces_of(case)
                everything = abs(row["wallFaces"]) + 3e-11
                self.assertAlmostEqual(row["wallFaces"], row["floor"], delta=1e-12 * everything)
                self.assertAlmostEqual(row["total"] + row["wallFaces"], 3e-11, delta=1e-12 * everything)
                charged = {centre: charge for centre, charge in faces.items() if charge != 0}
                self.assertEqual(len(charged), 4, charged)
                for (x, y, _), tilt in zip(sorted(charged, key=lambda c: math.atan2(c[1], c[0]) % (2 * math.pi)), (0.13, 1.57, 3.0, 4.4)):
                    apart = (math.atan2(y, x) - tilt + math.pi) % (2 * math.pi) - math.pi
                    self.assertLess(abs(apart), math.pi / 24 + 1e-3)  # 24 faces around
                serial = serial or (row, faces)
                self.assertAlmostEqual(row["wallFaces"] / serial[0]["wallFaces"], 1, delta=1e-7)
                for centre, charge in faces.items():
                    self.assertAlmostEqual(charge, serial[1][centre], delta=1e-7 * max(map(abs, serial[1].values())))

    def test_a_cylinder_off_the_faces_is_refused(self):
        self.refused(self.tube("off", "him", self.RADIUS + 0.002), "the DEM wall lies off the insulating wall of the mesh by 0.002")


if __name__ == "__main__":
    unittest.main()
