#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Why `wallContactField total` charges differently by him, p3m and the pair sum: runs each, then takes the states of the p3m run and
compares the field at spheres near a wall with exact_field.py. Usage: wall_field.py [end time, default 30 s]"""

import csv
import os
import pathlib
import re
import shutil
import subprocess
import sys

import numpy as np

import bands
import shaker
from exact_field import GroundedCylinder

NEAR = 1.5e-3       # [m], gap to the wall
NANO, KILO = 1e9, 1e-3
# name: method and its entries
MESH_RUNS = {
    "him": ("him", "nearCutoff 20e-3;"),
    "him, ownCellResponse forceOnly": ("him", "nearCutoff 20e-3; ownCellResponse forceOnly;"),
    "p3m": ("p3m", None),
}


def mesh_case(folder, method, entries, end):
    """A copy of the case with `total`, run."""
    shutil.rmtree(folder, ignore_errors=True)
    for part in ("0", "constant", "system", "DEM"):
        shutil.copytree(part, f"{folder}/{part}", ignore=shutil.ignore_patterns("polyMesh"))

    def edit(name, pattern, new):
        path = pathlib.Path(folder, name)
        text, count = re.subn(pattern, new, path.read_text())
        assert count, f"{name}: no {pattern}"
        path.write_text(text)

    edit("constant/couplingProperties", r"(?m)^wallContactField .*", "wallContactField total;")
    edit("constant/electrostaticProperties", r"(?m)^fieldMethod .*", f"fieldMethod {method};\npairwiseSumCoeffs {{ images yes; }}")
    if entries:
        edit("constant/electrostaticProperties", r"nearCutoff +20e-3;", entries)
    edit("system/controlDict", r"(?m)^endTime .*", f"endTime {end:g};")
    for program in ("blockMesh", "himFoam"):
        with open(f"{folder}/log.{program}", "w") as log:
            subprocess.run([program], cwd=folder, stdout=log, stderr=subprocess.STDOUT, check=True)
    return shaker.charge_history(folder)


def by_him_field(case, method, position, charge):
    """Field [V/m] at every charge by himField."""
    table = pathlib.Path(case, "spheres.csv")
    table.write_text("x,y,z,q\n" + "".join(f"{x!r},{y!r},{z!r},{q!r}\n" for (x, y, z), q in zip(position.tolist(), charge.tolist())))
    with open(f"{case}/log.himField", "w") as log:
        subprocess.run(["himField", "-particles", "spheres.csv", "-method", method, "-output", "field.csv"], cwd=case, stdout=log,
                       stderr=subprocess.STDOUT, check=True)
    with open(f"{case}/field.csv") as file:
        return np.array([[float(row[c]) for c in ("Ex", "Ey", "Ez")] for row in csv.DictReader(file)])


def near_walls(position):
    """(sphere, wall, unit vector into the wall) of all that are near one."""
    across = np.hypot(position[:, 0], position[:, 1])
    for i, (x, y, z) in enumerate(position):
        if shaker.CONTAINER_RADIUS - shaker.RADIUS - across[i] < NEAR:
            yield i, "side", np.array([x, y, 0.0])/across[i]
        if z - shaker.RADIUS < NEAR:
            yield i, "floor", np.array([0.0, 0.0, -1.0])
        if shaker.CONTAINER_HEIGHT - shaker.RADIUS - z < NEAR:
            yield i, "lid", np.array([0.0, 0.0, 1.0])


def opposing(case):
    """Per method and wall: field that opposes charging, of the sphere's own images and of all others [V/m], at all saved states."""
    exact = GroundedCylinder()
    methods = {"exact": exact.field}
    methods.update({name: lambda x, q, name=name: by_him_field(case, name, x, q) for name in ("him", "p3m", "pairwiseSum")})
    found = {}
    for time in shaker.write_times(case):
        if float(time) < 6:
            continue
        position, charge = (shaker.read_cloud(case, time, name) for name in ("positions", "charge"))
        position, charge = position[:, :3], charge[:, 0]
        for name, field in methods.items():
            whole, own = field(position, charge), {}
            for i, wall, normal in near_walls(position):
                own[i] = own[i] if i in own else field(position[i:i + 1], charge[i:i + 1])[0]
                found.setdefault((name, wall), []).append((-own[i] @ normal, -(whole[i] - own[i]) @ normal))
    return {key: np.array(values) for key, values in found.items()}


def main():
    end = float(sys.argv[1]) if len(sys.argv) > 1 else 30.0
    print("| field | mean bulk charge from a third of the run on [nC] |\n|---|---|")
    histories = {name: mesh_case(f"wallField/{name.split()[-1]}", *words, end) for name, words in MESH_RUNS.items()}
    text = bands.script(*bands.SCENES["3d-13x12.7"], *bands.PARAMETERS[12.7]["average"])
    histories["pair sum with images"] = bands.run_case("wallField/pairwiseSum", 3, text, "total", end)
    for name, columns in histories.items():
        print(f"| {name} | {NANO*columns['total'][columns['Time'] >= end/3].mean():.2f} |")
    found = opposing("wallField/p3m")
    print("\n| | wall | places | own response [kV/m] | the others | off from exact |\n|---|---|---|---|---|---|")
    for (name, wall), values in found.items():
        own, others = KILO*values.mean(0)
        off = KILO*(values - found["exact", wall])[:, 1].mean()
        print(f"| {name} | {wall} | {len(values)} | {own:.0f} | {others:.0f} | {off:+.0f} |")


if __name__ == "__main__":
    os.chdir(pathlib.Path(__file__).resolve().parent)
    main()
