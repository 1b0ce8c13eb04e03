# SPDX-License-Identifier: GPL-3.0-or-later
"""Projective charging: bursts of true charging and leaps come to the charges of plain charging, and the books close."""

import math
import random
import unittest

from restart_test import DUMP, continuing
from tiny_case import CaseTests, TinyCase
from falling_bed import bed

COUPLING = "constant/couplingProperties"
SWITCH = "wallContactField total;"
DIAMETER = 0.008
SIDES = ("xplane 0.0", "xplane 0.1", "yplane 0.0", "yplane 0.1", "zplane 0.1")


def gas(folder, end, acceleration=1, burst=0, leap=0, number=64, write=None):
    """Spheres that fly about in the cube without losing speed, and charge a little at every touch of a wall."""
    chance = random.Random(5)
    sites = [(0.02 + 0.02 * i, 0.02 + 0.02 * j, 0.02 + 0.02 * k) for i in range(4) for j in range(4) for k in range(4)][:number]
    particles = [(site, tuple(chance.gauss(0, 2.0) for _ in range(3)), 0.) for site in sites]
    case = TinyCase(folder, "pairwiseSum", particles=particles, diameter=DIAMETER)
    case.replace("constant/electrostaticProperties", "externalField (0 0 1000);", "fieldError { active no; }")
    case.replace("DEM/in.cube", "2 0.9 0.9 0.9 0.9", "2 1.0 1.0 1.0 1.0")
    case.replace("DEM/in.cube", "2 0.3 0.3 0.3 0.3", "2 0.0 0.0 0.0 0.0")
    more = "\n".join("fix wall%d all wall/gran model hertz tangential history cohesion charge primitive type 2 %s" % (n, side)
                     for n, side in enumerate(SIDES))
    case.replace("DEM/in.cube", "fix lid all wall/gran model hertz tangential history cohesion charge primitive type 2 zplane 0.1", more)
    case.replace("DEM/in.cube", "pair 1 1 gamma 0 kappa 3600 pair 1 2 gamma -7.67e5 kappa 20.0",
                 "pair 1 1 gamma 0 kappa 0.05 pair 1 2 gamma -7.67e5 kappa 0.4 acceleration %r" % acceleration)
    targets = " ".join("wall%d grounded;" % n for n in range(len(SIDES)))
    case.replace(COUPLING, "lid noTransfer;", targets)
    case.replace(COUPLING, SWITCH, "wallContactField self; chargeInterval 20;"
                 + (" projectiveCharging { burst %d; leap %d; }" % (burst, leap) if leap else ""))
    case.replace("system/controlDict", "endTime 2e-3;", "endTime %r;" % end)
    case.replace("system/controlDict", "writeInterval 2;", "writeInterval %d;" % (write or round(end / 1e-3)))
    return case


def final_charges(case, name="final.dump", number=64):
    return [float(line.split()[1]) for line in (case.path / name).read_text().splitlines()[-number:]]


def dumped(case, steps, name="final.dump"):
    case.replace("DEM/in.cube", "fix move all", 'dump out all custom %d %s id q\ndump_modify out format "%%d %%.17g" sort id first no\n'
                 "fix move all" % (steps, name))
    return case


def moments(charges):
    mean = sum(charges) / len(charges)
    return mean, math.sqrt(sum((q - mean)**2 for q in charges) / len(charges))


class ProjectiveCharging(CaseTests):
    def leaps(self, case, start="0"):
        lines = (case.path / "postProcessing/projectiveCharging" / start / "projectiveCharging.dat").read_text().splitlines()
        names = lines[len([line for line in lines if line.startswith("#")]) - 1][1:].replace("...", "").split()
        return [dict(zip(names, map(float, line.split()))) for line in lines if not line.startswith("#")]

    def test_the_mean_is_that_of_plain_charging_and_the_spread_below_that_of_acceleration(self):
        plain = dumped(gas(self.folder + "/plain", 2.0), 200000)
        fast = dumped(gas(self.folder + "/fast", 0.2, acceleration=10), 20000)
        ours = dumped(gas(self.folder + "/ours", 0.2, burst=20, leap=9), 20000)
        for case in (plain, fast, ours):
            self.ran(case)
        exact, accelerated, projected = (moments(final_charges(case)) for case in (plain, fast, ours))
        print("mean and spread [C]: plain %.4g %.4g, accelerated %.4g %.4g, projected %.4g %.4g"
              % (*exact, *accelerated, *projected))
        errors = [row["error"] for row in self.leaps(ours)[1:]]
        print("error indicator: mean %.3g, largest %.3g" % (sum(errors) / len(errors), max(errors)))
        self.assertLess(max(errors), 0.3)
        self.assertAlmostEqual(self.leaps(ours)[-1]["chargingTime"], 2.0, delta=1e-9)
        self.assertAlmostEqual(projected[0] / exact[0], 1, delta=0.1)
        self.assertLess(projected[1], 2 * exact[1])
        self.assertGreater(accelerated[1], projected[1])

    def test_the_books_close_and_the_limit_is_not_passed(self):
        case = gas(self.folder, 0.12, burst=20, leap=30)
        # Between particles the field of the others may move charge beyond it, so walls alone charge here.
        case.replace("DEM/in.cube", "pair 1 1 gamma 0 kappa 0.05", "pair 1 1 none")
        case.replace(COUPLING, "chargeInterval 20;", "chargeInterval 1;")
        self.ran(case)
        equilibrium = -math.pi * 8.8541878128e-12 * DIAMETER**2 * 7.67e5
        rows = case.charge_table()[1]
        self.assertLess(rows[-1]["mean"], 0.3 * equilibrium)
        for row in rows:
            self.assertAlmostEqual(row["closureError"], 0, delta=1e-12 * max(abs(row["total"]), 1e-12))
            self.assertGreater(row["min"], equilibrium * (1 + 1e-9))
        walls = sum(rows[-1][name] for name in rows[-1] if name == "floor" or name.startswith("wall"))
        self.assertAlmostEqual(walls / -rows[-1]["total"], 1, delta=1e-11)  # the table has 12 digits
        leaps = self.leaps(case)
        self.assertEqual([round(row["Time"], 9) for row in leaps], [0.02, 0.04, 0.06, 0.08, 0.1, 0.12])
        for row in leaps:
            self.assertAlmostEqual(row["toWalls"] / -row["leapGain"], 1, delta=1e-9)
        self.assertTrue(all(row["error"] >= 0 for row in leaps[1:]))

    def test_charge_of_insulating_walls_goes_on_on_their_faces(self):
        case = bed(self.folder)
        case.replace(COUPLING, SWITCH, SWITCH + " projectiveCharging { burst 1; leap 3; }")
        self.ran(case)
        row = case.charge_table()[1][-1]
        leap = self.leaps(case)[0]
        self.assertNotEqual(leap["leapGain"], 0)
        self.assertAlmostEqual(row["wallFaces"], row["floor"], delta=1e-12 * 1e-10)
        self.assertAlmostEqual(row["wallFaceError"], 0, delta=1e-12 * 1e-10)
        self.assertAlmostEqual(row["total"] + row["wallFaces"], 7e-11, delta=1e-12 * 1e-10)

    def test_any_number_of_ranks_leaps_alike(self):
        tables = []
        for ranks in (1, 2, 4):
            case = gas("%s/%d" % (self.folder, ranks), 0.04, burst=10, leap=5)
            self.ran(case, ranks)
            tables.append((self.leaps(case), case.charge_table()[1]))
        self.assertNotEqual(tables[0][0][-1]["leapGain"], 0)
        for leaps, rows in tables[1:]:
            for row, reference in zip(leaps, tables[0][0]):
                for name, value in reference.items():
                    if not math.isnan(value):
                        self.assertAlmostEqual(row[name], value, delta=1e-6 * max(abs(value), 1e-15), msg=name)
            self.assertAlmostEqual(rows[-1]["total"] / tables[0][1][-1]["total"], 1, delta=1e-6)

    def test_a_run_that_continues_leaps_bit_for_bit_alike(self):
        case = gas(self.folder, 0.08, burst=10, leap=5, number=16, write=20)
        case.replace("system/controlDict", "writeFormat ascii;", "writeFormat binary;")
        script = case.path / "DEM/in.cube"
        text = continuing(script.read_text())
        script.write_text(text.replace("fix move all", DUMP % "straight.dump" + "fix move all"))
        self.ran(case)
        straight = self.leaps(case)
        script.write_text(text.replace("fix move all", DUMP % "continued.dump" + "fix move all"))
        case.replace("system/controlDict", "startTime 0;", "startTime 0.04;")
        self.ran(case)
        more = self.leaps(case, "0.04")
        self.assertEqual(len(more), 4)
        self.assertEqual(more, straight[-4:])
        last = [(case.path / name).read_text().splitlines()[-16:] for name in ("straight.dump", "continued.dump")]
        self.assertEqual(last[0], last[1])

    def test_no_earlier_run_lends_its_expectations(self):
        case = gas(self.folder, 0.04, burst=10, leap=5, number=16, write=20)
        script = case.path / "DEM/in.cube"
        script.write_text(continuing(script.read_text()))
        self.ran(case)
        # Bursts of another length: the charging time goes on, what the earlier ones made expect does not.
        case.replace("system/controlDict", "startTime 0;", "startTime 0.04;")
        case.replace("system/controlDict", "endTime 0.04;", "endTime 0.08;")
        case.replace(COUPLING, "{ burst 10; leap 5; }", "{ burst 20; leap 5; }")
        self.ran(case)
        first = self.leaps(case, "0.04")[0]
        self.assertAlmostEqual(first["chargingTime"], 0.06 + 0.2 + 0.1, delta=1e-9)
        self.assertEqual(first["error"], 0)
        # A checkpoint that a run without leaps has written in its place.
        self.assertTrue((case.path / "DEM/restart/0.04.projection").exists())
        case.replace("system/controlDict", "startTime 0.04;", "startTime 0;")
        case.replace("system/controlDict", "endTime 0.08;", "endTime 0.04;")
        text = (case.path / COUPLING).read_text()
        case.replace(COUPLING, "projectiveCharging { burst 20; leap 5; }", "")
        self.ran(case)
        self.assertFalse((case.path / "DEM/restart/0.04.projection").exists())

    def test_statistics_fit_the_charging_time(self):
        case = gas(self.folder, 0.04, burst=10, leap=5)
        case.write("system/particleStatistics", "regions { all {} }")
        self.ran(case)
        lines = (case.path / "postProcessing/particleStatistics/0/all.dat").read_text().splitlines()
        last = [float(word) for word in lines[-1].split()]
        self.assertAlmostEqual(last[1], 0.04 * 6, delta=1e-12)

    def test_a_checkpoint_inside_a_burst_is_told(self):
        case = gas(self.folder, 0.02, burst=15, leap=2, number=2, write=10)
        self.assertIn("this checkpoint lies inside a burst", self.ran(case).text)

    def test_contradictions_are_refused(self):
        case = gas(self.folder + "/a", 0.02, acceleration=10, burst=5, leap=3, number=2)
        case.replace("DEM/in.cube", "area hertz", "area hertz relaxationTime 1.0")
        self.refused(case, "projectiveCharging: its bursts are true charging, but the script has acceleration 10",
                     "projectiveCharging: it projects what contacts move, but")
        case = gas(self.folder + "/b", 0.02, burst=5, leap=3, number=2)
        case.replace(COUPLING, "{ burst 5; leap 3; }", "{ burst 0; jump 3; } fixedUniformCharge yes;")
        self.refused(case, "projectiveCharging: burst: found 0, but a whole number from 1 upwards",
                     "projectiveCharging: leap: the entry is missing", "projectiveCharging: jump: unknown entry; known: burst, leap.",
                     "projectiveCharging: fixedUniformCharge switches charging off")


if __name__ == "__main__":
    unittest.main(verbosity=2)
