# SPDX-License-Identifier: GPL-3.0-or-later
"""A tiny case for himFoam: eight charged spheres in a grounded cube of 0.1 m, with or without a mesh of 10 x 10 x 10 cells.

The folder of the programs is taken from the environment variable HIMFOAM_BIN, which ctest sets.
"""

import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

SIZE = 0.1  # [m]

# position [m], velocity [m/s], charge [C] of the spheres with tags 1, 2, ...; the last two are about to hit the floor and
# the sphere before them
PARTICLES = [
    ((0.0231, 0.0312, 0.0214), (0.3, -0.1, 0.2), 1e-9),
    ((0.0742, 0.0263, 0.0317), (-0.2, 0.2, 0.1), -2e-9),
    ((0.0317, 0.0728, 0.0286), (0.1, 0.1, -0.2), 1.5e-9),
    ((0.0268, 0.0339, 0.0724), (-0.1, 0.3, 0.2), 0.5e-9),
    ((0.0723, 0.0719, 0.0746), (0.2, -0.2, -0.1), -1e-9),
    ((0.0514, 0.0527, 0.0483), (0.1, 0.2, 0.3), 2.5e-9),
    ((0.0514, 0.0527, 0.0524), (0.1, 0.2, -0.3), -0.5e-9),
    ((0.0639, 0.0471, 0.0021), (0.1, 0.1, -0.5), -0.2e-9),
]

HEADER = "FoamFile {{ version 2.0; format ascii; class {}; object {}; }}\n"

CONTROL = """
application himFoam;
startFrom startTime; startTime 0; stopAt endTime;
endTime 2e-3; deltaT 1e-3;
writeControl timeStep; writeInterval 2;
writeFormat ascii; writePrecision 16; timePrecision 8; runTimeModifiable false;
"""

SCHEMES = """
ddtSchemes { default none; }
gradSchemes { default Gauss linear; }
divSchemes { default none; }
laplacianSchemes { default Gauss linear corrected; }
interpolationSchemes { default linear; }
snGradSchemes { default corrected; }
"""

SOLUTION = """
solvers { electricPotential { solver PCG; preconditioner DIC; tolerance 1e-13; relTol 0; maxIter 2000; } }
HIM { nNonOrthogonalCorrectors 0; directSolve no; }
"""

BLOCK_MESH = """
scale %(size)g;
vertices ((0 0 0) (1 0 0) (1 1 0) (0 1 0) (0 0 1) (1 0 1) (1 1 1) (0 1 1));
blocks (hex (0 1 2 3 4 5 6 7) (%(cells)s) simpleGrading (1 1 1));
boundary
(
    bottom { type wall; faces ((0 3 2 1)); }
    top    { type wall; faces ((4 5 6 7)); }
    sides  { type wall; faces ((0 4 7 3) (1 2 6 5) (0 1 5 4) (3 7 6 2)); }
);
"""

POTENTIAL = """
dimensions [1 2 -3 0 0 -1 0];
internalField uniform 0;
boundaryField
{
    bottom { type fixedValue; value uniform 0; }
    top { type fixedValue; value uniform 0; }
    sides { type fixedValue; value uniform 0; }
}
"""

ELECTROSTATIC = """
fieldMethod %(method)s;
himCoeffs { nearCutoff 0.02; }
directTruncationCoeffs { nearCutoff 0.02; }
externalField (0 0 1000);
relativePermittivity 1;
"""

COUPLING = """
demScript "DEM/in.cube";
walls { floor %(floor)s; lid noTransfer; }
wallContactField total;
particlesOutsideMesh error;
"""

SCRIPT = """
units si
atom_style hybrid granular charge
atom_modify map array
boundary f f f
newton off
communicate single vel yes
processors * * *
region box block -0.001 0.101 -0.001 0.101 -0.001 0.101 units box
create_box 2 box
neighbor 0.002 bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype 5.e6 5.e6
fix m2 all property/global poissonsRatio peratomtype 0.45 0.45
fix m3 all property/global coefficientRestitution peratomtypepair 2 0.9 0.9 0.9 0.9
fix m4 all property/global coefficientFriction peratomtypepair 2 0.3 0.3 0.3 0.3
pair_style gran model hertz tangential history cohesion charge
pair_coeff * *
timestep 1.e-5
fix floor all wall/gran model hertz tangential history cohesion charge primitive type 2 zplane 0.0
fix lid all wall/gran model hertz tangential history cohesion charge primitive type 2 zplane 0.1
{particles}
fix tribo all charge/gran/contact pair 1 1 gamma 0 kappa 3600 pair 1 2 gamma -7.67e5 kappa 20.0 area hertz
fix move all nve/sphere
thermo 100000
"""


def particle_lines(particles, diameter):
    lines = ["create_atoms 1 single %r %r %r units box" % position for position, _, _ in particles]
    for tag, (_, velocity, charge) in enumerate(particles, 1):
        lines.append("set atom %d diameter %r density 2000 vx %r vy %r vz %r charge %r" % (tag, diameter, *velocity, charge))
    return "\n".join(lines)


class Result:
    def __init__(self, code, text):
        self.code = code
        self.text = text


class TinyCase:
    """The case in a folder of its own; change it with replace() before the run."""

    def __init__(self, folder, method="him", cells=(10, 10, 10), particles=None, diameter=0.004):
        """`cells`: of the mesh in each direction. `particles`: like PARTICLES, which is the default."""
        self.path = pathlib.Path(folder)
        mesh = method != "pairwiseSum" and method != "directTruncation"
        self.write("system/controlDict", CONTROL)
        self.write("constant/electrostaticProperties", ELECTROSTATIC % {"method": method})
        self.write("constant/couplingProperties", COUPLING % {"floor": "bottom" if mesh else "grounded"})
        self.write("DEM/in.cube", SCRIPT.format(particles=particle_lines(particles or PARTICLES, diameter)))
        if mesh:
            self.write("system/fvSchemes", SCHEMES)
            self.write("system/fvSolution", SOLUTION)
            self.write("system/blockMeshDict", BLOCK_MESH % {"size": SIZE, "cells": "%d %d %d" % cells})
            self.write("0/electricPotential", POTENTIAL, "volScalarField")
            self.tool("blockMesh")

    @classmethod
    def copy(cls, original, folder):
        """A copy of a case, which saves meshing."""
        shutil.copytree(original, folder, dirs_exist_ok=True)
        case = cls.__new__(cls)
        case.path = pathlib.Path(folder)
        return case

    def write(self, name, text, kind="dictionary"):
        file = self.path / name
        file.parent.mkdir(parents=True, exist_ok=True)
        header = "" if name.startswith("DEM/") else HEADER.format(kind, file.name)
        file.write_text(header + text)

    def replace(self, name, old, new):
        text = (self.path / name).read_text()
        if text.count(old) != 1:
            raise ValueError("%s: %r occurs %d times" % (name, old, text.count(old)))
        (self.path / name).write_text(text.replace(old, new))

    def tool(self, *command):
        """Runs a program of OpenFOAM in the case; its output must not hold an error."""
        result = self._run(command)
        if result.code != 0:
            raise RuntimeError("%s failed:\n%s" % (" ".join(command), result.text))
        return result

    def run(self, *options, ranks=1, program="himFoam"):
        """Runs himFoam or another program of ours; with more than one rank in parallel."""
        program = os.path.join(os.environ["HIMFOAM_BIN"], program)
        if ranks == 1:
            return self._run([program, *options])
        mpirun = ["mpirun", "--allow-run-as-root", "--oversubscribe", "--bind-to", "none", "-np", str(ranks)]
        return self._run([*mpirun, program, "-parallel", *options])

    def _run(self, command):
        environment = dict(os.environ)
        environment.setdefault("WM_PROJECT_DIR", "/usr/share/openfoam")
        environment["PWD"] = str(self.path)
        done = subprocess.run(command, cwd=self.path, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              timeout=120)
        # LIGGGHTS may add a line of arbitrary bytes to its message.
        return Result(done.returncode, done.stdout.decode(errors="replace"))

    def decompose(self, ranks, pieces=None):
        """Cuts the mesh, when there is one: in `pieces` along x, y and z, which is slices along z unless given."""
        if (self.path / "constant/polyMesh").exists():
            self.write("system/decomposeParDict", "numberOfSubdomains %d; method simple; simpleCoeffs { n (%d %d %d); delta 0.001; }"
                       % (ranks, *(pieces or (1, 1, ranks))))
            self.tool("decomposePar", "-force")

    def charge_table(self, time="0"):
        """Column names and rows of charge.dat."""
        lines = (self.path / "postProcessing/charge" / time / "charge.dat").read_text().splitlines()
        names = [line for line in lines if line.startswith("#")][-1][1:].split()
        rows = [dict(zip(names, map(float, line.split()))) for line in lines if not line.startswith("#")]
        return names, rows

    def field_values(self, name):
        """Values of an ascii field file, one per cell or particle: floats or tuples."""
        text = (self.path / name).read_text()
        text = text[text.index("// * *"):].split("boundaryField")[0]
        same = re.search(r"(\d+)\s*\{([^}]*)\}", text)  # N{value}
        if same:
            values = [same.group(2)] * int(same.group(1))
        else:
            listed = re.search(r"\d+\s*\((.*)\)", text, re.S).group(1)
            values = re.findall(r"\(([^)]*)\)", listed) or listed.split()
        return [numbers[0] if len(numbers) == 1 else numbers
                for numbers in (tuple(map(float, value.strip("()").split())) for value in values)]

    def particles(self, time):
        """Cloud of one time by tag, gathered from all processor folders: field name to value."""
        found = {}
        roots = sorted(self.path.glob("processor*")) or [self.path]
        for cloud in (root.relative_to(self.path) / time / "lagrangian/particles" for root in roots):
            if (self.path / cloud).exists():
                fields = {name: self.field_values(cloud / name) for name in ("tag", "charge", "radius", "U", "electricField")}
                for row, tag in enumerate(fields["tag"]):
                    found[int(tag)] = {name: values[row] for name, values in fields.items()}
        return found


class CaseTests(unittest.TestCase):
    """Tests that run cases in a folder of their own, `self.folder`, which goes with the test."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def ran(self, case, ranks=1):
        """The result of himFoam, which must have ended well; cuts the case for several ranks first."""
        if ranks > 1:
            case.decompose(ranks)
        result = case.run(ranks=ranks)
        self.assertEqual(result.code, 0, result.text[-3000:])
        return result

    def refused(self, case, *texts):
        """himFoam must not begin, and say all of these."""
        result = case.run("-dry-run")
        flat = " ".join(result.text.split())
        self.assertEqual(result.code, 1, result.text)
        for text in texts:
            self.assertIn(text, flat)


class SoundCaseTests(CaseTests):
    """Every test starts from its own copy of a sound case, `self.case`, that is meshed once."""

    @classmethod
    def setUpClass(cls):
        cls.sound = tempfile.TemporaryDirectory()
        TinyCase(cls.sound.name)

    @classmethod
    def tearDownClass(cls):
        cls.sound.cleanup()

    def setUp(self):
        super().setUp()
        self.case = TinyCase.copy(self.sound.name, self.folder)
