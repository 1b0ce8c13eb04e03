# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh of its own for the field, region `electric`: it alone is used, whole or cut, with as few files as possible."""

import shutil
import tempfile
import unittest

from tiny_case import BLOCK_MESH, POTENTIAL, SIZE, TinyCase


class RegionElectric(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def case(self, name, gas, electric):
        """A case with a gas mesh and an electrostatic one of so many cells; None: without."""
        case = TinyCase("%s/%s" % (self.folder, name), cells=gas or electric)
        case.replace("system/controlDict", "endTime 2e-3;", "endTime 1e-3;")
        case.replace("system/controlDict", "writeInterval 2;", "writeInterval 1;")
        if electric:
            case.write("system/electric/blockMeshDict", BLOCK_MESH % {"size": SIZE, "cells": "%d %d %d" % electric})
            case.tool("blockMesh", "-region", "electric")
            case.write("0/electric/electricPotential", POTENTIAL, "volScalarField")
        if not gas:
            shutil.rmtree(case.path / "constant/polyMesh")
            for file in ("system/fvSchemes", "system/fvSolution", "0/electricPotential"):
                (case.path / file).unlink()
        return case

    def charges(self, case, ranks=1):
        result = case.run(ranks=ranks)
        self.assertEqual(result.code, 0, result.text)
        row = case.charge_table()[1][-1]
        row.pop("energy")  # nan: him has none
        return row

    def test_the_region_is_used_and_not_the_mesh_beside_it(self):
        both = self.charges(self.case("both", (4, 4, 4), (12, 11, 13)))
        self.assertEqual(both, self.charges(self.case("region", None, (12, 11, 13))))
        only = self.case("gas", (12, 11, 13), None)
        only.replace("system/fvSolution", "directSolve no;", "")
        self.assertEqual(both, self.charges(only))

    def test_fields_are_written_for_the_region(self):
        case = self.case("written", None, (12, 11, 13))
        self.charges(case)
        potential = case.field_values("0.001/electric/electricPotential")
        self.assertEqual(len(potential), 12 * 11 * 13)
        self.assertGreater(max(potential), 0)
        self.assertTrue((case.path / "0.001/electric/lagrangian/particles/charge").exists())

    def test_cut_regions_give_the_same(self):
        serial = self.charges(self.case("serial", None, (12, 11, 13)))
        for ranks in (2, 4):
            case = self.case("cut%d" % ranks, None, (12, 11, 13))
            dictionary = "numberOfSubdomains %d; method simple; simpleCoeffs { n (1 1 %d); delta 0.001; }" % (ranks, ranks)
            case.write("system/electric/decomposeParDict", dictionary)
            # decomposePar, unlike himFoam, wants these files.
            case.write("system/electric/fvSchemes", "gradSchemes {} divSchemes {} laplacianSchemes {}")
            case.write("system/electric/fvSolution", "")
            case.tool("decomposePar", "-region", "electric")
            parallel = self.charges(case, ranks)
            for name, value in serial.items():
                if name != "closureError":
                    self.assertAlmostEqual(parallel[name], value, delta=1e-9 * max(abs(value), 1e-9), msg=name)

    def test_complaints_name_the_folders_of_the_region(self):
        case = self.case("missing", (4, 4, 4), (12, 11, 13))
        (case.path / "0/electric/electricPotential").unlink()
        case.write("system/electric/fvSolution", "HIM { directSolve maybe; }")
        result = case.run("-dry-run")
        self.assertEqual(result.code, 1)
        self.assertIn("system/electric/fvSolution: HIM: directSolve: unknown name `maybe`; known: auto, no.", result.text)
        case.write("system/electric/fvSolution", "")
        result = case.run("-dry-run")
        self.assertEqual(result.code, 1)
        self.assertIn("0/electric/electricPotential: there is no such field", result.text)


if __name__ == "__main__":
    unittest.main(verbosity=2)
