# SPDX-License-Identifier: GPL-3.0-or-later
"""A run that continues from a checkpoint goes on as the run that wrote it."""

import tempfile
import unittest

from tiny_case import TinyCase

DUMP = """dump out all custom 100 %s id x y z vx vy vz q
dump_modify out format "%%d %%.17g %%.17g %%.17g %%.17g %%.17g %%.17g %%.17g" sort id
"""
# Everything that makes particles, in the first run; the checkpoint, in a run that continues.
CREATE = ("region box", "create_box", "create_atoms", "set atom")


def continuing(script):
    """The script with LIGGGHTS' usual branch on the time that himFoam starts from."""
    created = [line for line in script.splitlines() if line.startswith(CREATE)]
    for line in created:
        script = script.replace(line + "\n", "")
    fresh = " ".join('"%s"' % line for line in created if not line.startswith("set atom"))
    placed = " ".join('"%s"' % line for line in created if line.startswith("set atom"))
    script = "variable startTime index 0\n" + script
    script = script.replace("neighbor 0.002 bin", 'if "${startTime} > 0" then "read_restart DEM/restart/${startTime}" else %s\n'
                                                  "neighbor 0.002 bin" % fresh)
    return script.replace("fix tribo", 'if "${startTime} == 0" then %s\nfix tribo' % placed)


def last_frame(path):
    return [line.split() for line in path.read_text().split("ITEM: ATOMS")[-1].splitlines()[1:]]


class Restart(unittest.TestCase):
    def compare(self, method, entries="", charging="", **scene):
        with tempfile.TemporaryDirectory() as folder:
            case = TinyCase(folder, method, **scene)
            case.replace("constant/electrostaticProperties", "externalField", entries + "externalField")
            case.replace("system/controlDict", "endTime 2e-3;", "endTime 40e-3;")
            case.replace("system/controlDict", "writeInterval 2;", "writeInterval 20;")
            case.replace("system/controlDict", "writeFormat ascii;", "writeFormat binary;")
            script = case.path / "DEM/in.cube"
            text = continuing(script.read_text()).replace(" area hertz", " area hertz" + charging)
            script.write_text(text.replace("fix move all", DUMP % "straight.dump" + "fix move all"))
            straight = case.run()
            self.assertEqual(straight.code, 0, straight.text[-2000:])

            script.write_text(text.replace("fix move all", DUMP % "continued.dump" + "fix move all"))
            case.replace("system/controlDict", "startTime 0;", "startTime 0.02;")
            continued = case.run()
            self.assertEqual(continued.code, 0, continued.text[-2000:])

            self.assertEqual(last_frame(case.path / "continued.dump"), last_frame(case.path / "straight.dump"))
            _, rows = case.charge_table("0")
            _, more = case.charge_table("0.02")
            self.assertNotEqual(rows[-1]["floor"], 0, "something must have charged")
            for name in ("total", "floor", "inserted", "removed"):
                self.assertAlmostEqual(more[-1][name], rows[-1][name], delta=1e-15 * 1e-9, msg=name)
            self.assertAlmostEqual(more[-1]["closureError"], 0, delta=1e-12 * 7e-9)

    def test_pairwise_sum_continues_bit_for_bit(self):
        self.compare("pairwiseSum")

    def test_him_continues_bit_for_bit(self):
        self.compare("him")

    def test_p3m_continues_bit_for_bit(self):
        self.compare("p3m")

    def test_p3m_in_cells_smaller_than_particles_continues_bit_for_bit(self):
        # Its table of the mesh's own answers is made anew by the run that continues.
        balls = [((0.031, 0.032, 0.0063), (0.1, 0.2, -0.4), 1e-9), ((0.062, 0.057, 0.021), (-0.2, 0.1, -0.7), -2e-9)]
        self.compare("p3m", particles=balls, diameter=0.012)

    def test_a_spread_of_gamma_belongs_to_the_same_particles_after_a_restart(self):
        self.compare("pairwiseSum", charging=" spread 1 gamma 2e5 seed 11")

    def test_a_field_that_follows_the_particles_continues_bit_for_bit(self):
        self.compare("p3m", "nearField { interval 7; reach 0.03; }\n")


if __name__ == "__main__":
    unittest.main(verbosity=2)
