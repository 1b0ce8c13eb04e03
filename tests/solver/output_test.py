# SPDX-License-Identifier: GPL-3.0-or-later
"""A run writes the charge table, the particles, the mesh fields and a log, and they agree with each other."""

import math
import tempfile
import unittest
import xml.etree.ElementTree

from tiny_case import PARTICLES, TinyCase

COLUMNS = ("Time total min mean max floor lid inserted removed leaked breakdown closureError largestField energy").split()


def finished(method, change=None):
    folder = tempfile.TemporaryDirectory()
    case = TinyCase(folder.name, method)
    if change:
        change(case)
    result = case.run()
    if result.code != 0:
        raise RuntimeError(result.text)
    return folder, case, result.text


class OutputWithMesh(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder, cls.case, cls.log = finished("him")

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_charge_table_has_the_agreed_columns_and_a_line_per_update(self):
        names, rows = self.case.charge_table()
        self.assertEqual(names, COLUMNS)
        self.assertEqual([row["Time"] for row in rows], [0, 1e-3, 2e-3])

    def test_charge_given_to_walls_is_missing_on_the_particles(self):
        _, rows = self.case.charge_table()
        first, last = rows[0], rows[-1]
        self.assertAlmostEqual(first["total"], sum(charge for _, _, charge in PARTICLES), delta=1e-20)
        self.assertNotEqual(last["floor"], 0)
        self.assertEqual(last["lid"], 0)
        self.assertAlmostEqual(last["total"] + last["floor"], first["total"], delta=1e-20)

    def test_extremes_and_mean_are_those_of_the_written_particles(self):
        _, rows = self.case.charge_table()
        charges = [particle["charge"] for particle in self.case.particles("0.002").values()]
        self.assertAlmostEqual(rows[-1]["min"], min(charges), delta=1e-20)
        self.assertAlmostEqual(rows[-1]["max"], max(charges), delta=1e-20)
        self.assertAlmostEqual(rows[-1]["mean"], sum(charges) / len(charges), delta=1e-20)

    def test_him_has_no_energy(self):
        _, rows = self.case.charge_table()
        self.assertTrue(all(math.isnan(row["energy"]) for row in rows))

    def test_charge_density_holds_the_charge_of_the_particles(self):
        _, rows = self.case.charge_table()
        cell = (0.1 / 10) ** 3
        self.assertAlmostEqual(sum(self.case.field_values("0.002/chargeDensity")) * cell, rows[-1]["total"], delta=1e-18)

    def test_largest_field_is_that_of_a_written_particle(self):
        _, rows = self.case.charge_table()
        fields = [math.sqrt(sum(c * c for c in p["electricField"])) for p in self.case.particles("0.002").values()]
        self.assertAlmostEqual(rows[-1]["largestField"] / max(fields), 1, delta=1e-10)

    def test_mesh_fields_are_written_for_every_cell(self):
        for name in ("electricPotential", "electricField", "chargeDensity"):
            self.assertEqual(len(self.case.field_values("0.002/" + name)), 1000)

    def test_foam_to_vtk_converts_the_cloud(self):
        log = self.case.tool("foamToVTK", "-latestTime").text
        for field in ("charge", "electricField", "U", "radius"):
            self.assertIn(field, log.split("Lagrangian")[-1], log)
        self.assertTrue(list(self.case.path.glob("VTK/lagrangian/particles/*.vtp")), log)

    def test_checkpoint_of_the_dem_is_written(self):
        self.assertGreater((self.case.path / "DEM/restart/0.002").stat().st_size, 0)

    def test_log_has_the_tables_and_the_usual_lines(self):
        flat = " ".join(self.log.split())
        for text in ("floor zplane bottom grounded conductor", "lid zplane - no transfer", "Field method him, nearCutoff 0.02 m",
                     "field update every 0.001 s = 100 DEM steps of 1e-05 s", "DICPCG: Solving for electricPotential",
                     "ExecutionTime = ", "Progress: 50.0 %", "seconds per simulated second", "closure error"):
            self.assertIn(text, flat)


class OutputOfASparseLog(unittest.TestCase):
    def test_updates_between_logged_ones_leave_no_line(self):
        def change(case):
            case.replace("system/controlDict", "endTime 2e-3;", "endTime 6e-3;")
            case.replace("constant/couplingProperties", "wallContactField total;",
                         "wallContactField total; logInterval 3; chargeInterval 2; demCheckpoint no;")
        folder, case, log = finished("him", change)
        with folder:
            self.assertEqual(log.count("\nTime = "), 2)
            self.assertEqual(log.split("Starting time loop")[1].count("Solving for electricPotential"), 3)
            _, rows = case.charge_table()
            self.assertEqual([row["Time"] for row in rows], [0, 2e-3, 4e-3, 6e-3])
            self.assertFalse((case.path / "DEM/restart").exists())


class OutputOfAVoltage(unittest.TestCase):
    def test_table_of_walls_names_the_voltage_of_the_patch(self):
        def change(case):
            case.replace("0/electricPotential", "bottom { type fixedValue; value uniform 0; }",
                         "bottom { type fixedValue; value uniform 250; }")
        folder, _, log = finished("him", change)
        with folder:
            self.assertIn("conductor at 250 V", log)


class OutputWithoutMesh(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder, cls.case, cls.log = finished("pairwiseSum", lambda case: case.replace(
            "constant/electrostaticProperties", "externalField (0 0 1000);", ""))

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_energy_is_that_of_all_pairs(self):
        _, rows = self.case.charge_table()
        expected = 0
        for i, (a, _, p) in enumerate(PARTICLES):
            for b, _, q in PARTICLES[:i]:
                expected += p * q / (4 * math.pi * 8.8541878128e-12 * math.dist(a, b))
        self.assertAlmostEqual(rows[0]["energy"] / expected, 1, delta=1e-11)

    def test_particles_are_a_vtk_file_with_all_data(self):
        piece = xml.etree.ElementTree.parse(self.case.path / "postProcessing/particles/0.002.vtp").find("PolyData/Piece")
        self.assertEqual(int(piece.get("NumberOfPoints")), len(PARTICLES))
        data = {array.get("Name"): list(map(float, array.text.split())) for array in piece.find("PointData")}
        self.assertEqual(set(data), {"charge", "radius", "U", "electricField", "type", "tag"})
        self.assertEqual(data["tag"], list(range(1, len(PARTICLES) + 1)))
        _, rows = self.case.charge_table()
        self.assertAlmostEqual(sum(data["charge"]), rows[-1]["total"], delta=1e-19)

    def test_no_mesh_and_no_field_is_needed(self):
        for name in ("constant/polyMesh", "system/fvSchemes", "system/fvSolution", "0"):
            self.assertFalse((self.case.path / name).exists())
        self.assertIn("floor zplane grounded grounded conductor", " ".join(self.log.split()))


def periodic_in_x(case):
    """One sphere leaves the box through its upper end in x, another through the lower one; LIGGGHTS brings neither back before
    it has moved by half the skin of its lists."""
    case.replace("system/blockMeshDict", "sides  { type wall; faces ((0 4 7 3) (1 2 6 5) (0 1 5 4) (3 7 6 2)); }", """
    left { type cyclic; neighbourPatch right; faces ((0 4 7 3)); }
    right { type cyclic; neighbourPatch left; faces ((1 2 6 5)); }
    sides { type wall; faces ((0 1 5 4) (3 7 6 2)); }""")
    case.replace("0/electricPotential", "sides {", "left { type cyclic; } right { type cyclic; } sides {")
    case.tool("blockMesh")
    case.replace("DEM/in.cube", "boundary f f f", "boundary p f f")
    case.replace("DEM/in.cube", "block -0.001 0.101", "block 0. 0.1")
    case.replace("DEM/in.cube", "single 0.0231 0.0312 0.0214", "single 0.0998 0.0312 0.0214")
    case.replace("DEM/in.cube", "single 0.0742 0.0263 0.0317", "single 0.0002 0.0263 0.0317")


class OutputOfPeriodicBoxes(unittest.TestCase):
    def test_particles_that_have_strayed_out_of_the_box_are_written_where_their_copies_are(self):
        for ranks in (1, 2):
            with tempfile.TemporaryDirectory() as folder:
                case = TinyCase(folder, "him")
                periodic_in_x(case)
                if ranks > 1:
                    case.decompose(ranks, (2, 1, 1))
                result = case.run(ranks=ranks)
                self.assertEqual(result.code, 0, result.text[-2000:])
                self.assertEqual(sorted(case.particles("0.002")), list(range(1, 9)))


if __name__ == "__main__":
    unittest.main(verbosity=2)
