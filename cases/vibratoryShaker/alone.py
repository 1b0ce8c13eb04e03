#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""One sphere alone, with the field of all others opposing its charging (`total`): there are no others, so it must stop at q_sat. In the
shaker's cylinder and in a cube of 60 mm, with every way to take its own response out, the field held for 1, 10 and 1000 DEM steps.
The acceleration is so large that every wall contact goes to the end; the charge between contacts is what charging ended at.
Usage: alone.py [held steps ...]. Writes alone/; exit code 1 when a sphere ends off q_sat by more than is allowed."""

import math
import os
import re
import shutil
import subprocess
import sys

import shaker

TIME_STEP = 1.3888888888888889e-5  # [s]
STEPS = 9000
HIM = "him", "himCoeffs { nearCutoff 20e-3; ownCellResponse %s; }"
METHODS = {
    "p3m": ("p3m", ""),
    "him, forceOnly": (HIM[0], HIM[1] % "forceOnly"),
    "him, remove": (HIM[0], HIM[1] % "remove"),
    "pairs": ("pairwiseSum", "pairwiseSumCoeffs { images yes; }"),
    "him as published": (HIM[0], HIM[1] % "keep"),
}
ALLOWED = {"cube": 5e-3, "cylinder": 2e-2}
HEADER = "FoamFile { version 2.0; format ascii; class dictionary; object %s; }\n"
CUBE = """scale 0.03;
vertices ((-1 -1 0) (1 -1 0) (1 1 0) (-1 1 0) (-1 -1 2) (1 -1 2) (1 1 2) (-1 1 2));
blocks (hex (0 1 2 3 4 5 6 7) (12 12 12) simpleGrading (1 1 1));
boundary
(
    bottom { type wall; faces ((0 3 2 1)); }
    top { type wall; faces ((4 5 6 7)); }
    side { type wall; faces ((0 4 7 3) (1 2 6 5) (0 1 5 4) (3 7 6 2)); }
);
"""


def edit(path, *changes):
    with open(path) as file:
        text = file.read()
    for pattern, replacement in changes:
        text, count = re.subn(pattern, replacement, text, flags=re.M)
        if count == 0:
            raise ValueError(f"{path}: nothing matches {pattern}")
    with open(path, "w") as file:
        file.write(text)


def make(folder, shape, diameter, method, coeffs, held):
    shutil.rmtree(folder, ignore_errors=True)
    shutil.copytree(".", folder, ignore=shutil.ignore_patterns("runs", "study", "bands", "alone", "doc", "*.py", "*.png"))
    radius = diameter/2
    sphere = (f"create_atoms 1 single 0.002 0.003 {radius + 1e-3!r}\nset group all diameter {diameter!r} density 2150 charge 0.0\n"
              "velocity all set 0.9 0.5 -0.3\nfix  motion")
    edit(f"{folder}/DEM/in.shaker", (r"^(create_atoms|displace_atoms|set ) .*\n", ""), (r"^fix  motion", sphere),
         ("area hertz", "area hertz acceleration 1000"))
    edit(f"{folder}/constant/couplingProperties", (r"(wallContactField +)self", r"\1total"), (r"chargeInterval +5", "chargeInterval 1"),
         (r"logInterval +50", "logInterval 1000000"))
    if shape == "cube":
        wall = "fix  %s all wall/gran model hertz tangential history cohesion charge primitive type 2 %s\n"
        edit(f"{folder}/DEM/in.shaker", ("zcylinder 0.03 0. 0.", "xplane -0.03"),
             (r"^fix  lid", wall % ("east", "xplane 0.03") + wall % ("south", "yplane -0.03") + wall % ("north", "yplane 0.03") + "fix  lid"))
        edit(f"{folder}/constant/couplingProperties", (r"cyl +side;", "cyl side; east side; south side; north side;"))
        with open(f"{folder}/system/blockMeshDict", "w") as file:
            file.write(HEADER % "blockMeshDict" + CUBE)
    if method == "pairwiseSum":
        edit(f"{folder}/constant/couplingProperties", (r" (side|bottom|top);", " grounded;"))
    with open(f"{folder}/constant/electrostaticProperties", "w") as file:
        file.write(HEADER % "electrostaticProperties" + f"fieldMethod {method};\n{coeffs}\nfieldError {{ active no; }}\n")
    edit(f"{folder}/system/controlDict", (r"^endTime .*", f"endTime {STEPS*TIME_STEP!r};"), (r"^deltaT .*", f"deltaT {held*TIME_STEP!r};"),
         (r"^writeInterval .*", "writeInterval 1000;"), (r"^timePrecision .*", "timePrecision 12;"))


def charges(folder, diameter):
    """Between contacts, in q_sat: what stood still for an update after it had changed, and the last charge."""
    environment = {"WM_PROJECT_DIR": "/usr/share/openfoam", **os.environ}
    for program in ("blockMesh", "himFoam"):
        with open(f"{folder}/log.{program}", "w") as log:
            subprocess.run([program, "-case", folder], check=True, stdout=log, stderr=log, env=environment)
    total = shaker.charge_history(folder)["total"]/(math.pi*shaker.EPSILON0*diameter**2*shaker.GAMMA_WALL)
    return [b for a, b, c in zip(total, total[1:], total[2:]) if b == c != a] + [total[-1]]


def main():
    intervals = [int(word) for word in sys.argv[1:]] or [1, 10, 1000]
    failed = False
    print("| method | container | sphere | " + " | ".join(f"held {held} steps" for held in intervals) + " |")
    print("|---|---|---|" + "---|"*len(intervals))
    for name, (method, coeffs) in METHODS.items():
        for shape, allowed in ALLOWED.items():
            for diameter in (12.7e-3, 11.11e-3):
                row = []
                for held in intervals:
                    folder = f"alone/{name.replace(', ', '-').replace(' ', '')}-{shape}-{1e3*diameter:g}-{held}"
                    make(folder, shape, diameter, method, coeffs, held)
                    ends = charges(folder, diameter)
                    row.append(f"{min(ends):.4f} to {max(ends):.4f}" if max(ends) - min(ends) > 5e-5 else f"{ends[-1]:.4f}")
                    failed = failed or (name != "him as published" and max(abs(end - 1) for end in ends) > allowed)
                print(f"| {name} | {shape} | {1e3*diameter:g} mm | " + " | ".join(row) + " |", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
