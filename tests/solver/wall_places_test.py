# SPDX-License-Identifier: GPL-3.0-or-later
"""DEM walls that lie off the walls of the meshes of field and gas are refused before the run."""

import pathlib
import re
import shutil
import unittest

from round_walls_test import RADIUS, o_grid
from tiny_case import CaseTests, TinyCase
from wall_charge_carriers_test import with_plate

COUPLING = "constant/couplingProperties"
CYLINDER = "fix floor all wall/gran model hertz tangential history cohesion charge primitive type 2 zcylinder %r %r 0.\n"
SETTLING = pathlib.Path(__file__).resolve().parents[2] / "cases/singleSettling"


class WallPlaces(CaseTests):
    def accepted(self, case):
        result = case.run("-dry-run")
        self.assertEqual(result.code, 0, result.text)


class GroundedWalls(WallPlaces):
    def floor_at(self, height, entry=""):
        """Spheres above a floor at some height over the grounded bottom of the mesh; faces of 10 mm."""
        spheres = [((0.03, 0.03, 0.06), (0., 0., 0.), 1e-9), ((0.07, 0.03, 0.06), (0., 0., 0.), -1e-9)]
        case = TinyCase("%s/%r%s" % (self.folder, height, len(entry)), particles=spheres)
        case.replace("DEM/in.cube", "zplane 0.0\n", "zplane %r\n" % height)
        case.replace(COUPLING, "wallContactField", entry + " wallContactField")
        return case

    def test_a_plane_off_its_patch_is_refused(self):
        self.refused(self.floor_at(0.02), "constant/couplingProperties: walls: floor: the DEM wall lies off patch bottom of the mesh by 0.02 m, "
                     "more than wallDistance, 0.001 m (unless given, a tenth of the edge of the mean face)")
        self.refused(self.floor_at(0.0011), "by 0.0011 m")
        self.accepted(self.floor_at(0.0009))

    def test_it_stands_where_the_case_says_so(self):
        self.accepted(self.floor_at(0.02, "wallDistance 0.021;"))
        self.refused(self.floor_at(0.02, "wallDistance 0.019;"), "by 0.02 m, more than wallDistance, 0.019 m,")

    def test_a_plane_across_its_patch_is_refused(self):
        case = self.floor_at(0.0)
        case.replace(COUPLING, "floor bottom;", "floor sides;")
        self.refused(case, "the DEM wall lies off patch sides of the mesh altogether (no face looks its way)")

    def test_the_nearest_of_parallel_faces_counts(self):
        case = self.floor_at(0.0)
        case.replace("DEM/in.cube", "zplane 0.0\n", "xplane 0.1\n")
        case.replace(COUPLING, "floor bottom;", "floor sides;")
        self.accepted(case)

    def test_walls_without_transfer_may_stand_anywhere(self):
        case = self.floor_at(0.02)
        case.replace(COUPLING, "floor bottom;", "floor noTransfer;")
        self.accepted(case)

    def test_mesh_walls_are_compared_with_all_patches_that_have_a_voltage(self):
        self.accepted(with_plate(self.floor_at(0.0), 0.0))
        self.refused(with_plate(self.floor_at(0.01), 0.01),
                     "walls: floor: the DEM wall lies off the patches with a voltage of the mesh by 0.01 m, more than wallDistance, 0.001 m")
        below = with_plate(self.floor_at(0.02), -0.02)
        below.replace("DEM/in.cube", "block -0.001 0.101 -0.001 0.101 -0.001 0.101", "block -0.001 0.101 -0.001 0.101 -0.03 0.101")
        self.refused(below, "of the mesh altogether")

    def tube(self, name, radius, centre=0.0):
        """A DEM cylinder in the mesh of one with 24 flat faces around."""
        case = TinyCase("%s/%s" % (self.folder, name), particles=[((0., 0., 0.), (0., 0., 0.), 1e-9)])
        case.write("system/blockMeshDict", o_grid(2, 6))
        case.tool("blockMesh")
        text = (case.path / "0/electricPotential").read_text()
        (case.path / "0/electricPotential").write_text(text.replace("top { type fixedValue; value uniform 0; }", ""))
        text = (case.path / "DEM/in.cube").read_text()
        text = re.sub("fix lid .*\n", "", re.sub("fix floor .*\n", CYLINDER % (radius, centre), text))
        (case.path / "DEM/in.cube").write_text(text.replace("block -0.001 0.101 -0.001 0.101 -0.001 0.101", "block" + 3 * " -0.06 0.06"))
        case.replace(COUPLING, "floor bottom; lid noTransfer;", "floor sides;")
        case.replace("constant/electrostaticProperties", "himCoeffs { nearCutoff 0.02; }", "himCoeffs { nearCutoff 0.04; }")
        return case

    def test_a_cylinder_on_the_flat_faces_around_it_is_accepted_and_another_is_not(self):
        self.accepted(self.tube("on", RADIUS))
        self.refused(self.tube("wide", RADIUS + 0.005), "walls: floor: the DEM wall lies off patch sides of the mesh by 0.005 m")
        self.refused(self.tube("beside", RADIUS, 0.004), "walls: floor: the DEM wall lies off patch sides of the mesh by 0.00")


class GasWalls(WallPlaces):
    """The sphere of cases/singleSettling, with walls of the DEM scene. Mesh 40 x 40 x 640 mm of 8 mm cells; the top is open."""

    def case(self, wall, entry=""):
        case = TinyCase.copy(SETTLING, "%s/%s%d" % (self.folder, wall.replace(" ", ""), len(entry)))
        shutil.rmtree(case.path / "postProcessing", ignore_errors=True)
        case.tool("blockMesh")
        case.replace("DEM/in.settling", "fix g all",
                     "fix wall all wall/gran model hertz tangential history primitive type 1 %s\nfix g all" % wall)
        case.replace(COUPLING, "demScript", entry + "demScript")
        return case

    def test_a_plane_off_the_wall_of_the_gas_is_refused(self):
        self.accepted(self.case("zplane 0"))
        self.refused(self.case("zplane 0.02"), "DEM wall wall: it lies off the walls at which the gas's mesh ends in the same direction by "
                     "0.02 m, more than wallDistance, 0.0008 m (unless given, a tenth of the edge of the mean face)")
        self.refused(self.case("yplane -0.018"), "DEM wall wall: it lies off the walls", "by 0.002 m")
        self.accepted(self.case("yplane -0.018", "wallDistance 0.003; "))

    def test_a_plane_before_an_open_end_is_a_sieve(self):
        self.accepted(self.case("zplane 0.6"))


if __name__ == "__main__":
    unittest.main(verbosity=2)
