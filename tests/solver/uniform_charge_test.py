# SPDX-License-Identifier: GPL-3.0-or-later
"""fixedUniformCharge: a run goes on with the mean charge on every particle, without charging, and with its walls charged."""

import unittest

from restart_test import DUMP, continuing, last_frame
from tiny_case import PARTICLES, CaseTests, TinyCase
from falling_bed import bed

COUPLING = "constant/couplingProperties"
SWITCH = "wallContactField total;"
UNIFORM = SWITCH + " fixedUniformCharge yes;"
ALL = sum(abs(charge) for _, _, charge in PARTICLES)


def long_case(folder, method="pairwiseSum"):
    """Checkpoints every 20 updates; the script continues from them."""
    case = TinyCase(folder, method)
    case.replace("system/controlDict", "endTime 2e-3;", "endTime 20e-3;")
    case.replace("system/controlDict", "writeInterval 2;", "writeInterval 20;")
    case.replace("system/controlDict", "writeFormat ascii;", "writeFormat binary;")
    script = case.path / "DEM/in.cube"
    script.write_text(continuing(script.read_text()))
    return case


class UniformCharge(CaseTests):
    def test_a_continued_run_keeps_the_total_and_what_walls_have(self):
        for method in ("pairwiseSum", "him"):
            case = long_case("%s/%s" % (self.folder, method), method)
            case.replace("DEM/in.cube", "fix move all", "fix pull all gravity 100 vector 0 0 -1\nfix move all")
            self.ran(case)
            before = case.charge_table()[1][-1]
            self.assertNotEqual(before["floor"], 0)
            self.assertGreater(before["max"] - before["min"], 1e-10)
            case.replace(COUPLING, SWITCH, UNIFORM)
            case.replace("system/controlDict", "startTime 0;", "startTime 0.02;")
            case.replace("system/controlDict", "endTime 20e-3;", "endTime 60e-3;")
            log = self.ran(case).text
            self.assertIn("All 8 particles got their mean", log)
            contacts = [line.split()[-1] for line in log.splitlines() if line.strip().startswith("contacts with particles, walls")]
            self.assertGreater(float(contacts[0]), 0, "something must touch the floor, or nothing could charge")
            for row in case.charge_table("0.02")[1]:
                self.assertAlmostEqual(row["total"], before["total"], delta=1e-12 * ALL)
                self.assertEqual(row["min"], row["max"])
                self.assertAlmostEqual(row["min"], before["total"] / 8, delta=1e-12 * ALL)
                self.assertEqual(row["floor"], before["floor"])
                self.assertAlmostEqual(row["closureError"], 0, delta=1e-12 * ALL)

    def test_insulating_walls_keep_the_charge_of_their_faces_and_get_no_more(self):
        case = bed(self.folder)
        case.replace("system/controlDict", "writeFormat ascii;", "writeFormat binary;")
        script = case.path / "DEM/in.cube"
        script.write_text(continuing(script.read_text()))
        self.ran(case)
        before = case.charge_table()[1][-1]
        self.assertNotEqual(before["wallFaces"], 0)
        case.replace(COUPLING, SWITCH, UNIFORM)
        case.replace("system/controlDict", "startTime 0;", "startTime 0.002;")
        case.replace("system/controlDict", "endTime 2e-3;", "endTime 6e-3;")
        self.ran(case)
        for row in case.charge_table("0.002")[1]:
            self.assertEqual(row["wallFaces"], before["wallFaces"])
            self.assertAlmostEqual(row["total"], before["total"], delta=1e-12 * 7e-11)
            self.assertAlmostEqual(row["wallFaceError"], 0, delta=1e-12 * 7e-11)

    def test_it_continues_bit_for_bit(self):
        case = long_case(self.folder)
        case.replace(COUPLING, SWITCH, UNIFORM)
        case.replace("system/controlDict", "endTime 20e-3;", "endTime 40e-3;")
        script = case.path / "DEM/in.cube"
        text = script.read_text()
        script.write_text(text.replace("fix move all", DUMP % "straight.dump" + "fix move all"))
        self.ran(case)
        script.write_text(text.replace("fix move all", DUMP % "continued.dump" + "fix move all"))
        case.replace("system/controlDict", "startTime 0;", "startTime 0.02;")
        log = self.ran(case).text
        self.assertIn("had the same charge already", log)
        self.assertEqual(last_frame(case.path / "continued.dump"), last_frame(case.path / "straight.dump"))

    def test_any_number_of_ranks_gives_the_same_mean(self):
        rows = []
        for ranks in (1, 2, 4):
            case = TinyCase("%s/%d" % (self.folder, ranks), "pairwiseSum")
            case.replace(COUPLING, SWITCH, UNIFORM)
            self.ran(case, ranks)
            rows.append(case.charge_table()[1])
        mean = sum(charge for _, _, charge in PARTICLES) / 8
        for table in rows:
            for row, reference in zip(table, rows[0]):
                self.assertAlmostEqual(row["min"], mean, delta=1e-15 * ALL)
                self.assertEqual(row["min"], row["max"])
                self.assertAlmostEqual(row["largestField"] / reference["largestField"], 1, delta=1e-11)
                self.assertEqual(row["floor"], 0)

    def test_contradictions_are_refused_together(self):
        still = [((0.05, 0.05, 0.05), (0., 0., 0.), 0.)]
        case = TinyCase(self.folder, "pairwiseSum", particles=still)
        case.replace(COUPLING, SWITCH, UNIFORM)
        case.replace("DEM/in.cube", "area hertz", "area hertz relaxationTime 1.0")
        self.refused(case, "fixedUniformCharge: no particle has a charge, so there is no mean to give",
                     "fixedUniformCharge: it holds all charges, but fix charge/gran/contact lets them leak")

    def test_a_script_that_charges_its_particles_can_start_uniform(self):
        still = [((0.05, 0.05, 0.02 + 0.02 * n), (0., 0., 0.), 0.) for n in range(3)]
        case = TinyCase(self.folder, "pairwiseSum", particles=still)
        case.replace(COUPLING, SWITCH, UNIFORM)
        case.replace("DEM/in.cube", "area hertz", "area hertz initialCharge 1 normal 1e-10 1e-10 seed 7")
        self.ran(case)
        for row in case.charge_table()[1]:
            self.assertEqual(row["min"], row["max"])
            self.assertNotEqual(row["min"], 0)
            self.assertAlmostEqual(row["closureError"], 0, delta=1e-12 * 1e-10)


if __name__ == "__main__":
    unittest.main(verbosity=2)
