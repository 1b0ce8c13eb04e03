#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares the charges of the accelerated and of the projective bed with those of the plain one at the same charging time, prints a
table, draws runs/projectiveBed.png; exit code 1 when a claim fails."""

import pathlib
import re
import sys

import matplotlib.pyplot as plt
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from lagrangianCloud import charges  # noqa: E402

NAMES = ("plain", "accelerated", "projective")
START = "0.3"
ENDS = {"plain": "0.7", "accelerated": "0.4", "projective": "0.4"}


def table(path):
    """Columns of a table of himFoam by name."""
    lines = path.read_text().splitlines()
    names = [line for line in lines if line.startswith("# Time")][-1][1:].replace("...", "").split()
    values = np.array([[float(word) for word in line.split()] for line in lines if not line.startswith("#")])
    return {name: values[:, n] for n, name in enumerate(names)}


def seconds(run):
    return float(re.findall(r"wall-clock time \[s\] +(\S+)", (run/"log.himFoam").read_text())[-1])


def main():
    found = {}
    print(f"{'':14s}{'mean [fC]':>12s}{'spread [fC]':>12s}{'largest [fC]':>13s}{'wall layer [fC]':>16s}{'time [s]':>10s}")
    for name in NAMES:
        run = pathlib.Path("runs")/name
        charge = charges(run/ENDS[name])
        row = table(run/"postProcessing/particleStatistics"/START/"bed.dat")
        profile = np.loadtxt(run/"postProcessing/particleStatistics"/ENDS[name]/"bedProfile.dat")
        found[name] = {"mean": charge.mean(), "spread": charge.std(), "charge": charge, "row": row}
        # Mean charge of the first diameter from the wall, two bins, weighed by their particles.
        near = np.average(profile[:2, 2], weights=profile[:2, 1])
        print(f"{name:14s}{1e15*charge.mean():12.2f}{1e15*charge.std():12.2f}{1e15*charge.max():13.2f}{1e15*near:16.2f}"
              f"{seconds(run):10.1f}")
    leaps = table(pathlib.Path("runs/projective/postProcessing/projectiveCharging")/START/"projectiveCharging.dat")
    errors = leaps["error"][1:]
    print(f"error indicator: mean {errors.mean():.2f}, largest {errors.max():.2f}; correlation of the rests {leaps['correlation'][-1]:.2f}; "
          f"stopped {leaps['stopped'].sum():.0f}")

    plain, fast, ours = (found[name] for name in NAMES)
    early = np.interp(float(ENDS["projective"]), plain["row"]["Time"], plain["row"]["meanCharge"])
    print(f"plain bed at the end of the others' simulated time: mean {1e15*early:.2f} fC, four times that {4e15*early:.2f} fC")
    print(f"over plain at the same charging time: mean {fast['mean']/plain['mean']:.2f} accelerated, {ours['mean']/plain['mean']:.2f} "
          f"projective; spread {fast['spread']/plain['spread']:.2f} accelerated, {ours['spread']/plain['spread']:.2f} projective")
    claims = [
        ("mean of projective over accelerated", ours["mean"]/fast["mean"], 0.85, 1.15),
        ("spread of projective over accelerated", ours["spread"]/fast["spread"], 0, 0.8),
        ("relative spread of projective over plain", ours["spread"]/ours["mean"]/(plain["spread"]/plain["mean"]), 0.6, 1.6),
    ]
    good = True
    for text, value, low, high in claims:
        holds = low < value < high
        good = good and holds
        print(f"{text:44s}{value:.3f}   {low:.2f} to {high:.2f}: {'ok' if holds else 'FAILED'}")
    draw(found)
    return 0 if good else 1


def draw(found):
    figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4))
    for name in NAMES:
        row = found[name]["row"]
        left.plot(row["chargingTime"], 1e15*row["meanCharge"], label=name)
    left.set_xlabel("charging time [s]")
    left.set_ylabel("mean charge [fC]")
    left.legend()
    bins = np.linspace(min(f["charge"].min() for f in found.values()), max(f["charge"].max() for f in found.values()), 60)
    for name in NAMES:
        right.hist(1e15*found[name]["charge"], 1e15*bins, histtype="step", label=name)
    right.set_yscale("log")
    right.set_xlabel("charge [fC]")
    right.set_ylabel("particles")
    right.legend()
    figure.tight_layout()
    figure.savefig("runs/projectiveBed.png", dpi=100)


if __name__ == "__main__":
    sys.exit(main())
