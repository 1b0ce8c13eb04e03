# SPDX-License-Identifier: GPL-3.0-or-later
"""A gas around a falling sphere: terminal velocity, momentum, void-fraction models, ranks, and refusals, through himFoam."""

import math
import pathlib
import re
import shutil
import tempfile
import unittest

from tiny_case import TinyCase

CASE = pathlib.Path(__file__).resolve().parents[2] / "cases/singleSettling"
TERMINAL = 1.06136          # [m/s] of 277 um polyethylene in nitrogen by Schiller and Naumann, DragLaw test
MASS = 960*math.pi/6*277e-6**3


class Gas(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.case = TinyCase.copy(CASE, folder.name)
        shutil.rmtree(self.case.path / "postProcessing", ignore_errors=True)
        self.case.replace("system/controlDict", "endTime         0.56;", "endTime         0.05;")

    def start_at(self, speed):
        self.case.replace("DEM/in.settling", "density 960", "density 960 vz %r" % -speed)

    def gas_entry(self, text):
        with open(self.case.path / "constant/gasProperties", "a") as file:
            file.write(text + "\n")

    def table(self, start="0"):
        lines = (self.case.path / "postProcessing/gas" / start / "gas.dat").read_text().splitlines()
        names = [line for line in lines if line.startswith("# Time")][0][2:].split()
        return [dict(zip(names, map(float, line.split()))) for line in lines if not line.startswith("#")]

    def run_case(self, ranks=1):
        self.case.tool("blockMesh")
        if ranks > 1:
            self.case.decompose(ranks)
        result = self.case.run(ranks=ranks)
        self.assertEqual(result.code, 0, result.text[-2000:])
        return self.table()

    def speed(self, rows, last=20):
        first, final = rows[-last], rows[-1]
        return -(final["massCentreZ"] - first["massCentreZ"])/(final["Time"] - first["Time"])

    def refused(self, *texts):
        self.case.tool("blockMesh")
        result = self.case.run("-dry-run")
        flat = " ".join(result.text.split())
        for text in texts:
            self.assertIn(text, flat, result.text[-2000:])
        self.assertEqual(result.code, 1)

    def test_a_sphere_at_its_terminal_velocity_keeps_it(self):
        self.start_at(TERMINAL)
        rows = self.run_case()
        self.assertAlmostEqual(self.speed(rows), TERMINAL, delta=0.005*TERMINAL)
        self.assertAlmostEqual(rows[-1]["forceZ"], MASS*9.81, delta=0.01*MASS*9.81)

    def test_a_mesh_across_the_axes_gives_the_same_fall(self):
        self.start_at(TERMINAL)
        self.case.tool("blockMesh")
        self.case.tool("transformPoints", "-rollPitchYaw", "(0 0 30)")
        result = self.case.run()
        self.assertEqual(result.code, 0, result.text[-2000:])
        rows = self.table()
        self.assertAlmostEqual(self.speed(rows), TERMINAL, delta=0.005*TERMINAL)
        self.assertLess(max(row["Co"] for row in rows), 0.1)

    def test_what_gas_and_particles_exchange_is_momentum_of_the_particle(self):
        self.start_at(0.2)
        rows = self.run_case()
        volume = math.pi/6*277e-6**3
        # Speed at the two ends, from the drag that the table gives, is the integral of all forces.
        fall = (rows[-1]["massCentreZ"] - rows[-2]["massCentreZ"])/5e-4 - (rows[1]["massCentreZ"] - rows[0]["massCentreZ"])/5e-4
        time = rows[-2]["Time"] - rows[0]["Time"]
        got = 0.5*(rows[-1]["gotZ"] + rows[-2]["gotZ"]) - 0.5*(rows[0]["gotZ"] + rows[1]["gotZ"])
        expected = MASS*fall + (MASS - 1.149*volume)*9.81*time
        self.assertAlmostEqual(got, expected, delta=2e-3*abs(expected))
        # The gas is ahead by the last solve only.
        ahead = rows[-1]["givenZ"] - rows[-1]["gotZ"]
        self.assertAlmostEqual(ahead, rows[-1]["forceZ"]*5e-4, delta=1e-3*rows[-1]["forceZ"]*5e-4)

    def test_solid_volume_is_kept_by_every_model(self):
        self.start_at(1.0)
        volume = math.pi/6*277e-6**3
        for model in ("centre;", "divided;", "smoothed; smoothingLength 16e-3;"):
            with self.subTest(model=model):
                text = (CASE / "constant/gasProperties").read_text().replace("divided;", model)
                (self.case.path / "constant/gasProperties").write_text(text)
                for row in self.run_case():
                    self.assertAlmostEqual(row["solidVolume"], volume, delta=1e-13*volume)

    def test_two_ranks_give_the_fall_of_one(self):
        self.start_at(0.9)
        self.case.replace("system/controlDict", "endTime         0.05;", "endTime         0.02;")
        one = self.run_case()
        two = self.run_case(ranks=2)
        self.assertAlmostEqual(self.speed(two), self.speed(one), delta=1e-6)

    def test_a_patch_without_faces_that_a_tool_left_over_changes_nothing(self):
        self.case.replace("system/controlDict", "endTime         0.05;", "endTime         0.005;")
        self.case.replace("system/blockMeshDict", "    top   { type patch;", "    left  { type patch; faces (); }\n    top   { type patch;")
        for field, condition in (("U", "noSlip;"), ("p", "fixedFluxPressure; value uniform 0;")):
            self.case.replace("0/" + field, "    floor {", "    left  { type %s }\n    floor {" % condition)
        names = self.run_case()[0].keys()
        self.assertIn("p_top", names)
        self.assertNotIn("p_left", names)

    def test_the_log_of_a_gas_without_charges_says_nothing_of_them(self):
        self.case.replace("system/controlDict", "endTime         0.05;", "endTime         0.01;")
        self.case.tool("blockMesh")
        text = self.case.run().text
        self.assertIn("Gas: deltaT", text)
        after = text[text.index("Gas: deltaT"):]
        for word in ("charge", "potential", "lectric", "omega"):
            self.assertNotIn(word, after)

    def test_a_run_that_continues_goes_on_as_the_run_that_wrote_it(self):
        """A large sphere, whose way through the cells pushes gas about: a first step that knows no void fraction before it shows."""
        self.start_at(0.9)
        self.case.replace("DEM/in.settling", "diameter 277.e-6", "diameter 8.e-3")
        self.case.replace("DEM/in.settling", "units       si", "variable startTime index 0\nunits       si")
        self.case.replace("DEM/in.settling", "create_box  1 box",
                          'if "${startTime} > 0" then "read_restart DEM/restart/${startTime}" else "create_box 1 box"')
        text = (self.case.path / "DEM/in.settling").read_text()
        for line in [line for line in text.splitlines() if line.startswith(("create_atoms", "set "))]:
            text = text.replace(line, 'if "${startTime} == 0" then "%s"' % line)
        (self.case.path / "DEM/in.settling").write_text(text)
        self.case.replace("constant/couplingProperties", "demCheckpoint   no;", "demCheckpoint yes;")
        self.case.replace("system/controlDict", "endTime         0.05;", "endTime         0.02;")
        self.case.replace("system/controlDict", "writeInterval   560;", "writeInterval   22;")  # the next step moves its sub-points
        straight = {round(row["Time"], 6): row for row in self.run_case()}
        self.case.replace("system/controlDict", "startTime       0;", "startTime       0.011;")
        result = self.case.run()
        self.assertEqual(result.code, 0, result.text[-2000:])
        continued = self.table("0.011")
        self.assertGreater(len(continued), 15)
        for row in continued:
            for name in ("deltaT", "forceZ", "massCentreZ", "smallestVoidFraction", "gasMomentumZ", "particleMomentumZ"):
                self.assertEqual(row[name], straight[round(row["Time"], 6)][name], "%s at %g s" % (name, row["Time"]))

    def test_the_particles_are_a_lagrangian_cloud_of_the_gas_mesh(self):
        self.start_at(TERMINAL)
        self.case.replace("system/controlDict", "writeInterval   560;", "writeInterval   100;")
        self.case.replace("system/controlDict", "binary", "ascii")
        self.run_case()
        (particle,) = self.case.particles("0.05").values()
        self.assertAlmostEqual(particle["U"][2], -TERMINAL, delta=0.01*TERMINAL)

    def test_gas_may_come_back_in_where_the_pressure_is_given(self):
        """inletOutlet says that it fixes a value; with a given pressure it only says what comes in."""
        self.start_at(TERMINAL)
        text = (self.case.path / "0/U").read_text()
        self.case.replace("0/U", re.search(r"top\s*{[^}]*}", text).group(), "top { type inletOutlet; inletValue uniform (0 0 0); value uniform (0 0 0); }")
        self.assertAlmostEqual(self.speed(self.run_case()), TERMINAL, delta=0.005*TERMINAL)

    def test_sides_may_let_the_gas_slip(self):
        self.start_at(TERMINAL)
        self.case.replace("0/U", "sides { type noSlip; }", "sides { type slip; }")
        self.assertAlmostEqual(self.speed(self.run_case()), TERMINAL, delta=0.005*TERMINAL)

    def test_a_bed_without_electrostatics_may_keep_walls_and_a_charging_fix_that_moves_nothing(self):
        self.start_at(TERMINAL)
        self.case.replace("DEM/in.settling", "atom_style  granular", "atom_style  hybrid granular charge")
        self.case.replace("DEM/in.settling", "tangential history", "tangential history cohesion charge")
        wall = "fix floor all wall/gran model hertz tangential history cohesion charge primitive type 1 zplane 0\n"
        self.case.replace("DEM/in.settling", "fix g all", wall + "fix tribo all charge/gran/contact pair 1 1 none\nfix g all")
        self.case.replace("constant/couplingProperties", "demScript", "walls { floor glass; }\ndemScript")
        self.run_case()
        self.case.replace("DEM/in.settling", "pair 1 1 none", "pair 1 1 gamma 0 kappa 1")
        self.refused("the case has no constant/electrostaticProperties")

    def test_a_particle_that_leaves_the_mesh_is_named_with_its_place(self):
        self.case.replace("DEM/in.settling", "single 0.0005 0.0003 0.63", "single 0.0005 0.0003 0.6395")
        self.start_at(-0.6)
        self.case.tool("blockMesh")
        result = self.case.run()
        flat = " ".join(result.text.split())
        self.assertNotEqual(result.code, 0)
        self.assertIn("1 particle(s) are outside the mesh of the gas, among them particle 1 at (0.0005 0.0003 0.640", flat)

    def test_refuses_a_gas_without_a_void_fraction_model(self):
        self.case.replace("constant/gasProperties", "voidFraction    divided;", "")
        self.refused("constant/gasProperties: voidFraction: the entry is missing. Write one of: centre, divided, smoothed.")

    def test_refuses_an_unknown_drag_law_by_listing_the_known(self):
        self.case.replace("constant/gasProperties", "SchillerNaumann", "Stokes")
        self.refused("drag: unknown name `Stokes`; known: WenYu, SchillerNaumann, Gidaspow, Beetstra, DiFelice, KochHill")

    def test_refuses_a_patch_where_neither_velocity_nor_pressure_is_given(self):
        self.case.replace("0/U", "floor { type noSlip; }", "floor { type zeroGradient; }")
        self.refused("0/U: floor: found zeroGradient for the velocity and fixedFluxPressure for the pressure")

    def test_refuses_a_pressure_that_does_not_follow_a_given_velocity(self):
        self.case.replace("0/p", "floor { type fixedFluxPressure; value uniform 0; }", "floor { type zeroGradient; }")
        self.refused("0/p: floor: found zeroGradient", "fixedFluxPressure")

    def test_refuses_a_gas_step_below_the_dem_step(self):
        self.case.replace("system/controlDict", "deltaT          5e-4;", "deltaT          5e-6;")
        self.refused("deltaT: found 5e-06 s, but the DEM takes steps of 1e-05 s")

    def test_refuses_a_particle_larger_than_the_stated_share_of_a_cell(self):
        self.case.replace("constant/gasProperties", "divided;", "centre; largestParticle 0.01;")
        self.refused("the largest particle, 0.000277 m, is 0.0346 times the smallest cell, 0.008 m")

    def test_refuses_a_velocity_and_a_pressure_that_are_both_given(self):
        self.case.replace("0/p", "floor { type fixedFluxPressure; value uniform 0; }", "floor { type fixedValue; value uniform 0; }")
        self.refused("0/p: floor: found fixedValue, but 0/U gives the velocity there by noSlip")

    def test_refuses_bounds_of_the_gas_step_that_cannot_be_kept(self):
        self.gas_entry("adjustTimeStep yes; maxDeltaT 4e-4;")
        self.refused("system/controlDict: deltaT: found 0.0005 s for the first gas step", "allows 0.0004 s")
        self.case.replace("constant/gasProperties", "maxDeltaT 4e-4;", "maxDeltaT 5e-6;")
        self.refused("maxDeltaT: the largest gas step 5e-06 s is below the DEM step 1e-05 s")

    def test_refuses_a_bound_that_only_an_adjusted_step_reads(self):
        self.gas_entry("maxCo 0.3;")
        self.refused("maxCo: only adjustTimeStep yes reads it")

    def test_refuses_iterations_that_would_not_solve_anything_and_entries_that_nothing_reads(self):
        self.case.replace("system/fvSolution", "nOuterCorrectors 2; nCorrectors 2;",
                          "nOuterCorrectors 0; nCorrectors none; momentumPredictor yes; pRefCell 100000;")
        self.refused("system/fvSolution: PIMPLE: nOuterCorrectors: found 0", "nCorrectors: found `none`", "momentumPredictor",
                     "pRefCell: found 100000, but the rank has")

    def test_refuses_settings_without_meaning(self):
        for entry, text in (("smallestVoidFraction 1;", "smallestVoidFraction: found 1"), ("virtualMass -0.5;", "virtualMass: found -0.5")):
            self.gas_entry(entry)
            self.refused(text)

    def test_refuses_a_viscosity_that_is_not_positive(self):
        self.case.replace("constant/gasProperties", "viscosity       1.766e-5;", "viscosity       -1;")
        self.refused("constant/gasProperties: viscosity: found -1, but a number above zero is expected")


if __name__ == "__main__":
    unittest.main(verbosity=2)
