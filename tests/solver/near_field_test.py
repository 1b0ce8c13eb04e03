# SPDX-License-Identifier: GPL-3.0-or-later
"""nearField: between two field updates the short-range part of the field follows the particles."""

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
