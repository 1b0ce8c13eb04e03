# SPDX-License-Identifier: GPL-3.0-or-later
"""Statistics of regions agree with the particles of the same moment, on any number of ranks and over a restart."""

import math
import pathlib
import re
import shutil
import tempfile
import unittest
import xml.etree.ElementTree

from restart_test import continuing
from tiny_case import PARTICLES, CaseTests, TinyCase

FILE = "system/particleStatistics"
OUTLET = "top"  # of cases/singleSettling
MASS = 2000 * math.pi / 6 * 0.004**3

BOX = """
layerThickness 0.004;
layers 8;
profileWidth 0.008;
chargeRange (-3e-9 3e-9);
chargeBins 30;
regions
{
    cube { lower (0 0 0); upper (0.1 0.1 0.1); walls (xMin xMax yMin yMax zMin); }
    all {}
    half { lower (0 0 0); upper (0.1 0.1 0.05); }
}
"""
GRAVITY = "fix pull all gravity 9.81 vector 0 0 -1\nfix move all nve/sphere"


def statistics_case(folder, text=BOX, method="pairwiseSum", **keywords):
    case = TinyCase(folder, method, **keywords)
    case.write(FILE, text)
    return case


def series(case, region, start="0"):
    lines = (case.path / "postProcessing/particleStatistics" / start / (region + ".dat")).read_text().splitlines()
    names = [line for line in lines if line.startswith("# Time")][-1][1:].split()
    return [dict(zip(names, map(float, line.split()))) for line in lines if not line.startswith("#")]


def table(case, region, what, time):
    lines = (case.path / "postProcessing/particleStatistics" / time / (region + what + ".dat")).read_text().splitlines()
    return [line.split() for line in lines if not line.startswith("#")]


def averages(case, region, time):
    return {name: float(value) for name, value in table(case, region, "Averages", time)}


def particles(case, time):
    """Arrays of postProcessing/particles/<time>.vtp by name; vectors as tuples."""
    root = xml.etree.ElementTree.parse(case.path / ("postProcessing/particles/%s.vtp" % time)).getroot()
    found = {}
    for array in root.iter("DataArray"):
        numbers = list(map(float, (array.text or "").split()))
        width = int(array.get("NumberOfComponents", "1"))
        rows = [tuple(numbers[n:n + 3]) for n in range(0, len(numbers), 3)] if width == 3 else numbers
        found[array.get("Name")] = rows
    return found


def nearest_wall(place):
    """Distance and unit vector towards the nearest wall of region cube."""
    walls = [(place[0], (-1, 0, 0)), (0.1 - place[0], (1, 0, 0)), (place[1], (0, -1, 0)), (0.1 - place[1], (0, 1, 0)),
             (place[2], (0, 0, -1))]
    return min(walls, key=lambda wall: wall[0])


class Statistics(CaseTests):
    def test_numbers_are_those_of_the_written_particles(self):
        case = statistics_case(self.folder)
        self.ran(case)
        self.assertEqual([row["Time"] for row in series(case, "cube")], [0, 1e-3, 2e-3])
        last = series(case, "cube")[-1]
        there = particles(case, "0.002")
        places = there.get("Points") or next(rows for name, rows in there.items() if name.lower() in ("points", "position"))
        total = sum(there["charge"])
        self.assertEqual(last["particles"], len(PARTICLES))
        self.assertAlmostEqual(last["charge"] / total, 1, delta=1e-10)  # the file has 12 digits
        self.assertAlmostEqual(last["chargePerMass"] / (total / (8 * MASS)), 1, delta=1e-9)
        self.assertAlmostEqual(last["meanCharge"] / (total / 8), 1, delta=1e-10)
        near = [nearest_wall(place) for place in places]
        layers = [sum(1 for distance, _ in near if 0.004 * n <= distance < 0.004 * (n + 1)) for n in range(8)]
        self.assertGreater(sum(layers), 3)
        self.assertEqual([last["layer%d" % (n + 1)] for n in range(8)], layers)
        at_wall = [n for n, (distance, _) in enumerate(near) if distance < 0.004]
        self.assertEqual(len(at_wall), 1)  # the one that hit the floor
        speed = math.sqrt(sum(v * v for n in at_wall for v in there["U"][n]) / len(at_wall))
        self.assertAlmostEqual(last["wallSpeed"] / speed, 1, delta=1e-9)
        force = sum(there["charge"][n] * sum(e * d for e, d in zip(there["electricField"][n], near[n][1])) for n in at_wall)
        self.assertAlmostEqual(last["forceOnWall"] / force, 1, delta=1e-9)
        inside = [n for n, place in enumerate(places) if place[2] < 0.05]
        self.assertEqual(series(case, "half")[-1]["particles"], len(inside))
        self.assertAlmostEqual(series(case, "half")[-1]["charge"] / sum(there["charge"][n] for n in inside), 1, delta=1e-10)

    def test_averages_distribution_and_profile_hold_all_samples_since_the_last_write_time(self):
        case = statistics_case(self.folder)
        self.ran(case)
        rows = series(case, "cube")[1:]
        mean = averages(case, "cube", "0.002")
        for name in ("charge", "forceOnWall", "wallParticles", "layer3"):
            self.assertAlmostEqual(mean[name], sum(row[name] for row in rows) / 2, delta=1e-12 * max(abs(mean[name]), 1e-30))
        squares = sum(row["wallSpeed"]**2 * row["wallParticles"] for row in rows) / sum(row["wallParticles"] for row in rows)
        self.assertAlmostEqual(mean["wallSpeed"] / math.sqrt(squares), 1, delta=1e-12)
        density = [(float(q), float(p), float(share)) for q, p, share in table(case, "cube", "ChargePDF", "0.002")]
        self.assertEqual(len(density), 30)
        self.assertAlmostEqual(sum(share for _, _, share in density), 1, delta=1e-12)
        self.assertAlmostEqual(sum(p for _, p, _ in density) * 2e-10, 1, delta=1e-12)
        # The charge of the distribution's bins is the mean charge to the width of a bin.
        self.assertAlmostEqual(sum(q * share for q, _, share in density), mean["meanCharge"], delta=1e-10)
        profile = [tuple(map(float, row)) for row in table(case, "cube", "Profile", "0.002")]
        counts, previous = 0, 0.1**3
        for n, (distance, number, _, _) in enumerate(profile):
            self.assertAlmostEqual(distance, 0.008 * (n + 0.5), delta=1e-15)
            reach = min(0.008 * (n + 1), 0.05)
            inner = (0.1 - 2 * reach)**2 * (0.1 - reach)
            counts += number * (previous - inner)
            previous = inner
        self.assertAlmostEqual(counts, 8, delta=1e-9)

    def test_any_number_of_ranks_gives_the_same(self):
        for method, tolerance in (("pairwiseSum", 1e-11), ("p3m", 1e-9)):
            serial = statistics_case("%s/%s1" % (self.folder, method), method=method)
            serial.replace("DEM/in.cube", "fix move all nve/sphere", GRAVITY)
            self.ran(serial)
            for ranks in (2, 4):
                case = statistics_case("%s/%s%d" % (self.folder, method, ranks), method=method)
                case.replace("DEM/in.cube", "fix move all nve/sphere", GRAVITY)
                self.ran(case, ranks)
                for region in ("cube", "half"):
                    for row, reference in zip(series(case, region), series(serial, region)):
                        for name, value in reference.items():
                            if not math.isnan(value):
                                self.assertAlmostEqual(row[name], value, delta=tolerance * max(abs(value), 1e-9), msg=name)
                for what in ("Profile", "ChargePDF"):
                    for row, reference in zip(table(case, "cube", what, "0.002"), table(serial, "cube", what, "0.002")):
                        for a, b in zip(row, reference):
                            self.assertAlmostEqual(float(a), float(b), delta=tolerance * max(abs(float(b)), 1e-20))

    def test_the_floor_carries_what_lies_on_it_and_the_other_wall_nothing(self):
        lying = [((0.02 + 0.01 * n, 0.05, 0.002), (0., 0., 0.), 0.) for n in range(4)]
        case = statistics_case(self.folder, particles=lying)
        case.replace("DEM/in.cube", "fix move all nve/sphere", GRAVITY)
        case.replace("DEM/in.cube", "2 0.9 0.9 0.9 0.9", "2 0.1 0.1 0.1 0.1")
        case.replace("DEM/in.cube", "gamma -7.67e5 kappa 20.0", "gamma 0 kappa 20.0")
        case.replace("system/controlDict", "endTime 2e-3;", "endTime 0.06;")
        case.replace("system/controlDict", "writeInterval 2;", "writeInterval 30;")
        self.ran(case)
        last = series(case, "cube")[-1]
        self.assertAlmostEqual(last["weight"] / (4 * MASS * 9.81), 1, delta=1e-9)
        self.assertAlmostEqual(last["wallShare"], 1, delta=1e-3)
        self.assertEqual(last["by_floor"], last["wallShare"])
        self.assertEqual(last["by_lid"], 0)
        self.assertAlmostEqual(averages(case, "cube", "0.06")["wallShare"], 1, delta=1e-3)

    def test_a_checkpoint_while_a_particle_changes_its_rank_leaves_the_wall_forces_with_their_particles(self):
        # One flies over to the other rank, under the distance at which LIGGGHTS sorts anew; the others hit the lid.
        scene = [((0.0499, 0.05, 0.05), (0.2, 0., 0.), 0.)] + [((0.01 + 0.01 * n, 0.05, 0.09795 - 2e-6 * n), (0., 0., 0.1), 0.) for n in range(8)]
        shares = {}
        for ranks in (1, 2):
            case = statistics_case("%s/%d" % (self.folder, ranks), "regions { left { lower (0 0 0); upper (0.045 0.1 0.1); } }", particles=scene)
            case.replace("DEM/in.cube", "fix move all nve/sphere", GRAVITY)
            case.replace("DEM/in.cube", "gamma -7.67e5 kappa 20.0", "gamma 0 kappa 20.0")
            case.replace("DEM/in.cube", "processors * * *", "processors * 1 1")
            case.replace("system/controlDict", "writeInterval 2;", "writeInterval 1;")
            self.ran(case, ranks)
            shares[ranks] = [row["by_lid"] for row in series(case, "left")]
        self.assertLess(shares[1][1], -1)
        self.assertEqual(len(shares[2]), len(shares[1]))
        for one, two in zip(shares[1], shares[2]):
            self.assertAlmostEqual(two, one, delta=1e-11 * max(abs(one), 1))

    def test_walls_that_store_their_force_by_themselves_give_the_same(self):
        shares = []
        for words in ("", " store_force yes"):
            pressed = [((0.05, 0.05, 0.0019), (0., 0., 0.), 0.), ((0.07, 0.05, 0.0981), (0., 0., 0.), 0.)]
            case = statistics_case("%s/%d" % (self.folder, len(words)), particles=pressed)
            case.replace("DEM/in.cube", "fix move all nve/sphere", GRAVITY)
            case.replace("DEM/in.cube", "zplane 0.0\n", "zplane 0.0%s\n" % words)
            self.ran(case)
            shares.append([(row["by_floor"], row["by_lid"]) for row in series(case, "all")])
        self.assertGreater(shares[0][0][0], 1)   # far more than their weight
        self.assertLess(shares[0][0][1], -1)     # the lid pushes down
        self.assertEqual(shares[0], shares[1])

    def test_a_run_that_continues_goes_on_with_averages_and_fit(self):
        # Spheres between floor and lid, 2 mm apart, that charge a little at every second bounce.
        bouncing = [((0.02 + 0.01 * n, 0.05, 0.0025 + 1e-4 * n), (0., 0., 1. + 0.1 * n), 0.) for n in range(6)]
        case = statistics_case(self.folder, particles=bouncing)
        case.replace("DEM/in.cube", "2 0.9 0.9 0.9 0.9", "2 1.0 1.0 1.0 1.0")
        case.replace("DEM/in.cube", "zplane 0.1\n", "zplane 0.006\n")
        case.replace("DEM/in.cube", "gamma -7.67e5 kappa 20.0", "gamma -7.67e5 kappa 40.0")
        case.replace("system/controlDict", "endTime 2e-3;", "endTime 60e-3;")
        case.replace("system/controlDict", "writeInterval 2;", "writeInterval 20;")
        case.replace("system/controlDict", "writeFormat ascii;", "writeFormat binary;")
        script = case.path / "DEM/in.cube"
        script.write_text(continuing(script.read_text()).replace("fix move all nve/sphere", GRAVITY))
        self.ran(case)
        straight = series(case, "cube")
        files = {(what, time): table(case, "cube", what, time) for what in ("Averages", "Profile", "ChargePDF")
                 for time in ("0.04", "0.06")}
        self.assertGreater(straight[-1]["tau"], 2e-3)  # the curve is found, or nothing would be compared
        for start in ("0.02", "0.04"):
            case.replace("system/controlDict", "startTime %s;" % ("0" if start == "0.02" else "0.02"), "startTime %s;" % start)
            self.ran(case)
            more = series(case, "cube", start)
            expected = straight[-len(more):]
            self.assertEqual(more[0]["Time"], float(start))
            # The first line knows the forces of the start, which the straight run had computed one half step away.
            for row, reference in zip(more[1:], expected[1:]):
                for name, value in reference.items():
                    if not math.isnan(value):
                        # The fit's minimum is flat: it tells its place to the root of round-off.
                        delta = 1e-6 if name in ("saturation", "tau", "fitDeviation") else 1e-9
                        self.assertAlmostEqual(row[name], value, delta=delta * max(abs(value), 1e-9), msg=name)
            for (what, time), rows in files.items():
                if float(time) > float(start):
                    for row, reference in zip(table(case, "cube", what, time), rows):
                        self.assertEqual(row[0], reference[0])
                        delta = 1e-6 if row[0] in ("saturation", "tau", "fitDeviation") else 1e-9
                        for a, b in zip(row[1:], reference[1:]):
                            self.assertAlmostEqual(float(a), float(b), delta=delta * max(abs(float(b)), 1e-20))

    def test_a_case_without_the_file_has_no_statistics(self):
        case = TinyCase(self.folder, "pairwiseSum")
        self.ran(case)
        self.assertFalse((case.path / "postProcessing/particleStatistics").exists())

    def test_wrong_entries_are_named_together(self):
        case = statistics_case(self.folder, """
            sampleInterval 0; layers -1; chargeRange (1 0); colour red;
            regions
            {
                a { lower (0 0 0.2); upper (0.1 0.1 0.1); walls (xMin left xMin); profileWidth -1; }
                b 3;
                c { profileDepth 0.01; }
            }""")
        result = case.run("-dry-run")
        self.assertEqual(result.code, 1)
        flat = " ".join(result.text.split())
        for text in ("system/particleStatistics: sampleInterval: found 0, but a whole number from 1 upwards",
                     "system/particleStatistics: layers: found -1", "chargeRange: found", "colour: unknown entry",
                     "regions: a: upper: along z the region ends at 0.1 m, not above its lower corner, 0.2 m",
                     "regions: a: walls: unknown side `left`; known: xMin, xMax, yMin, yMax, zMin, zMax.",
                     "the side xMin is named twice", "regions: a: profileWidth: found -1",
                     "regions: b: found `3`, but a sub-dictionary",
                     "regions: c: profileDepth: is about the distance from walls, but no side"):
            self.assertIn(text, flat)

    def test_what_the_scene_does_not_tell_is_asked_for(self):
        case = statistics_case(self.folder, "regions { a { upper (0.1 0.1 0.1); } b { lower (1 1 1); upper (2 2 2); } } "
                                            "pressureDrop { inlet bottom; outlet top; }")
        script = case.path / "DEM/in.cube"
        script.write_text("\n".join(line for line in script.read_text().splitlines()
                                    if not line.startswith(("create_atoms", "set atom"))) + "\n")
        flat = " ".join(case.run("-dry-run").text.split())
        self.assertIn("pressureDrop: the case has no gas (constant/gasProperties), so there is no pressure drop", flat)
        case.replace(FILE, "pressureDrop { inlet bottom; outlet top; }", "")
        flat = " ".join(case.run("-dry-run").text.split())
        self.assertIn("regions: a: layerThickness: the entry is missing, and its default, the mean diameter, is that of no particle", flat)
        self.assertIn("regions: b: the region lies outside the DEM box", flat)

    def test_a_scene_without_charge_has_no_distribution(self):
        still = [((0.05, 0.05, 0.05), (0., 0., 0.), 0.)]
        case = statistics_case(self.folder, "regions { a {} }", particles=still)
        case.replace("DEM/in.cube", "gamma -7.67e5 kappa 20.0", "gamma 0 kappa 20.0")
        self.ran(case)
        folder = case.path / "postProcessing/particleStatistics/0.002"
        self.assertEqual([path.name for path in folder.iterdir()], ["aAverages.dat"])


class PressureDrop(unittest.TestCase):
    def test_it_is_that_of_the_patches_less_the_empty_column(self):
        with tempfile.TemporaryDirectory() as folder:
            settling = pathlib.Path(__file__).resolve().parents[2] / "cases/singleSettling"
            case = TinyCase.copy(settling, folder)
            shutil.rmtree(case.path / "postProcessing", ignore_errors=True)
            case.replace("system/controlDict", "endTime         0.56;", "endTime         0.01;")
            case.write(FILE, "pressureDrop { inlet floor; outlet %s; emptyColumn 0.25; } regions { all {} }" % OUTLET)
            case.tool("blockMesh")
            result = case.run()
            self.assertEqual(result.code, 0, result.text[-3000:])
            lines = (case.path / "postProcessing/gas/0/gas.dat").read_text().splitlines()
            names = [line for line in lines if line.startswith("# Time")][0][2:].split()
            gas = {round(row["Time"], 9): row for row in
                   (dict(zip(names, map(float, line.split()))) for line in lines if not line.startswith("#"))}
            rows = series(case, "all")
            self.assertGreater(len(rows), 10)
            for row in rows[1:]:
                there = gas[round(row["Time"], 9)]
                drop = there["p_floor"] - there["p_%s" % OUTLET]
                self.assertAlmostEqual(row["pressureDrop"], drop - 0.25, delta=1e-9)
            self.assertGreater(max(abs(row["pressureDrop"] + 0.25) for row in rows), 1e-7)
            case.replace(FILE, "outlet %s;" % OUTLET, "outlet chimney;")
            self.assertIn("pressureDrop: unknown patch `chimney`; known: ", case.run("-dry-run").text)


class Equilibrium(unittest.TestCase):
    def log(self, change):
        with tempfile.TemporaryDirectory() as folder:
            case = TinyCase(folder, "pairwiseSum", particles=[((0.05, 0.05, 0.05), (0., 0., 0.), 0.)], diameter=277e-6)
            case.replace("DEM/in.cube", "density 2000", "density 960")
            case.replace("DEM/in.cube", "fix move all nve/sphere", GRAVITY)
            change(case)
            result = case.run("-dry-run")
            self.assertEqual(result.code, 0, result.text)
            return result.text

    def row(self, text):
        found = re.search(r"^    1 +(\S+) +(\S+) +(\S+) +(\S+) +(\S.*)$", text[text.index("Equilibrium"):], re.M)
        return [float(word) if word != "n/a" else word for word in found.groups()[:4]], found.group(5).strip()

    def test_the_bed_of_sippola_has_its_equilibrium_charge_and_ratio(self):
        """e/g = 1 and 4, from Gamma 4.432e5 and 8.864e5 V/m: 9.459e-13 and 1.892e-12 C."""
        for limit, charge, ratio in ((4.432e5, 9.459e-13, 1), (8.864e5, 1.892e-12, 4)):
            text = self.log(lambda case: case.replace("DEM/in.cube", "gamma -7.67e5 kappa 20.0", "gamma %r kappa 1.0" % limit))
            values, walls = self.row(text)
            self.assertAlmostEqual(values[0], 277e-6, delta=1e-9)
            self.assertAlmostEqual(values[1], limit, delta=1)
            self.assertAlmostEqual(values[2] / charge, 1, delta=5e-4)
            self.assertAlmostEqual(values[3] / ratio, 1, delta=1e-3)
            self.assertEqual(walls, "floor")  # the lid transfers nothing

    def test_the_own_image_halves_it_and_without_gravity_there_is_no_ratio(self):
        def change(case):
            case.replace("DEM/in.cube", "gamma -7.67e5 kappa 20.0 area hertz", "gamma 8.864e5 kappa 1.0 area hertz ownImage included")
            case.replace("DEM/in.cube", "fix pull all gravity 9.81 vector 0 0 -1\n", "")
        values, _ = self.row(self.log(change))
        self.assertAlmostEqual(values[2] / 0.946e-12, 1, delta=1e-3)
        self.assertEqual(values[3], "n/a")

    def test_nothing_is_printed_where_no_wall_charges(self):
        text = self.log(lambda case: case.replace("constant/couplingProperties", "floor grounded;", "floor noTransfer;"))
        self.assertNotIn("Equilibrium", text)


if __name__ == "__main__":
    unittest.main(verbosity=2)
