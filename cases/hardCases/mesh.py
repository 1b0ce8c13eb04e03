# SPDX-License-Identifier: GPL-3.0-or-later
"""The collapsing cloud through himFoam: fields of a mesh, held for several DEM steps, in a grounded cube."""

import numpy as np

import foam
from scenes import NO_CHARGING, RADIUS, SPHERE, cloud, coulomb_in_cube, dem, kinetic, springs, states, time_step

SIDE, CELLS = 0.012, 12         # [m], cells of one sphere's diameter
STRONG = 3e6                    # surface field at which air breaks down [V/m]
SHARE = 0.1                     # time step over Rayleigh step
FRAMES = 20
INTERVALS = (1, 2, 5, 10, 50, 200, 1000)
SIDES = {"left": "xplane 0.0", "right": f"xplane {SIDE!r}", "front": "yplane 0.0", "back": f"yplane {SIDE!r}", "floor": "zplane 0.0",
         "lid": f"zplane {SIDE!r}"}

# name: entries of constant/electrostaticProperties
METHODS = {
    "p3m": "fieldMethod p3m;",
    "p3m, 3 cells": "fieldMethod p3m; p3mCoeffs { cloudCells 3; gather quartic; }",
    "p3m, 3 cells, nearField": "fieldMethod p3m; p3mCoeffs { cloudCells 3; gather quartic; } nearField { interval 20; reach 6e-3; }",
    "him": "fieldMethod him; himCoeffs { nearCutoff 3e-3; }",
}

BLOCK_MESH = f"""
vertices ((0 0 0) ({SIDE} 0 0) ({SIDE} {SIDE} 0) (0 {SIDE} 0) (0 0 {SIDE}) ({SIDE} 0 {SIDE}) ({SIDE} {SIDE} {SIDE}) (0 {SIDE} {SIDE}));
blocks (hex (0 1 2 3 4 5 6 7) ({CELLS} {CELLS} {CELLS}) simpleGrading (1 1 1));
boundary (sides {{ type wall; faces ((0 3 2 1) (4 5 6 7) (0 4 7 3) (1 2 6 5) (0 1 5 4) (3 7 6 2)); }});
"""
POTENTIAL = """
dimensions [1 2 -3 0 0 -1 0];
internalField uniform 0;
boundaryField { sides { type fixedValue; value uniform 0; } }
"""


def script(step):
    text = dem.script_head(((-RADIUS, SIDE + RADIUS),)*3, step, SPHERE, SPHERE, 1.0, 0.5*RADIUS)
    text += "".join(dem.wall_line(name, words) for name, words in SIDES.items()) + NO_CHARGING
    return text + dem.spheres(cloud(4, 1.6, STRONG, centre=(SIDE/2,)*3), RADIUS, SPHERE["density"])


def run(folder, entries, every, steps, step):
    """Frames of a run of `steps` DEM steps with a field update every `every` steps."""
    frames, _ = foam.run(folder, entries, script(step), steps//FRAMES, foam.control(step, every, steps//every),
                         " ".join(f"{name} sides;" for name in SIDES),
                         {"system/blockMeshDict": ("dictionary", BLOCK_MESH), "0/electricPotential": ("volScalarField", POTENTIAL)},
                         ("blockMesh", "himFoam"))
    return states(frames)


def drift(state):
    """Largest change of the energy and its change at the end, in largest kinetic energies."""
    totals = [kinetic(s) + springs(s, box=SIDE) + coulomb_in_cube(s, SIDE, 2) for s in state]
    change = (np.array(totals) - totals[0])/max(kinetic(s) for s in state)
    return abs(change).max(), change[-1]


def collapse(report):
    step = time_step(SHARE)
    steps = 2000 if report.short else 20000
    intervals = (100,) if report.short else INTERVALS
    rows, lines, worst = [], {}, {}
    for name, entries in METHODS.items():
        if report.short and not name.startswith("p3m, "):
            continue
        follows = "nearField" in entries
        cells = []
        for every in intervals:
            if follows and every < 50:
                cells.append("")
                continue
            folder = f"runs/mesh-{name.replace(',', '').replace(' ', '-')}-{every}"
            worst[name, every] = drift(run(folder, entries, every, steps, step))
            cells.append(f"{worst[name, every][0]:.1e}")
            print(f"mesh: {name}, every {every}: {cells[-1]}", flush=True)
        rows.append((name, *cells))
        shown = [every for every in intervals if (name, every) in worst]
        lines[name] = (shown, [worst[name, every][0] for every in shown])
    report.title("The cloud in a grounded cube with a mesh (himFoam)")
    report.table(["field", *(f"every {every}" for every in intervals)], rows)
    report.note(f"Largest change of the exact energy over {steps*step:.2g} s, in largest kinetic energies; {SHARE*100:g} % of the Rayleigh step, cells of one "
                "diameter. nearField: the short-range part of six diameters follows the particles every 20 steps.")
    if report.short:
        report.must("mesh", "p3m of 3 cells, held for 100 steps: energy", f"{worst['p3m, 3 cells', 100][0]:.1e}", worst["p3m, 3 cells", 100][0] < 0.05, "5 %")
        return
    report.curves["Cloud in a cube, himFoam"] = (("DEM steps per field update", "largest change of the energy"), lines)
    report.must("mesh", "p3m of 3 cells, every step: energy", f"{worst['p3m, 3 cells', 1][0]:.1e}", worst["p3m, 3 cells", 1][0] < 0.02, "2 %")
    held, follows = (worst[name, 1000][0] for name in ("p3m, 3 cells", "p3m, 3 cells, nearField"))
    report.must("mesh", "held for 1000 steps: with nearField over without", f"{follows/held:.2f}", follows < 0.2*held, "0.2")
