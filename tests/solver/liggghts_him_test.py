# SPDX-License-Identifier: GPL-3.0-or-later
"""One scene through himFoam and through liggghtsHim: the same forces and charges, because the same code makes them."""

import os
import pathlib
import re
import subprocess
import tempfile
import unittest

from tiny_case import TinyCase

DIGITS = 5.1e-12   # himFoam writes 12 digits

METHODS = {
    "pairwiseSum": ("pairwiseSum", "", "method pairwiseSum"),
    "pairwiseSum with images": ("pairwiseSum", "pairwiseSumCoeffs { images yes; }", "method pairwiseSum images yes without_image lid"),
    "field of others at contact points": ("pairwiseSum", "pairwiseSumCoeffs { images yes; }", "method pairwiseSum images yes without_image lid"),
    "directTruncation": ("directTruncation", "", "method directTruncation cutoff 0.02"),
}


class SameNumbers(unittest.TestCase):
    def liggghts(self, folder, script, line):
        """Last dump of liggghtsHim by tag."""
        text = script.replace("fix move all nve/sphere", "fix field all efield/him %s every 100 external 0 0 1000\nfix move all nve/sphere" % line)
        text += ('dump out all custom 200 out.dump id vx vy vz q f_field[1] f_field[2] f_field[3]\n'
                 'dump_modify out format "%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g"\nrun 200\n')
        pathlib.Path(folder, "in.cube").write_text(text)
        program = os.path.join(os.environ["HIMFOAM_BIN"], "liggghtsHim")
        done = subprocess.run([program, "-in", "in.cube", "-log", "none"], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              encoding="latin-1", timeout=120)
        self.assertEqual(done.returncode, 0, done.stdout[-1500:])
        rows = pathlib.Path(folder, "out.dump").read_text().split("ITEM: ATOMS")[-1].splitlines()[1:]
        numbers = {int(row.split()[0]): list(map(float, row.split()[1:])) for row in rows}
        return {tag: {"U": n[:3], "charge": n[3:4], "electricField": n[4:]} for tag, n in numbers.items()}

    def written(self, file):
        """Particles of a vtp file by tag."""
        arrays = {name: [list(map(float, line.split())) for line in body.strip().splitlines()] for name, body in
                  re.findall(r'Name="(\w+)"[^>]*>\n(.*?)</DataArray>', file.read_text(), re.S)}
        return {int(tag[0]): {key: arrays[key][row] for key in ("U", "charge", "electricField")}
                for row, tag in enumerate(arrays["tag"])}

    def test_velocities_charges_and_fields_agree_to_the_digits_that_himfoam_writes(self):
        for name, (method, coeffs, line) in METHODS.items():
            with self.subTest(name), tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as other:
                case = TinyCase(folder, method)
                if coeffs:
                    case.replace("constant/electrostaticProperties", "externalField", coeffs + "\nexternalField")
                if "contact points" in name:
                    case.replace("DEM/in.cube", "area hertz", "area hertz wallField atContactPoint")
                result = case.run()
                self.assertEqual(result.code, 0, result.text[-1500:])
                hosted = self.written(case.path / "postProcessing/particles/0.002.vtp")
                alone = self.liggghts(other, (case.path / "DEM/in.cube").read_text(), line)
                self.assertEqual(sorted(hosted), sorted(alone))
                self.assertNotEqual(alone[8]["charge"][0], -0.2e-9, "the sphere at the floor must have charged")
                for tag, values in alone.items():
                    for key, vector in values.items():
                        size = max(map(abs, hosted[tag][key]))
                        for found, want in zip(vector, hosted[tag][key]):
                            self.assertAlmostEqual(found, want, delta=DIGITS * size, msg=f"{key} of {tag}")


if __name__ == "__main__":
    unittest.main(verbosity=2)
