# SPDX-License-Identifier: GPL-3.0-or-later
"""What himFoam makes of DEM scenes: which it refuses by name, what may leave, appear or be left out."""

import tempfile
import unittest

from tiny_case import PARTICLES, TinyCase

FIX = "fix tribo all charge/gran/contact pair 1 1 gamma 0 kappa 3600 pair 1 2 gamma -7.67e5 kappa 20.0 area hertz\n"
UPWARDS = ((0.05, 0.02, 0.09), (0.0, 0.0, 30.0), 3e-9)   # leaves through the lid of the box


class Scene(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def case(self, method="pairwiseSum", particles=None, until=2e-3):
        case = TinyCase(self.folder, method, particles=particles)
        case.replace("system/controlDict", "endTime 2e-3;", "endTime %r;" % until)
        return case

    def script(self, case, old, new):
        case.replace("DEM/in.cube", old, new)

    def fails(self, case, *texts):
        result = case.run()
        self.assertNotEqual(result.code, 0, result.text[-1500:])
        for text in texts:
            self.assertIn(text, result.text)

    def runs(self, case, ranks=1):
        result = case.run(ranks=ranks)
        self.assertEqual(result.code, 0, result.text[-1500:])
        return result.text

    def test_coarse_grained_particles_are_refused_by_name(self):
        # The packaged LIGGGHTS does not know the command; LiggghtsDem::check() refuses it where it exists.
        case = self.case()
        self.script(case, "atom_modify map array", "atom_modify map array\ncoarsegraining 2")
        self.fails(case, "coarsegraining")

    def test_multisphere_particles_are_refused_by_name(self):
        case = self.case()
        self.script(case, "fix move all nve/sphere", """fix pt all particletemplate/multisphere 15485863 atom_type 1 density constant 2000 &
    nspheres 2 ntry 100000 spheres 0 0 0 0.002 0.002 0 0 0.002 type 1
fix pd all particledistribution/discrete 15485867 1 pt 1.0
fix move all multisphere""")
        self.fails(case, "multisphere particles found; only single spheres carry charge here. Remove 'fix multisphere'.")

    def test_superquadric_particles_are_refused_by_name(self):
        case = self.case()
        self.script(case, "atom_style hybrid granular charge", "atom_style hybrid superquadric charge")
        self.fails(case, "superquadric")

    def test_other_units_are_refused_by_name(self):
        case = self.case()
        self.script(case, FIX, "")
        self.script(case, "units si", "units cgs")
        for wall in (" cohesion charge\npair_coeff", " cohesion charge primitive type 2 zplane 0.0",
                     " cohesion charge primitive type 2 zplane 0.1"):
            self.script(case, wall, wall.replace(" cohesion charge", ""))
        self.fails(case, "units 'cgs' found; himFoam works in SI only. Write 'units si'.")

    def test_a_scene_without_charging_needs_no_charging_model_and_keeps_every_charge(self):
        case = self.case()
        self.script(case, FIX, "")
        for wall in (" cohesion charge\npair_coeff", " cohesion charge primitive type 2 zplane 0.0",
                     " cohesion charge primitive type 2 zplane 0.1"):
            self.script(case, wall, wall.replace(" cohesion charge", ""))
        self.runs(case)
        _, rows = case.charge_table()
        self.assertEqual(rows[-1]["max"], 2.5e-9)
        self.assertEqual(rows[-1]["min"], -2e-9)
        self.assertEqual(rows[-1]["floor"], 0)

    def test_a_wall_without_transfer_takes_no_charge(self):
        case = self.case()
        case.replace("constant/couplingProperties", "floor grounded", "floor noTransfer")
        self.runs(case)
        self.assertEqual(case.charge_table()[1][-1]["floor"], 0)

    def test_a_run_before_the_hand_over_moves_particles_without_charge_and_says_so(self):
        case = self.case()
        self.script(case, "thermo 100000\n", "thermo 100000\nrun 300\n")
        text = self.runs(case)
        self.assertIn("hand-over", text)
        _, rows = case.charge_table()
        self.assertAlmostEqual(rows[0]["total"], sum(charge for _, _, charge in PARTICLES), delta=1e-22)
        self.assertEqual(rows[0]["max"], 2.5e-9)
        self.assertEqual(rows[0]["floor"], 0)

    def test_a_lost_particle_stops_the_run_and_is_named_with_place_and_speed(self):
        case = self.case(particles=PARTICLES + [UPWARDS], until=4e-3)
        self.script(case, "fix lid all wall/gran model hertz tangential history cohesion charge primitive type 2 zplane 0.1\n", "")
        case.replace("constant/couplingProperties", "lid noTransfer;", "")
        self.fails(case, "missing: particle 9, last at (0.05", "Check the DEM `timestep`")

    def test_a_particle_that_may_leave_takes_its_charge_out_of_the_books(self):
        for ranks in (1, 2):
            case = self.case(particles=PARTICLES + [UPWARDS], until=4e-3)
            self.script(case, "fix lid all wall/gran model hertz tangential history cohesion charge primitive type 2 zplane 0.1\n", "")
            case.replace("constant/couplingProperties", "lid noTransfer; }", "}\nallowRemovals yes;")
            self.runs(case, ranks)
            _, rows = case.charge_table()
            with self.subTest(ranks=ranks):
                self.assertAlmostEqual(rows[-1]["removed"], 3e-9, delta=1e-21)
                self.assertAlmostEqual(rows[-1]["closureError"], 0, delta=1e-20)

    def test_particles_that_appear_during_the_run_enter_the_books(self):
        case = self.case(until=5e-3)
        self.script(case, "fix move all", """group fresh region box
region top block 0.01 0.09 0.01 0.09 0.085 0.095 units box
fix pt all particletemplate/sphere 15485863 atom_type 1 density constant 2000 radius constant 0.002
fix pd all particledistribution/discrete 15485867 1 pt 1.0
fix ins all insert/pack seed 32452843 distributiontemplate pd vel constant 0. 0. -0.5 insert_every 200 overlapcheck yes &
    all_in yes particles_in_region 5 region top
fix move all""")
        text = self.runs(case)
        self.assertRegex(text, "particles +13\n")   # 8, and 5 that were inserted
        _, rows = case.charge_table()
        self.assertEqual(rows[-1]["inserted"], 0)   # a particle appears without charge
        self.assertAlmostEqual(rows[-1]["closureError"], 0, delta=1e-20)


if __name__ == "__main__":
    unittest.main(verbosity=2)
