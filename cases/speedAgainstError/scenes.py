# SPDX-License-Identifier: GPL-3.0-or-later
"""The scenes: particles, mesh and methods, and a folder in which himField runs."""

import csv
import os
import re
import shutil
import subprocess
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

import meshes
import particles

DIAMETER = 1e-3  # [m]
CHARGE = 1e-13  # [C]
HEADER = "FoamFile { version 2.0; format ascii; class %s; object %s; }\n"
CONTROL = "writePrecision 12; deltaT 1; endTime 1; writeInterval 1;\n"
POTENTIAL = """dimensions [1 2 -3 0 0 -1 0];
internalField uniform 0;
boundaryField { ".*" { type fixedValue; value uniform 0; } }
"""
TOLERANCE = 1e-6
# Loose enough not to waste time, tight enough not to show in the errors below.
SOLUTION = "solvers { \"(electricPotential|meshPotential)\" { solver GAMG; smoother GaussSeidel; tolerance %g; relTol 0; } }\n" % TOLERANCE
SCHEMES = """ddtSchemes { default none; } gradSchemes { default Gauss linear; } divSchemes { default none; }
laplacianSchemes { default Gauss linear corrected; } interpolationSchemes { default linear; } snGradSchemes { default corrected; }
"""


def methods(cell, stretch):
    """Variants by name; `cell` is the cell size h [m], `stretch` the longest cell diagonal over that of a cube of this size."""
    diagonal = np.sqrt(3) * cell * stretch * (1 + 1e-9)
    clouds = {
        "p3m-2h": "fieldMethod p3m; cloudCells 2;",
        "p3m-3h": "fieldMethod p3m; cloudCells 3; gather quartic; deferredCorrection yes;",
        "p3m-4h": "fieldMethod p3m; cloudCells 4; gather quartic; deferredCorrection yes;",
        "p3m-6h": "fieldMethod p3m; cloudCells 6; gather quartic; deferredCorrection yes;",
    }
    return {
        "him-diagonal": "fieldMethod him; nearCutoff %.12g;" % diagonal,
        "him-3h": "fieldMethod him; nearCutoff %.12g;" % (3 * cell),
        "himCell-adjacent": "fieldMethod himCell;",
        "truncation-3h": "fieldMethod directTruncation; nearCutoff %.12g;" % (3 * cell),
        "particleCell-3h": "fieldMethod hybridParticleCell; nearCutoff %.12g;" % (3 * cell),
        "pairwise": "fieldMethod pairwiseSum;",
        "pairwise-images": "fieldMethod pairwiseSum; images yes;",
        **clouds,
        **{name + "-single": entries + " nearPrecision single;" for name, entries in clouds.items()},
    }


@dataclass
class Scene:
    """Lengths in sphere diameters."""
    name: str
    title: str
    position: np.ndarray
    charge: np.ndarray
    cell: float
    mesh: str = ""  # blockMeshDict
    gmsh: str = ""  # or tetrahedra whose dual is the mesh
    ball: float = 0  # radius of a sphere that the mesh is rounded to
    stretch: float = 1  # longest cell diagonal over that of a cube of `cell`
    names: tuple = ()  # methods; all by default
    rounds: int = 5
    rows: list = field(default_factory=list)


def write(folder, name, text, kind="dictionary"):
    file = folder / name
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(HEADER % (kind, file.name) + text)


def call(command, folder, log):
    environment = dict(os.environ, PWD=str(folder))
    with open(folder / log, "w") as output:
        code = subprocess.run(command, cwd=folder, env=environment, stdout=output, stderr=subprocess.STDOUT).returncode
    if code:
        raise RuntimeError("%s failed; see %s" % (command[0], folder / log))


def known_methods(folder):
    """Names that himField has in this build, from its own message."""
    done = subprocess.run(["himField", "-particles", "particles.csv", "-method", "?"], cwd=folder, env=dict(os.environ, PWD=str(folder)),
                          stdout=subprocess.PIPE, text=True)
    return re.search("known: ([^.]*)", " ".join(done.stdout.split())).group(1).split(", ")


def round_mesh(file, radius):
    """Rewrites the points of a mesh of meshes.sphere()."""
    text = file.read_text()
    head, rest = re.match(r"(.*?\n\d+\n\(\n)(.*)", text, re.S).groups()
    rows, tail = rest.split("\n)", 1)
    points = np.array([row.strip("()").split() for row in rows.split("\n")], float) / DIAMETER
    rows = "\n".join("(%.12g %.12g %.12g)" % tuple(point) for point in meshes.rounded(points, radius) * DIAMETER)
    file.write_text(head + rows + "\n)" + tail)


def set_up(scene, root):
    """The case folder of a scene, meshed. Returns folder and the names that run."""
    folder = root / scene.name
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    write(folder, "system/controlDict", CONTROL)
    write(folder, "system/fvSolution", SOLUTION)
    write(folder, "system/fvSchemes", SCHEMES)
    write(folder, "0/electricPotential", POTENTIAL, "volScalarField")
    write(folder, "constant/electrostaticProperties", "fieldMethod pairwiseSum;\n")
    particles.write_csv(folder / "particles.csv", scene.position, scene.charge, DIAMETER, CHARGE)
    if scene.gmsh:
        (folder / "tetrahedra.msh").write_text(scene.gmsh)
        call(["gmshToFoam", "tetrahedra.msh"], folder, "log.gmshToFoam")
        call(["polyDualMesh", "-overwrite", "60"], folder, "log.polyDualMesh")
    else:
        write(folder, "system/blockMeshDict", scene.mesh)
        call(["blockMesh"], folder, "log.blockMesh")
        if scene.ball:
            round_mesh(folder / "constant/polyMesh/points", scene.ball)
    known = known_methods(folder)
    wanted = methods(scene.cell * DIAMETER, scene.stretch)
    chosen = {name: text for name, text in wanted.items()
              if re.search("fieldMethod ([^;]*)", text).group(1) in known and (not scene.names or name in scene.names)}
    variants = "".join("%s { %s }\n" % (name, text) for name, text in chosen.items())
    write(folder, "constant/electrostaticProperties", "fieldMethod pairwiseSum;\n" + variants)
    return folder, list(chosen)


def compare(folder, names, rounds, core=None):
    """Runs himField -compare; rows of its table, with numbers as floats."""
    pinned = ["taskset", "-c", str(core)] if core is not None and shutil.which("taskset") else []
    call([*pinned, "himField", "-particles", "particles.csv", "-compare", "-methods", "(%s)" % " ".join(names), "-repeat", str(rounds)],
         folder, "log.himField")
    with open(folder / "postProcessing/himField/compare.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        for name, value in row.items():
            if name not in ("name", "fieldMethod", "parameters", "mesh", "reference", "left_out"):
                row[name] = float(value)
    return rows
