# SPDX-License-Identifier: GPL-3.0-or-later
"""Every kind of bad input ends the run with exit code 1 and a message that says where, what was found and what to do."""

import shutil
import unittest

from tiny_case import SoundCaseTests

ELECTROSTATIC = "constant/electrostaticProperties"
COUPLING = "constant/couplingProperties"
POTENTIAL = "0/electricPotential"
SCRIPT = "DEM/in.cube"


class BadInput(SoundCaseTests):
    def refused(self, *texts, options=("-dry-run",), ranks=1):
        result = self.case.run(*options, ranks=ranks)
        flat = " ".join(result.text.split())
        for text in texts:
            self.assertIn(text, flat, result.text)
        self.assertEqual(result.code, 1, result.text)
        return result

    # --- nothing is wrong

    def test_a_sound_case_passes_the_dry_run_without_a_step(self):
        result = self.case.run("-dry-run")
        self.assertEqual(result.code, 0, result.text)
        self.assertIn("the case is fine", result.text)
        self.assertNotIn("Time = ", result.text)

    def test_the_field_at_contact_points_needs_the_pair_sum_and_has_to_count(self):
        self.case.replace(SCRIPT, "area hertz", "area hertz wallField atContactPoint")
        for method in ("him", "himCell"):
            if method == "himCell":
                self.case.replace(ELECTROSTATIC, "fieldMethod him;", "fieldMethod himCell; himCellCoeffs { deltaMin 0.02; }")
            self.refused("DEM script: wallField: atContactPoint needs the field of the others where no particle's centre is, and %s gives "
                         "fields at centres only. pairwiseSum and p3m have it" % method)
        self.case.replace(COUPLING, "wallContactField total;", "wallContactField self;")
        self.refused("wallContactField: self leaves the field of the others out at walls")

    # --- stage 1: dictionaries, mesh and fields

    def test_missing_dictionary(self):
        (self.case.path / ELECTROSTATIC).unlink()
        self.refused("constant/electrostaticProperties: there is no such file")

    def test_dictionary_that_cannot_be_parsed(self):
        self.case.replace(COUPLING, "walls {", "walls {{")
        self.refused("constant/couplingProperties: cannot be parsed")

    def test_missing_entry(self):
        self.case.replace(ELECTROSTATIC, "fieldMethod him;", "")
        self.refused("constant/electrostaticProperties: fieldMethod: the entry is missing")

    def test_wrong_type(self):
        self.case.replace(ELECTROSTATIC, "externalField (0 0 1000);", "externalField 1000;")
        self.refused("externalField: found `1000`, but a vector like (0 0 1e5) is expected")

    def test_a_word_in_place_of_a_number(self):
        self.case.replace(ELECTROSTATIC, "himCoeffs { nearCutoff 0.02; }", "himCoeffs { nearCutoff large; }")
        self.refused("himCoeffs: nearCutoff: found `large`, but a number above zero is expected")

    def test_a_number_too_large_for_a_double(self):
        self.case.replace(ELECTROSTATIC, "relativePermittivity 1;", "relativePermittivity 1e400;")
        self.refused("constant/electrostaticProperties: cannot be parsed", "at keyword 'relativePermittivity' on line 6")

    def test_two_values_in_place_of_one(self):
        self.case.replace(ELECTROSTATIC, "relativePermittivity 1;", "relativePermittivity 1 2;")
        self.refused("relativePermittivity: found `1 2`, but a number above zero is expected")

    def test_negative_cutoff(self):
        self.case.replace(ELECTROSTATIC, "himCoeffs { nearCutoff 0.02; }", "himCoeffs { nearCutoff -0.02; }")
        self.refused("himCoeffs: nearCutoff: found -0.02, but a number above zero is expected")

    def test_missing_cutoff(self):
        self.case.replace(ELECTROSTATIC, "himCoeffs { nearCutoff 0.02; }", "himCoeffs {}")
        self.refused("himCoeffs: nearCutoff: the entry is missing")

    def test_unknown_method_lists_the_known_ones(self):
        self.case.replace(ELECTROSTATIC, "fieldMethod him;", "fieldMethod hum;")
        self.refused("fieldMethod: unknown name `hum`; known: pairwiseSum, directTruncation, hybridParticleCell, him, himCell, p3m.")

    def test_misspelt_entry_lists_the_known_ones(self):
        self.case.replace(ELECTROSTATIC, "externalField", "externalFeild")
        self.refused("externalFeild: unknown entry; known: accuracy, fieldMethod, externalField, relativePermittivity")

    def test_unknown_choice_lists_the_known_ones(self):
        self.case.replace(COUPLING, "wallContactField total;", "wallContactField all;")
        self.refused("wallContactField: unknown name `all`; known: total, self.")

    def test_cutoff_below_the_cell_diagonal_gives_both_numbers(self):
        self.case.replace(ELECTROSTATIC, "himCoeffs { nearCutoff 0.02; }", "himCoeffs { nearCutoff 0.01; }")
        self.refused("himCoeffs: nearCutoff: 0.01 m is below the largest cell diagonal, 0.0173205 m. Pairs inside one cell "
                     "would be missed. Use at least 0.0173205, or refine the mesh.")

    def test_cutoff_equal_to_the_cell_diagonal_is_accepted(self):
        self.case.replace(ELECTROSTATIC, "himCoeffs { nearCutoff 0.02; }", "himCoeffs { nearCutoff 0.017320508075688773; }")
        self.assertEqual(self.case.run("-dry-run").code, 0)

    def test_unknown_patch_lists_the_patches(self):
        self.case.replace(COUPLING, "floor bottom;", "floor buttom;")
        self.refused("walls: floor: unknown target `buttom`; known: the patches bottom, top, sides, and noTransfer.")

    def test_wall_on_a_patch_without_a_voltage(self):
        self.case.replace(POTENTIAL, "bottom { type fixedValue; value uniform 0; }", "bottom { type zeroGradient; }")
        self.refused("walls: floor: the potential on patch bottom is zeroGradient, which does not fix a voltage")

    def test_missing_mesh(self):
        shutil.rmtree(self.case.path / "constant/polyMesh")
        self.refused("constant/polyMesh: there is no mesh")

    def test_flat_mesh(self):
        self.case.replace("system/blockMeshDict", "top    { type wall;", "top    { type empty;")
        self.case.replace("system/blockMeshDict", "bottom { type wall;", "bottom { type empty;")
        self.case.replace("system/blockMeshDict", "(10 10 10)", "(10 10 1)")
        self.case.tool("blockMesh")
        self.refused("constant/polyMesh/boundary: bottom: found a patch of type empty. Charges are points in three dimensions")

    def test_missing_potential(self):
        (self.case.path / POTENTIAL).unlink()
        self.refused("0/electricPotential: there is no such field")

    def test_potential_without_one_of_the_patches(self):
        self.case.replace(POTENTIAL, "top { type fixedValue; value uniform 0; }", "")
        self.refused("0/electricPotential: Cannot find patchField entry for top")

    def test_potential_in_other_units(self):
        self.case.replace(POTENTIAL, "[1 2 -3 0 0 -1 0]", "[0 1 -1 0 0 0 0]")
        self.refused("0/electricPotential: dimensions: found other units than volt")

    def test_solver_entry_without_a_solver(self):
        self.case.replace("system/fvSolution", "solver PCG;", "")
        self.refused("system/fvSolution: solvers: electricPotential: solver: the entry is missing")

    def test_unknown_solver_lists_the_known_ones(self):
        self.case.replace("system/fvSolution", "solver PCG;", "solver PGC;")
        self.refused("solvers: electricPotential: solver: unknown name `PGC`; known: GAMG, PBiCGStab, PCG, smoothSolver.")

    def test_unknown_gradient_scheme(self):
        self.case.replace("system/fvSchemes", "gradSchemes { default Gauss linear; }", "gradSchemes { default Gaus; }")
        self.refused("system/fvSchemes: gradSchemes: Unknown grad type Gaus")

    def test_unknown_laplacian_scheme_lists_the_known_ones(self):
        self.case.replace("system/fvSchemes", "Gauss linear corrected;", "Gauss linear faceCorrected;")
        self.refused("system/fvSchemes: laplacianSchemes: laplacian(electricPotential): found `Gauss linear faceCorrected`",
                     "corrected, uncorrected, orthogonal, limited <number>")

    def test_time_step_of_zero(self):
        self.case.replace("system/controlDict", "deltaT 1e-3;", "deltaT 0;")
        self.refused("system/controlDict: deltaT: found 0, but a number above zero is expected")

    def test_missing_script(self):
        (self.case.path / SCRIPT).unlink()
        self.refused("couplingProperties: demScript: there is no file", "DEM/in.cube")

    def test_everything_of_the_first_stage_is_reported_together(self):
        self.case.replace("system/controlDict", "deltaT 1e-3;", "deltaT -1;")
        self.case.replace(ELECTROSTATIC, "himCoeffs { nearCutoff 0.02; }", "himCoeffs { nearCutoff -0.02; }")
        self.case.replace(COUPLING, "particlesOutsideMesh error;", "particlesOutsideMash error; demCheckpoint often;")
        (self.case.path / SCRIPT).unlink()
        result = self.refused("deltaT: found -1", "nearCutoff: found -0.02", "particlesOutsideMash: unknown entry",
                              "demCheckpoint: found `often`, but yes or no is expected", "demScript: there is no file")
        self.assertIn("5. ", result.text)
        self.assertNotIn("6. ", result.text)

    # --- stage 2: LIGGGHTS

    def test_the_message_of_liggghts_is_visible_in_a_file(self):
        self.case.replace(SCRIPT, "pair_coeff * *", "pair_coefficients * *")
        self.refused("LIGGGHTS reads", "Unknown command: pair_coefficients * *", "The script line was: pair_coefficients * *")

    def test_negative_radius(self):
        self.case.replace(SCRIPT, "set atom 1 diameter 0.004", "set atom 1 diameter -0.004")
        self.refused("ERROR", "The script line was: set atom 1 diameter -0.004")

    # --- stage 3: case and scene together

    def test_missing_gamma(self):
        self.case.replace(SCRIPT, "pair 1 2 gamma -7.67e5 kappa 20.0 ", "")
        self.refused("gamma")

    def test_negative_kappa(self):
        self.case.replace(SCRIPT, "kappa 20.0", "kappa -20.0")
        self.refused("kappa")

    def test_unmapped_wall(self):
        self.case.replace(COUPLING, "lid noTransfer;", "")
        self.refused("walls: the DEM wall(s) lid are not in the table. Map each one to a patch or to noTransfer.")

    def test_mapped_wall_that_the_scene_lacks(self):
        self.case.replace(COUPLING, "lid noTransfer;", "lid noTransfer; roof noTransfer;")
        self.refused("walls: roof: the DEM script has no wall of this name; it has: floor, lid.")

    def test_field_update_that_is_no_multiple_of_the_dem_step(self):
        self.case.replace("system/controlDict", "deltaT 1e-3;", "deltaT 1.004e-3;")
        self.refused("system/controlDict: deltaT: 0.001004 s is not a multiple of the DEM time step, 1e-05 s",
                     "The nearest allowed deltaT is 0.001.")

    def test_field_update_shorter_than_the_dem_step(self):
        self.case.replace("system/controlDict", "deltaT 1e-3;", "deltaT 1e-6;")
        self.refused("The nearest allowed deltaT is 1e-05.")

    def test_particle_outside_the_mesh(self):
        self.case.replace("system/blockMeshDict", "(0 0 1) (1 0 1) (1 1 1) (0 1 1)", "(0 0 0.7) (1 0 0.7) (1 1 0.7) (0 1 0.7)")
        self.case.tool("blockMesh")
        self.refused("2 particle(s) lie outside the mesh: particle 4 at (0.0268 0.0339 0.0724) m, particle 5 at "
                     "(0.0723 0.0719 0.0746) m", "particlesOutsideMesh excluded")

    def test_particle_outside_the_mesh_may_be_excluded(self):
        self.case.replace("system/blockMeshDict", "(0 0 1) (1 0 1) (1 1 1) (0 1 1)", "(0 0 0.7) (1 0 0.7) (1 1 0.7) (0 1 0.7)")
        self.case.tool("blockMesh")
        self.case.replace(COUPLING, "particlesOutsideMesh error;", "particlesOutsideMesh excluded;")
        result = self.case.run()
        self.assertEqual(result.code, 0, result.text)
        self.assertIn("outside the mesh 2 particle(s) with -5e-10 C", result.text)

    def test_mesh_and_dem_box_apart(self):
        self.case.replace("system/blockMeshDict", "scale 0.1;", "scale 100;")
        self.case.replace("system/blockMeshDict", "(0 0 0) (1 0 0) (1 1 0) (0 1 0) (0 0 1) (1 0 1) (1 1 1) (0 1 1)",
                          "(1 1 1) (2 1 1) (2 2 1) (1 2 1) (1 1 2) (2 1 2) (2 2 2) (1 2 2)")
        self.case.replace(ELECTROSTATIC, "himCoeffs { nearCutoff 0.02; }", "himCoeffs { nearCutoff 20; }")
        self.case.tool("blockMesh")
        self.refused("constant/polyMesh: the mesh, (100 100 100) to (200 200 200) m, and the DEM box", "do not overlap")

    def test_charge_without_a_fixed_voltage(self):
        text = (self.case.path / POTENTIAL).read_text()
        (self.case.path / POTENTIAL).write_text(text.replace("type fixedValue; value uniform 0;", "type zeroGradient;"))
        self.case.replace(COUPLING, "floor bottom;", "floor noTransfer;")
        self.refused("electricPotential: no patch fixes the voltage, but the particles carry a net charge of 1.8e-09 C")

    def test_discs(self):
        # A wall without contact charging: the charging fix would refuse before himFoam's own check.
        text = (self.case.path / SCRIPT).read_text().replace("units si", "units si\ndimension 2").replace("boundary f f f", "boundary f f p")
        text = "\n".join(line for line in text.replace(" cohesion charge", "").splitlines() if not line.startswith("fix tribo"))
        (self.case.path / SCRIPT).write_text(text)
        self.refused("'dimension 2' found, which makes discs of unit length", "fix constrain/plane")

    def test_spheres_in_a_plane_with_a_method_that_has_a_mesh(self):
        text = "\n".join(line for line in (self.case.path / SCRIPT).read_text().splitlines()
                         if not line.startswith(("create_atoms", "set atom")))
        text += "\ncreate_atoms 1 single 0.05 0.05 0.05 units box\nset atom 1 diameter 0.004 density 2000\n"
        (self.case.path / SCRIPT).write_text(text + "fix flat all constrain/plane normal 0 1 0 point 0 0.05 0\n")
        self.refused("constant/electrostaticProperties: fieldMethod: him has a mesh, but the DEM script confines spheres to the plane",
                     "Use pairwiseSum or directTruncation")
        self.case.replace(ELECTROSTATIC, "fieldMethod him;", "fieldMethod pairwiseSum;")
        self.case.replace(COUPLING, "floor bottom;", "floor grounded;")
        self.assertEqual(self.case.run("-dry-run").code, 0)

    def test_everything_of_the_last_stage_is_reported_together(self):
        self.case.replace("system/controlDict", "deltaT 1e-3;", "deltaT 1.004e-3;")
        self.case.replace(COUPLING, "lid noTransfer;", "roof noTransfer;")
        self.refused("1. ", "not a multiple", "wall(s) lid are not in the table", "no wall of this name")

    # --- during the run

    def test_solver_that_does_not_converge(self):
        self.case.replace("system/fvSolution", "maxIter 2000;", "maxIter 2;")
        self.refused("the potential did not converge: DICPCG stopped after 2 iterations",
                     "solvers.electricPotential of system/fvSolution", options=())

    # --- in parallel

    def test_complaints_of_two_ranks_come_once_and_do_not_hang(self):
        self.case.decompose(2)
        self.case.replace("system/controlDict", "deltaT 1e-3;", "deltaT 1.004e-3;")
        self.case.replace(COUPLING, "lid noTransfer;", "")
        result = self.refused("not a multiple", "wall(s) lid are not in the table", ranks=2)
        self.assertEqual(result.text.count("is not a multiple"), 1, result.text)

    def test_mesh_cut_into_another_number_of_parts(self):
        self.case.decompose(2)
        self.refused("the mesh is cut into 2 parts, but the run has 3 ranks", ranks=3)

    def test_broken_dictionary_in_parallel(self):
        self.case.decompose(2)
        self.case.replace("system/fvSolution", "solvers {", "solvers {{")
        self.refused("system/fvSolution: cannot be parsed", ranks=2)


if __name__ == "__main__":
    unittest.main(verbosity=2)
