# SPDX-License-Identifier: GPL-3.0-or-later
"""A cube of gas with spheres, closed by cyclic patches or by walls, for tests of himFoam's gas. No gravity, no charges."""

import pathlib

from tiny_case import TinyCase

CONTROL = """
application himFoam;
startFrom startTime; startTime 0; stopAt endTime;
endTime %(end)r; deltaT %(step)r;
writeControl timeStep; writeInterval 100000;
writeFormat binary; writePrecision 16; timePrecision 8; runTimeModifiable false;
"""

SCHEMES = """
ddtSchemes { default Euler; }
gradSchemes { default Gauss linear; }
divSchemes { default Gauss linear; div(alphaPhi,U) Gauss upwind; div(alphaPhi,k) Gauss upwind; div(alphaPhi,epsilon) Gauss upwind;
    div(alphaPhi,omega) Gauss upwind; }
laplacianSchemes { default Gauss linear corrected; }
interpolationSchemes { default linear; }
snGradSchemes { default corrected; }
wallDist { method meshWave; }
"""

SOLUTION = """
solvers
{
    "(p|pFinal)" { solver PCG; preconditioner DIC; tolerance 1e-12; relTol 0; }
    "(k|epsilon|omega)" { solver PBiCGStab; preconditioner DILU; tolerance 1e-14; relTol 0; }
}
PIMPLE { nOuterCorrectors %(outer)d; nCorrectors 2; nNonOrthogonalCorrectors 0; }
"""

MESH = """
scale %(size)r;
vertices ((0 0 0) (1 0 0) (1 1 0) (0 1 0) (0 0 1) (1 0 1) (1 1 1) (0 1 1));
blocks (hex (0 1 2 3 4 5 6 7) (%(cells)d %(cells)d %(cells)d) simpleGrading (1 1 1));
boundary
(
    left   { %(left)s faces ((0 4 7 3)); }
    right  { %(right)s faces ((1 2 6 5)); }
    front  { %(front)s faces ((0 1 5 4)); }
    back   { %(back)s faces ((3 7 6 2)); }
    bottom { %(bottom)s faces ((0 3 2 1)); }
    top    { %(top)s faces ((4 5 6 7)); }
);
"""

PAIRS = {"left": "right", "front": "back", "bottom": "top"}
PARTNER = {**PAIRS, **{b: a for a, b in PAIRS.items()}}

GAS = """
density %(density)r;
viscosity %(viscosity)r;
gravity (0 0 %(gravity)r);
drag SchillerNaumann;
voidFraction %(voidFraction)s;
%(more)s
"""

SCRIPT = """
variable startTime index 0
units si
atom_style granular
atom_modify map array
boundary %(boundary)s
newton off
communicate single vel yes
processors * * *
region box block %(box)s units box
if "${startTime} > 0" then "read_restart DEM/restart/${startTime}" else "create_box 1 box"
neighbor 0.002 bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype 5.e6
fix m2 all property/global poissonsRatio peratomtype 0.45
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.9
fix m4 all property/global coefficientFriction peratomtypepair 1 0.3
pair_style gran model hertz tangential history
pair_coeff * *
timestep %(demStep)r
%(particles)s
%(pull)s
fix move all nve/sphere
thermo 100000
"""


class GasBox(TinyCase):
    """Spheres are (position, velocity, diameter, density); `walls` are the patches that are walls, the others cyclic."""

    def __init__(self, folder, spheres, size=0.04, cells=8, walls=(), U="uniform (0 0 0)", wall_U=None, density=100.0,
                 viscosity=1e-3, gravity=0.0, voidFraction="centre;", more="", step=1e-4, demStep=1e-5, end=6e-3, outer=1):
        self.path = pathlib.Path(folder)
        patches = {name: "type wall;" if name in walls else "type cyclic; neighbourPatch %s;" % PARTNER[name] for name in PARTNER}
        self.write("system/controlDict", CONTROL % {"end": end, "step": step})
        self.write("system/fvSchemes", SCHEMES)
        self.write("system/fvSolution", SOLUTION % {"outer": outer})
        self.write("system/blockMeshDict", MESH % {"size": size, "cells": cells, **patches})
        self.write("constant/gasProperties", GAS % {"density": density, "viscosity": viscosity, "gravity": gravity,
                                                    "voidFraction": voidFraction, "more": more})
        self.write("constant/couplingProperties", 'demScript "DEM/in.box"; demCheckpoint yes;')
        self.field("U", "volVectorField", "0 1 -1 0 0 0 0", U,
                   {name: "fixedValue; value uniform " + (wall_U or {}).get(name, "(0 0 0)") for name in walls})
        self.field("p", "volScalarField", "1 -1 -2 0 0 0 0", "uniform 0",
                   {name: "fixedFluxPressure; value uniform 0" for name in walls})
        lines = []
        for tag, (position, velocity, diameter, rho) in enumerate(spheres, 1):
            lines.append('if "${startTime} == 0" then "create_atoms 1 single %r %r %r units box"' % tuple(position))
            lines.append('if "${startTime} == 0" then "set atom %d diameter %r density %r vx %r vy %r vz %r"'
                         % (tag, diameter, rho, *velocity))
        closed = bool(walls)
        low, high = (-0.001*closed, size + 0.001*closed)
        self.write("DEM/in.box", SCRIPT % {
            "boundary": "f f f" if len(walls) == 6 else " ".join("f" if name in walls else "p" for name in PAIRS),
            "box": " ".join("%r %r" % ((low, high) if name in walls else (0.0, size)) for name in PAIRS),
            "demStep": demStep, "particles": "\n".join(lines),
            "pull": "fix g all gravity %r vector 0 0 -1" % -gravity if gravity else ""})
        self.tool("blockMesh")

    def field(self, name, kind, dimensions, inside, walls):
        """Writes 0/<name>; `walls` gives the condition of each patch that is a wall."""
        patches = "\n".join("%s { type %s; }" % (patch, walls.get(patch, "cyclic")) for patch in PARTNER)
        self.write("0/" + name, "dimensions [%s];\ninternalField %s;\nboundaryField\n{\n%s\n}\n" % (dimensions, inside, patches), kind)

    def table(self, start="0"):
        """The rows of gas.dat as dictionaries."""
        lines = (self.path / "postProcessing/gas" / start / "gas.dat").read_text().splitlines()
        names = [line for line in lines if line.startswith("# Time")][0][2:].split()
        return [dict(zip(names, map(float, line.split()))) for line in lines if not line.startswith("#")]

    def rows(self, ranks=1, start="0"):
        """Runs himFoam and gives table()."""
        if ranks > 1:
            self.decompose(ranks)
        result = self.run(ranks=ranks)
        if result.code != 0:
            raise AssertionError(result.text[-3000:])
        return self.table(start)


def vector(row, name):
    return [row[name + axis] for axis in "XYZ"]
