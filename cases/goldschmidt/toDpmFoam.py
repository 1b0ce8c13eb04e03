#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A case for DPMFoam that goes on from a state of himFoam: the packaged tutorial's files, with spheres, gas velocity and pressure of that
state. Usage: toDpmFoam.py <run of himFoam> <its time> <tutorial> <new case> <length [s]> <between writes [s]>

The state has to be ASCII. The spheres get no spin and no memory of tangential contact, and DPMFoam finds flux and void fraction itself."""

import os
import re
import shutil
import sys

import numpy as np

DENSITY, GRAVITY, TOP = 1.2, 9.81, 0.45     # [kg/m3], [m/s2], [m]
LAYER, CELLS = 5e-3, (2, 30, 90)            # [m]

HEADER = """FoamFile
{{
    version     2.0;
    format      ascii;
    class       {kind};
    object      {name};
}}

"""
WALL_AND_PAIR = {
    "collisionRecordsPairAccessed": "labelFieldField", "collisionRecordsPairData": "vectorFieldField",
    "collisionRecordsPairOrigIdOfOther": "labelFieldField", "collisionRecordsPairOrigProcOfOther": "labelFieldField",
    "collisionRecordsWallAccessed": "labelFieldField", "collisionRecordsWallData": "vectorFieldField",
    "collisionRecordsWallPRel": "vectorFieldField"}
# What every sphere has alike, as a fresh injection by DPMFoam would give it
ALIKE = {"UTurb": ("vectorField", "(0 0 0)"), "active": ("labelField", "1"), "age": ("scalarField", "0"), "dTarget": ("scalarField", "0"),
         "d": ("scalarField", "0.0025"),
         "angularMomentum": ("vectorField", "(0 0 0)"), "f": ("vectorField", "(0 0 0)"), "torque": ("vectorField", "(0 0 0)"),
         "nParticle": ("scalarField", "1"), "origProcId": ("labelField", "0"), "rho": ("scalarField", "2526"),
         "tTurb": ("scalarField", "0"), "typeId": ("labelField", "-1")}


def put(path, kind, text):
    os.makedirs(os.path.dirname(path), exist_ok=True)
    with open(path, "w") as file:
        file.write(HEADER.format(kind=kind, name=os.path.basename(path)) + text + "\n")


def listed(values):
    values = np.asarray(values)
    if values.ndim == 1:
        return f"{len(values)}\n(\n" + "\n".join(f"{v:.12g}" for v in values) + "\n)\n"
    return f"{len(values)}\n(\n" + "\n".join("(" + " ".join(f"{c:.12g}" for c in v) + ")" for v in values) + "\n)\n"


def cell_values(path):
    """Of an ASCII field of OpenFOAM, one row per cell."""
    with open(path) as file:
        found = re.search(r"internalField\s+nonuniform List<\w+>\s*\d+\s*\((.*?)\n\)", file.read(), re.S)
    return np.array(found.group(1).replace("(", " ").replace(")", " ").split(), float).reshape(np.prod(CELLS), -1)


def body(path):
    """What follows the header of an OpenFOAM file."""
    with open(path) as file:
        text = file.read()
    return text[text.index("}", text.index("FoamFile")) + 1:]


def boundary_of(path):
    """The tutorial's boundary conditions; values that follow the cells would have the wrong length."""
    with open(path) as file:
        text = file.read()
    return text[text.index("boundaryField"):].replace("$internalField", "uniform 0")


def write_spheres(case, time, run):
    folder, found = f"{case}/{time}/lagrangian/kinematicCloud", f"{run}/{time}/lagrangian/particles"
    count = int(re.search(r"(?m)^(\d+)", body(f"{found}/positions")).group(1))
    put(f"{folder}/positions", "Cloud<basicKinematicCollidingParcel>", body(f"{found}/positions"))
    put(f"{folder}/U", "vectorField", body(f"{found}/U"))
    put(f"{folder}/origId", "labelField", listed(np.arange(count)))
    for name, (kind, value) in ALIKE.items():
        put(f"{folder}/{name}", kind, f"{count}{{{value}}}")
    for name, kind in WALL_AND_PAIR.items():
        put(f"{folder}/{name}", kind, f"{count}\n(\n" + "0()\n"*count + ")\n")
    uniform = f"{case}/{time}/uniform/lagrangian/kinematicCloud"
    put(f"{uniform}/cloudProperties", "dictionary", f"geometry positions;\nprocessor0 {{ particleCount {count}; }}")
    # The tutorial's injection has happened; without this DPMFoam would add its lattice.
    put(f"{uniform}/kinematicCloudOutputProperties", "dictionary",
        f"injectionModel {{ model1 {{ nInjections 1; parcelsAddedTotal {count}; timeStep0 {time}; }} }}")


def write_gas(case, time, run, tutorial):
    put(f"{case}/{time}/U.air", "volVectorField", "dimensions [0 1 -1 0 0 0 0];\ninternalField nonuniform List<vector>\n"
        + listed(cell_values(f"{run}/{time}/U")) + ";\n" + boundary_of(f"{tutorial}/0/U.air"))
    # DPMFoam's pressure is over the density and holds the weight of the gas.
    height = (np.arange(np.prod(CELLS))//(CELLS[0]*CELLS[1]) + 0.5)*LAYER
    pressure = cell_values(f"{run}/{time}/p")[:, 0]/DENSITY + GRAVITY*(TOP - height)
    put(f"{case}/{time}/p", "volScalarField", "dimensions [0 2 -2 0 0 0 0];\ninternalField nonuniform List<scalar>\n"
        + listed(pressure) + ";\n" + boundary_of(f"{tutorial}/0/p"))


def write_control(case, end, between):
    """The tutorial's settings, but for what is written: ASCII and the pressure at the inlet in every step."""
    path = f"{case}/system/controlDict"
    with open(path) as file:
        text = file.read()
    for entry, value in (("endTime", f"{end:.9g}"), ("writeInterval", between), ("writeFormat", "ascii"), ("writePrecision", "10")):
        text, count = re.subn(rf"(?m)^{entry}\s.*;", f"{entry} {value};", text)
        if count != 1:
            sys.exit(f"No single entry {entry} in {path}")
    with open(path, "w") as file:
        file.write(text + """
functions
{
    inlet
    {
        type surfaceFieldValue;
        libs ("libfieldFunctionObjects.so");
        regionType patch;
        name bottom;
        operation areaAverage;
        fields (p);
        writeFields false;
    }
}
""")


def main():
    run, time, tutorial, case, length, between = sys.argv[1:]
    shutil.copytree(f"{tutorial}/constant", f"{case}/constant")
    shutil.copytree(f"{tutorial}/system", f"{case}/system")
    write_spheres(case, time, run)
    write_gas(case, time, run, tutorial)
    write_control(case, float(time) + float(length), between)


if __name__ == "__main__":
    main()
