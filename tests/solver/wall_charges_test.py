# SPDX-License-Identifier: GPL-3.0-or-later
"""Charge that contacts leave on an insulating wall: it lies on the face under the contact, is conserved, and acts."""

import math
import re
import unittest

from insulating_walls_test import EPSILON0, INTERFACE, slabs
from tiny_case import SIZE, CaseTests, TinyCase

# Four spheres of 1 mm about to hit the wall from above, one of them charged, and one that stays away from it.
FALLING = [
    ((0.0231, 0.0312, INTERFACE + 0.0006), (0.3, -0.1, -0.5), 0.),
    ((0.0742, 0.0263, INTERFACE + 0.0007), (-0.2, 0.2, -0.4), 0.),
    ((0.0317, 0.0728, INTERFACE + 0.0006), (0.1, 0.1, -0.6), 2e-11),
    ((0.0568, 0.0539, INTERFACE + 0.0008), (-0.1, 0.3, -0.5), 0.),
    ((0.0723, 0.0719, 0.0746), (0.2, -0.2, -0.1), 5e-11),
]


def bed(folder, method="him", target="middle", height=INTERFACE):
    case = slabs(folder, method, nx=5, lower=4, upper=6, particles=FALLING)
    case.replace("constant/couplingProperties", "floor bottom;", "floor %s;" % target)
    case.replace("DEM/in.cube", "zplane 0.0\n", "zplane %r\n" % height)
    return case


def faces_of(case, time="0.002"):
    """Centre [m] to charge per area [C/m2] of the quadrangles that keep charge, from the file for ParaView."""
    text = (case.path / "postProcessing/wallCharge" / (time + ".vtp")).read_text()
    numbers = {name: [float(word) for word in body.split()]
               for name, body in re.findall(r'Name="(\w+)"[^>]*>\n(.*?)</DataArray>', text, re.S)}
    found = {}
    for n, charge in enumerate(numbers["surfaceCharge"]):
        corners = [numbers["position"][3 * k:3 * k + 3] for k in range(4 * n, 4 * n + 4)]
        found[tuple(round(sum(c[axis] for c in corners) / 4, 9) for axis in range(3))] = charge
    return found


class WallCharges(CaseTests):
    def last_row(self, case, ranks=1):
        """The last line of charge.dat of a run."""
        self.ran(case, ranks)
        return case.charge_table()[1][-1]

    def faces(self, case, time="0.002"):
        """Centre [m] in x and y to charge per area [C/m2]."""
        found = faces_of(case, time)
        self.assertTrue(all(abs(centre[2] - INTERFACE) < 1e-9 for centre in found))
        return {centre[:2]: charge for centre, charge in found.items()}

    def test_charge_stays_on_the_faces_under_the_contacts_and_the_books_close(self):
        case = bed(self.folder)
        row = self.last_row(case)
        everything = abs(row["wallFaces"]) + 7e-11
        self.assertGreater(abs(row["floor"]), 1e-12)
        self.assertAlmostEqual(row["wallFaces"], row["floor"], delta=1e-12 * everything)
        self.assertAlmostEqual(row["wallFaceError"], 0, delta=1e-12 * everything)
        self.assertAlmostEqual(row["total"] + row["wallFaces"], 7e-11, delta=1e-12 * everything)
        faces = self.faces(case)
        self.assertEqual(len(faces), 25)
        charged = {centre for centre, charge in faces.items() if charge != 0}
        # Faces of 20 mm: the one under each of the four that touch.
        self.assertEqual(charged, {(0.03, 0.03), (0.07, 0.03), (0.03, 0.07), (0.05, 0.05)})
        self.assertAlmostEqual(sum(faces.values()) * 0.02**2, row["floor"], delta=1e-12 * everything)

    def test_any_insulating_wall_is_found_by_nearness(self):
        named = self.last_row(bed(self.folder + "/named"))
        anyone = self.last_row(bed(self.folder + "/any", target="insulating"))
        self.assertEqual(named["wallFaces"], anyone["wallFaces"])

    def test_a_wall_that_the_script_lets_charge_keeps_its_charge_where_the_case_says_so(self):
        silent = self.last_row(bed(self.folder + "/silent"))
        case = bed(self.folder + "/named")
        case.replace("DEM/in.cube", "kappa 20.0 area hertz", "kappa 20.0 area hertz wall floor conductor")
        named = self.last_row(case)
        self.assertNotEqual(silent["wallFaces"], 0)
        self.assertEqual(named["wallFaces"], silent["wallFaces"])

    def test_any_number_of_ranks_gives_the_same_faces(self):
        for method, tolerance in (("him", 1e-9), ("p3m", 1e-9)):
            serial_case = bed("%s/%s1" % (self.folder, method), method)
            serial = self.last_row(serial_case)
            faces = self.faces(serial_case)
            for ranks in (2, 4):
                case = bed("%s/%s%d" % (self.folder, method, ranks), method)
                row = self.last_row(case, ranks)
                self.assertAlmostEqual(row["wallFaces"] / serial["wallFaces"], 1, delta=tolerance)
                self.assertAlmostEqual(row["wallFaceError"], 0, delta=1e-12 * 1e-10)
                for centre, charge in self.faces(case).items():
                    self.assertAlmostEqual(charge, faces[centre], delta=tolerance * max(map(abs, faces.values())))

    def test_the_wall_pulls_what_has_charged_at_it(self):
        """Gamma is negative here: spheres leave with negative charge, and the positive wall pulls them back."""
        case = bed(self.folder, "p3m")
        case.replace("constant/couplingProperties", "walls {", "wallContactField self; walls {")
        case.replace("constant/couplingProperties", "wallContactField total;", "")
        self.assertGreater(self.last_row(case)["wallFaces"], 0)
        sphere = case.particles("0.002")[1]
        self.assertLess(sphere["charge"], 0)
        self.assertGreater(sphere["electricField"][2], 0)  # away from the wall, so the force is towards it

    def test_a_run_that_continues_finds_the_charge_of_every_face(self):
        straight = bed(self.folder + "/straight")
        straight.replace("system/controlDict", "endTime 2e-3;", "endTime 4e-3;")
        straight.replace("system/controlDict", "writeFormat ascii;", "writeFormat binary;")
        from restart_test import continuing, PARTICLES  # the script with a branch on the time that himFoam starts from
        self.assertTrue(PARTICLES)
        script = straight.path / "DEM/in.cube"
        script.write_text(continuing(script.read_text()))
        row = self.last_row(straight)
        faces = self.faces(straight, "0.004")
        straight.replace("system/controlDict", "startTime 0;", "startTime 0.002;")
        again = straight.run()
        self.assertEqual(again.code, 0, again.text[-2000:])
        more = straight.charge_table("0.002")[1][-1]
        self.assertEqual(self.faces(straight, "0.004"), faces)
        self.assertEqual(more["wallFaces"], row["wallFaces"])
        self.assertAlmostEqual(more["wallFaceError"], 0, delta=1e-12 * 1e-10)

    def test_a_dem_wall_off_the_faces_is_refused(self):
        result = bed(self.folder, height=INTERFACE + 0.004).run("-dry-run")
        self.assertEqual(result.code, 1)
        self.assertIn("the DEM wall lies off the insulating wall of the mesh by 0.004 m, more than wallDistance, 0.002 m", result.text)

    def test_an_insulating_wall_without_faces_is_refused(self):
        case = bed(self.folder, target="insulating")
        text = (case.path / "constant/electrostaticProperties").read_text()
        (case.path / "constant/electrostaticProperties").write_text(re.sub("insulatingWalls.*\n", "", text))
        result = case.run("-dry-run")
        self.assertEqual(result.code, 1)
        self.assertIn("an insulating wall needs faces of the mesh to carry its charge, and the case names none.", result.text)

    def test_a_wall_keeps_no_charge_without_a_mesh(self):
        case = bed(self.folder, target="insulating")
        case.replace("constant/electrostaticProperties", "fieldMethod him;", "fieldMethod pairwiseSum;")
        result = case.run("-dry-run")
        self.assertEqual(result.code, 1)
        self.assertIn("an insulating wall needs faces of a mesh to carry its charge", result.text)


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


class WallChargesAtTheEdgeOfTheMesh(CaseTests):
    """The floor of the mesh is a patch insulatingWall: a plate of 1 mm of glass before a conductor."""

    pieces = {1: None, 2: (2, 1, 1), 4: (2, 2, 1)}  # the patch and its contacts lie on all ranks
    conditions = "thickness 1e-3; relativePermittivity 6.5; value uniform 0;"

    def edge_bed(self, name, method="him", entry=""):
        falling = [((x, y, z - INTERFACE), velocity, charge) for (x, y, z), velocity, charge in FALLING]
        case = TinyCase("%s/%s" % (self.folder, name), method, cells=(5, 5, 5), particles=falling, diameter=0.001)
        case.replace("0/electricPotential", "bottom { type fixedValue; value uniform 0; }",
                     "bottom { type insulatingWall; %s }" % self.conditions)
        case.replace("constant/electrostaticProperties", "externalField (0 0 1000);", entry)
        case.replace("constant/electrostaticProperties", "himCoeffs { nearCutoff 0.02; }", "himCoeffs { nearCutoff 0.04; }")
        return case

    def run_on(self, ranks, method="him", entry=""):
        """The case after its run, and the text of the run."""
        case = self.edge_bed("%s%d%d" % (method, ranks, len(entry)), method, entry)
        if ranks > 1:
            case.decompose(ranks, self.pieces[ranks])
        result = case.run(ranks=ranks)
        self.assertEqual(result.code, 0, result.text[-3000:])
        return case, result.text

    def test_contacts_leave_their_charge_on_its_faces_and_the_books_close(self):
        for method in ("him", "himCell"):
            case, _ = self.run_on(1, method)
            row = case.charge_table()[1][-1]
            everything = abs(row["wallFaces"]) + 7e-11
            self.assertGreater(abs(row["floor"]), 1e-12)
            self.assertAlmostEqual(row["wallFaces"], row["floor"], delta=1e-12 * everything)
            self.assertAlmostEqual(row["wallFaceError"], 0, delta=1e-12 * everything)
            self.assertAlmostEqual(row["total"] + row["wallFaces"], 7e-11, delta=1e-12 * everything)
            faces = faces_of(case)
            charged = {centre for centre, charge in faces.items() if charge != 0}
            self.assertEqual(charged, {(0.03, 0.03, 0), (0.07, 0.03, 0), (0.03, 0.07, 0), (0.05, 0.05, 0)})
            self.assertAlmostEqual(sum(faces.values()) * 0.02**2, row["floor"], delta=1e-12 * everything)

    def test_any_number_of_ranks_gives_the_same_faces_and_fields(self):
        serial_case, _ = self.run_on(1)
        serial, faces, spheres = serial_case.charge_table()[1][-1], faces_of(serial_case), serial_case.particles("0.002")
        for ranks in (2, 4):
            case, _ = self.run_on(ranks)
            row = case.charge_table()[1][-1]
            self.assertAlmostEqual(row["wallFaces"] / serial["wallFaces"], 1, delta=1e-9)
            self.assertAlmostEqual(row["wallFaceError"], 0, delta=1e-12 * 1e-10)
            for centre, charge in faces_of(case).items():
                self.assertAlmostEqual(charge, faces[centre], delta=1e-9 * max(map(abs, faces.values())))
            largest = max(abs(component) for sphere in spheres.values() for component in sphere["electricField"])
            for tag, sphere in case.particles("0.002").items():
                for component, expected in zip(sphere["electricField"], spheres[tag]["electricField"]):
                    self.assertAlmostEqual(component, expected, delta=1e-8 * largest)

    def test_its_charge_makes_the_field_of_a_capacitor_at_particles(self):
        """Plate and gas in series: V_f = sigma/(eps_w/t + eps0/L), and the field V_f/L is the same in the first cell and above."""
        sigma, heights = 1e-6, (0.0006, 0.015, 0.0333, 0.08)
        case = TinyCase(self.folder, cells=(5, 5, 5), diameter=0.001,
                        particles=[((0.03 + 0.01 * n, 0.047, z), (0., 0., 0.), 0.) for n, z in enumerate(heights)])
        case.replace("0/electricPotential", "bottom { type fixedValue; value uniform 0; }",
                     "bottom { type insulatingWall; %s }" % self.conditions)
        case.replace("0/electricPotential", "sides { type fixedValue; value uniform 0; }", "sides { type zeroGradient; }")
        case.replace("constant/electrostaticProperties", "externalField (0 0 1000);", "")
        case.replace("constant/electrostaticProperties", "himCoeffs { nearCutoff 0.02; }", "himCoeffs { nearCutoff 0.04; }")
        case.write("constant/probeProperties", "surfaceCharge { bottom %r; }\n" % sigma)
        charged = case.run(program="wallProbe")
        self.assertEqual(charged.code, 0, charged.text)
        case.replace("DEM/in.cube", "fix move all nve/sphere\n", "")
        case.replace("system/controlDict", "endTime 2e-3; deltaT 1e-3;", "endTime 1e-5; deltaT 1e-5;")
        case.replace("system/controlDict", "writeInterval 2;", "writeInterval 1;")
        self.ran(case)
        exact = sigma / (6.5 * EPSILON0 / 1e-3 + EPSILON0 / SIZE) / SIZE
        for sphere in case.particles("1e-05").values():
            self.assertAlmostEqual(sphere["electricField"][2] / exact, 1, delta=1e-6)

    def test_p3m_refuses_it_before_the_run(self):
        self.refused(self.edge_bed("p3m", "p3m"),
                     "0/electricPotential: bottom: found the condition insulatingWall, of whose other side p3m knows nothing. Mesh the "
                     "outside of the wall and name it in insulatingWalls, or use fieldMethod him or himCell.")

    def test_the_error_of_its_field_is_not_known_and_the_run_goes_on(self):
        for entry in ("", "fieldError { active no; }"):
            case, text = self.run_on(1, entry=entry)
            self.assertFalse((case.path / "postProcessing/fieldError").exists())
            if not entry:
                self.assertIn("Field error: n/a, there is no exact reference for him here: a stricter p3m would serve, but patch bottom "
                              "has the condition insulatingWall, of whose other side p3m knows nothing", text)


if __name__ == "__main__":
    unittest.main(verbosity=2)
