# SPDX-License-Identifier: GPL-3.0-or-later
"""Charge that contacts leave on an insulating wall: it lies on the face under the contact, is conserved, and acts."""

import re
import unittest

from falling_bed import bed, faces_of
from insulating_walls_test import INTERFACE
from restart_test import continuing
from tiny_case import CaseTests


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
        script = straight.path / "DEM/in.cube"
        script.write_text(continuing(script.read_text()))
        row = self.last_row(straight)
        faces = self.faces(straight, "0.004")
        index = straight.path / "postProcessing/wallCharge/wallCharge.vtp.series"
        listed = index.read_text()
        self.assertIn("0.002.vtp", listed)
        straight.replace("system/controlDict", "startTime 0;", "startTime 0.002;")
        again = straight.run()
        self.assertEqual(again.code, 0, again.text[-2000:])
        more = straight.charge_table("0.002")[1][-1]
        self.assertEqual(self.faces(straight, "0.004"), faces)
        self.assertEqual(more["wallFaces"], row["wallFaces"])
        self.assertAlmostEqual(more["wallFaceError"], 0, delta=1e-12 * 1e-10)
        self.assertEqual(index.read_text(), listed)
        # Cut, with the charge that is there: the faces of the wall are on one rank with one half, and on the other with the other.
        for ranks, pieces in ((2, (2, 1, 1)), (4, (2, 2, 1))):
            straight.decompose(ranks, pieces)
            again = straight.run(ranks=ranks)
            self.assertEqual(again.code, 0, again.text[-2000:])
            for centre, charge in self.faces(straight, "0.004").items():
                self.assertAlmostEqual(charge, faces[centre], delta=1e-9 * max(map(abs, faces.values())))
            self.assertAlmostEqual(straight.charge_table("0.002")[1][-1]["wallFaceError"], 0, delta=1e-12 * 1e-10)

    def test_a_run_that_has_lost_the_charge_of_the_faces_does_not_go_on(self):
        case = bed(self.folder)
        case.replace("system/controlDict", "endTime 2e-3;", "endTime 4e-3;")
        script = case.path / "DEM/in.cube"
        script.write_text(continuing(script.read_text()))
        self.last_row(case)
        case.replace("system/controlDict", "startTime 0;", "startTime 0.002;")
        (case.path / "0.002/wallSurfaceCharge").unlink()
        result = case.run()
        self.assertNotEqual(result.code, 0)
        self.assertIn("the start time has no wallSurfaceCharge", " ".join(result.text.split()))

    def test_what_a_wall_was_given_stays_with_its_name(self):
        case = bed(self.folder)
        case.replace("system/controlDict", "endTime 2e-3;", "endTime 4e-3;")
        script = case.path / "DEM/in.cube"
        text = continuing(script.read_text())
        script.write_text(text)
        self.last_row(case)
        given = [row for row in case.charge_table()[1] if abs(row["Time"] - 0.002) < 1e-9][0]["floor"]
        self.assertNotEqual(given, 0)
        floor, lid = (line for line in text.splitlines() if line.startswith(("fix floor", "fix lid")))
        script.write_text(text.replace(floor, "@").replace(lid, floor).replace("@", lid))
        case.replace("system/controlDict", "startTime 0;", "startTime 0.002;")
        again = case.run()
        self.assertEqual(again.code, 0, again.text[-2000:])
        names, rows = case.charge_table("0.002")
        self.assertLess(names.index("lid"), names.index("floor"))
        self.assertAlmostEqual(rows[0]["floor"] / given, 1, delta=1e-10)
        self.assertEqual(rows[0]["lid"], 0)

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


if __name__ == "__main__":
    unittest.main()
