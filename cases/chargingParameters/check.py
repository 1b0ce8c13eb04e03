#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Holds what chargingParameters found against R (Rasera et al. 2022); prints a table and fails when a number is missed.

`printed` is R's own number. Where R's own inputs do not give it, `stated` is what they give (README.md says why).
"""

import csv
import pathlib
import sys

# example, measurement, quantity, column, R's printed number or None, stated number, tolerance
EXPECTED = [
    ("particleWall", "ptfe", "contact area", "average", None, 1.832e-7, 5e-4),
    ("particleWall", "ptfe", "Gamma", "average", -2.34e6, -2.34e6, 2.5e-3),
    ("particleWall", "ptfe", "kappa_c frozen", "average", 9.64, 9.64, 2e-3),
    ("particleWall", "hdpe", "Gamma", "average", -1.39e6, -1.39e6, 2e-3),
    ("particleWall", "hdpe", "kappa_c frozen", "average", 3.65, 3.65, 2e-3),
    ("particleWall", "alphaLactose", "Gamma", "average", -2.15e6, -2.15e6, 2e-3),
    ("particleWall", "alphaLactose", "kappa_c frozen", "average", 36.62, 36.62, 2e-3),
    ("particleWall", "aspirin", "Gamma", "average", -4.77e6, -4.77e6, 2e-3),
    ("particleWall", "aspirin", "kappa_c frozen", "average", 16.45, 18.49, 2e-3),
    ("particleWall", "sucrose", "Gamma", "average", -1.88e6, -1.88e6, 2e-3),
    ("particleWall", "sucrose", "kappa_c frozen", "average", 28.55, 28.55, 2.5e-3),
    ("particleWallHistory", "ptfe", "Gamma", "average", -1.52e6, -1.52e6, 5e-3),
    ("particleWallHistory", "ptfe", "kappa_c", "average", 27.2, 27.2, 1e-2),
    ("similarPair", "pa66of3p18mm", "kappa_c frozen", "average", 27.79, 27.00, 1e-3),
    ("similarPair", "pa66of4mm", "kappa_c frozen", "average", 40.66, 38.86, 1e-3),
    ("similarPairNearlyEqual", "ptfeOf12p7mm", "kappa_c frozen", "average", 3600, 3600, 2e-3),
    ("sizeLaw", "radius 0.00635 m", "Gamma", "average", -7.67e5, -7.67e5, 2e-3),
    ("sizeLaw", "radius 0.00635 m", "Gamma", "minimum", -8.03e5, -8.03e5, 2e-3),
    ("sizeLaw", "radius 0.00635 m", "Gamma", "maximum", -7.32e5, -7.32e5, 2e-3),
    ("sizeLaw", "radius 0.00635 m", "saturation charge", "average", None, -3.441e-9, 2e-3),
    ("sizeLaw", "radius 0.00635 m", "kappa_c", "average", 20.0, 20.0, 3e-3),
    ("sizeLaw", "radius 0.00635 m", "kappa_c", "minimum", 12.0, 12.0, 7e-3),
    ("sizeLaw", "radius 0.00635 m", "kappa_c", "maximum", 35.5, 35.5, 2e-3),
    ("sizeLawOfMeasurements", "small", "kappa_c", "average", 27.2, 27.2, 2e-3),
    ("sizeLawOfMeasurements", "large", "kappa_c", "average", 19.7, 19.7, 2e-3),
    ("sizeLawOfMeasurements", "radius 0.00357 m", "Gamma", "average", -9.62e5, -9.62e5, 5e-3),
]
BRANCHES = {"sizeLaw": {"R19"}, "sizeLawOfMeasurements": {"R19", "particleWall"}}   # of the other examples: their own names


def rows_of(example):
    with open(pathlib.Path("postProcessing") / example / "parameters.csv", newline="") as file:
        return list(csv.DictReader(file))


def main():
    found = {folder.name: rows_of(folder.name) for folder in sorted(pathlib.Path("postProcessing").iterdir())}
    failed = [name for name, rows in found.items() if {row["branch"] for row in rows} != BRANCHES.get(name, {name})]
    for name in failed:
        print(f"{name}: took another branch, {({row['branch'] for row in found[name]})}")
    print(f"{'example':26s}{'of':18s}{'quantity':20s}{'column':9s}{'R':>11s}{'stated':>12s}{'found':>13s}  difference")
    for example, name, quantity, column, printed, stated, tolerance in EXPECTED:
        value = next(float(row[column]) for row in found[example] if (row["from"], row["quantity"]) == (name, quantity))
        off = value/stated - 1
        good = abs(off) <= tolerance
        failed += [] if good else [quantity]
        print(f"{example:26s}{name:18s}{quantity:20s}{column:9s}{'-' if printed is None else format(printed, 'g'):>11s}"
              f"{stated:12.4g}{value:13.5g}  {100*off:+.2f} %  {'ok' if good else 'FAILED'}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
