# SPDX-License-Identifier: GPL-3.0-or-later
"""nearField: between two field updates the short-range part of the field follows the particles."""

import math
import re
import tempfile
import unittest

from tiny_case import TinyCase

# Cubes of 10 mm cells and spheres of 4 mm; an update of 100 DEM steps is 1 ms.
NEAR = "nearField { interval %d; reach 0.03; }\nexternalField"


class NearField(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def case(self, name, method="p3m", near=None, delta="1e-3"):
        if method == "pairwiseSum":
            case = TinyCase(f"{self.folder}/{name}", method)
            case.replace("constant/electrostaticProperties", "externalField", "pairwiseSumCoeffs { images yes; }\nexternalField")
        elif hasattr(self, "mesh"):
            case = TinyCase.copy(self.mesh, f"{self.folder}/{name}")
        else:
            case = TinyCase(f"{self.folder}/{name}", method)
            self.mesh = f"{self.folder}/mesh"
            TinyCase.copy(case.path, self.mesh)
        # Ten times the charge: the field must bend the paths.
        text = (case.path / "DEM/in.cube").read_text()
        text = re.sub(r"charge (-?\d[\d.e+-]*)", lambda m: "charge %r" % (10 * float(m.group(1))), text)
        (case.path / "DEM/in.cube").write_text(text)
        if near:
            case.replace("constant/electrostaticProperties", "externalField", NEAR % near)
        case.replace("system/controlDict", "deltaT 1e-3;", f"deltaT {delta};")
        case.replace("system/controlDict", "writeInterval 2;", f"writeInterval {round(2e-3 / float(delta))};")
        return case

    def velocities(self, case, ranks=1):
        result = case.run(ranks=ranks)
        self.assertEqual(result.code, 0, result.text[-2000:])
        if (case.path / "constant/polyMesh").exists():
            return {tag: row["U"] for tag, row in case.particles("0.002").items()}
        text = (case.path / "postProcessing/particles/0.002.vtp").read_text()
        arrays = {name: [tuple(map(float, line.split())) for line in body.strip().splitlines()]
                  for name, body in re.findall(r'Name="(\w+)"[^>]*>\n(.*?)</DataArray>', text, re.S)}
        return {int(tag[0]): u for tag, u in zip(arrays["tag"], arrays["U"])}

    def off(self, found, exact):
        return max(abs(a - b) for tag in exact for a, b in zip(found[tag], exact[tag]))

    def test_a_field_that_follows_is_much_closer_to_one_of_every_step_than_a_held_one(self):
        for method in ("p3m", "pairwiseSum", "him"):
            with self.subTest(method):
                self.__dict__.pop("mesh", None)
                every = self.velocities(self.case(f"{method}-every", method, delta="1e-5"))
                held = self.velocities(self.case(f"{method}-held", method))
                follows = self.velocities(self.case(f"{method}-follows", method, near=1))
                self.assertGreater(self.off(held, every), 1e-4, "the held field must make a difference")
                print(method, "held", self.off(held, every), "follows", self.off(follows, every))
                self.assertLess(self.off(follows, every), self.off(held, every) / 5)

    def test_the_error_grows_with_the_interval_of_the_near_field(self):
        every = self.velocities(self.case("every", delta="1e-5"))
        errors = [self.off(self.velocities(self.case(f"near{n}", near=n)), every) for n in (5, 20, 50)]
        self.assertEqual(errors, sorted(errors))

    def test_the_same_on_two_ranks(self):
        case = self.case("alone", near=3)
        alone = self.velocities(case)
        both = self.case("both", near=3)
        both.decompose(2)
        self.assertLess(self.off(self.velocities(both, ranks=2), alone), 1e-9)

    def test_the_log_says_how_the_field_follows(self):
        result = self.case("log", near=4).run()
        self.assertIn("near field anew every 4 DEM steps, within 0.03 m", " ".join(result.text.split()))

    def parting(self, name, phase, near=None):
        """Log of two like charges that part from rest and whose omega T is `phase`, worked out here: omega^2 = 2 q E/(m r), E = q/(4 pi eps0 d^2)."""
        radius, apart, density, update = 0.002, 0.01, 2000.0, 1e-3
        mass = density * 4 / 3 * math.pi * radius ** 3
        charge = phase / update * apart * math.sqrt(mass * radius * 4 * math.pi * 8.8541878128e-12 / 2)
        pair = [((0.045, 0.05, 0.05), (0.0, 0.0, 0.0), charge), ((0.055, 0.05, 0.05), (0.0, 0.0, 0.0), charge)]
        case = TinyCase(f"{self.folder}/{name}", "pairwiseSum", particles=pair)
        case.replace("constant/electrostaticProperties", "externalField (0 0 1000);", near or "")
        case.replace("system/controlDict", "endTime 2e-3;", "endTime 1e-3;")
        result = case.run()
        self.assertEqual(result.code, 0, result.text[-1500:])
        return " ".join(result.text.split())

    DRIFTING = "WARNING: the field of near particles is held for 0.001 s, omega T = %s, above 0.1: charged particles move"
    UNSTABLE = "WARNING: the field of near particles is held for 0.001 s, omega T = %s, above 0.75, the limit of stability"

    def test_a_field_that_is_held_too_long_is_warned_of_above_its_limits_and_not_below(self):
        for phase, expected in ((0.09, None), (0.11, self.DRIFTING % "0.11"), (0.7, self.DRIFTING % "0.7"), (0.8, self.UNSTABLE % "0.8")):
            with self.subTest(phase):
                log = self.parting(f"phase{phase}", phase)
                self.assertEqual(log.count("WARNING: the field of"), 0 if expected is None else 1, log[-1500:])
                if expected:
                    self.assertIn(expected, log)
                    self.assertIn(f"Use at most {0.1 / phase * 1e-3:.2g} s, or nearField in", log)
                self.assertIn("near field held, largest omega T %.2g" % phase, log)

    def test_with_a_near_field_what_stays_held_has_a_limit_of_its_own(self):
        # The clouds' field of a pair has the gradient 105/24 q/(4 pi eps0 R^3) at most: omega falls with the reach to the power 3/2.
        for phase, reach, expected in ((0.2, 0.02, None), (3.0, 0.02, "above 0.75, the limit of stability"), (3.0, 0.08, "above 0.1: charged")):
            with self.subTest(phase=phase, reach=reach):
                log = self.parting(f"far{phase}-{reach}", phase, "nearField { interval 1; reach %g; }" % reach)
                self.assertEqual(log.count("WARNING: the field beyond the reach of nearField is held for 0.001 s"), 0 if expected is None else 1,
                                 log[-1500:])
                self.assertNotIn("WARNING: the field of near particles", log)
                if expected:
                    self.assertIn(expected, log)
                    self.assertIn("or a longer reach", log)
                found = float(re.search(r"far field held, largest omega T (\S+)", log).group(1))
                pair = phase * math.sqrt(105 / 24 * 0.002 * 0.01 ** 2 / reach ** 3)
                self.assertGreater(found, 0.95 * pair)
                self.assertLess(found, 2 * pair)

    def test_what_can_not_be_meant_is_refused(self):
        for words, message in (("interval 101; reach 0.03;", "nearField.interval: 101 DEM steps are more than the 100 of a field update"),
                               ("interval 0; reach 0.03;", "interval"), ("interval 2;", "reach"), ("reach 0.03; intervall 2;", "intervall")):
            with self.subTest(words):
                case = self.case("refused" + str(abs(hash(words))))
                case.replace("constant/electrostaticProperties", "externalField", "nearField { %s }\nexternalField" % words)
                result = case.run("-dry-run")
                self.assertEqual(result.code, 1, result.text[-1500:])
                self.assertIn(message, " ".join(result.text.split()))


if __name__ == "__main__":
    unittest.main(verbosity=2)
