#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares the runs with what they must give, prints a table, draws runs/pneumaticPipe.png; exit code 1 when a claim fails.

check.py [-short]     -short: of a run that is too short for a steady state
"""

import pathlib
import sys

import matplotlib.pyplot as plt
import numpy as np

RUN = pathlib.Path("runs/pipe")
AREA = 2.7952e-5            # [m2] of the mesh's inlet, a polygon of 24 sides
RATE = 20000                # particles a second
MASS = 960*np.pi/6*277e-6**3
EQUILIBRIUM = 1.892e-12     # [C] S2.14, e/g = 4
SLICES = "abcd"

rows = []


def claim(text, found, allowed, holds):
    rows.append((text, found, allowed, holds))


def table(path):
    """Columns of a table of himFoam by name."""
    lines = path.read_text().splitlines()
    names = [line for line in lines if line.startswith("# Time")][-1][1:].split()
    values = np.array([[float(word) for word in line.split()] for line in lines if not line.startswith("#")])
    return {name: values[:, n] for n, name in enumerate(names)}


def rate(columns, name, start):
    """Mean rate of change from `start` [s] to the end."""
    late = columns["Time"] >= start - 1e-9
    time, value = columns["Time"][late], columns[name][late]
    return (value[-1] - value[0])/(time[-1] - time[0])


def check(short):
    charge, gas = table(RUN/"postProcessing/charge/0/charge.dat"), table(RUN/"postProcessing/gas/0/gas.dat")
    slices = [table(RUN/"postProcessing/particleStatistics/0"/(name + ".dat")) for name in SLICES]
    end = charge["Time"][-1]
    scale = np.max(np.abs(charge["total"]) + np.abs(charge["pipe"]) + np.abs(charge["removed"]))
    error = np.max(np.abs(charge["closureError"]))/scale
    claim("charge books, particles + pipe + removed", f"{error:.1e} of all charge", "1e-12", error <= 1e-12)
    largest = np.max(charge["max"])/EQUILIBRIUM
    claim("largest charge over the equilibrium charge", f"{largest:.3f}", "below 1", 0 < largest < 1)
    mean = [one["chargePerMass"][one["Time"] > 0.6*end].mean() for one in slices]
    claim("charge per mass along the pipe [uC/kg]", ", ".join(f"{1e6*value:.2f}" for value in mean), "rises",
          all(a < b for a, b in zip(mean, mean[1:])))
    number = sum(one["particles"] for one in slices)
    if not short:
        half = 0.5*end
        current, outflow = -rate(charge, "pipe", half), rate(charge, "removed", half)
        claim("charge carried out over charge from the pipe", f"{outflow/current:.3f}", "0.95 to 1.05", abs(outflow/current - 1) < 0.05)
        drift = abs(number[-1]/np.interp(half, slices[0]["Time"], number) - 1)
        claim("particles in the pipe, change in the second half", f"{100*drift:.1f} %", "10 %", drift < 0.1)
        late = slices[0]["Time"] >= half
        drop = slices[0]["pressureDrop"][late].mean()
        force = gas["forceZ"][gas["Time"] >= half].mean()/AREA
        claim("pressure drop less that of the empty pipe [Pa]", f"{drop:.2f}", f"force on the particles over area, {force:.2f}, 15 %",
              abs(drop/force - 1) < 0.15)
        print(f"current from the pipe {1e9*current:.3f} nA, charge carried out per mass {1e6*outflow/(RATE*MASS):.2f} uC/kg, "
              f"{number[late].mean():.0f} particles in the pipe")
    draw(charge, slices)


def draw(charge, slices):
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4))
    time = 1e3*charge["Time"]
    left.plot(time, -1e12*charge["pipe"], label="from the pipe")
    left.plot(time, 1e12*charge["removed"], label="carried out")
    left.plot(time, 1e12*charge["total"], label="on the particles")
    left.set_xlabel("time [ms]")
    left.set_ylabel("charge [pC]")
    left.legend()
    for name, one in zip(SLICES, slices):
        right.plot(1e3*one["Time"], 1e6*one["chargePerMass"], label="slice " + name)
    right.set_xlabel("time [ms]")
    right.set_ylabel("charge per mass [uC/kg]")
    right.legend(loc="lower right")
    figure.tight_layout()
    figure.savefig("runs/pneumaticPipe.png", dpi=100)


def main():
    check("-short" in sys.argv[1:])
    for text, found, allowed, holds in rows:
        print(f"{text:50s}{found:34s}{allowed}: {'ok' if holds else 'FAILED'}")
    return 0 if all(row[-1] for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
