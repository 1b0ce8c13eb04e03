#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares the fall of the sphere with its terminal velocity; exit code 1 when it is off by more than 0.5 %."""

import sys

TERMINAL = 1.0615           # [m/s]


def main():
    with open("postProcessing/gas/0/gas.dat") as file:
        lines = file.read().splitlines()
    names = [line for line in lines if line.startswith("# Time")][0][2:].split()
    rows = [dict(zip(names, map(float, line.split()))) for line in lines if not line.startswith("#")]
    first, last = rows[-41], rows[-1]
    speed = -(last["massCentreZ"] - first["massCentreZ"])/(last["Time"] - first["Time"])
    error = speed/TERMINAL - 1
    print(f"speed in the last {last['Time'] - first['Time']:.3f} s: {speed:.4f} m/s, terminal velocity {TERMINAL} m/s, "
          f"{100*error:+.2f} %: {'ok' if abs(error) <= 0.005 else 'FAILED'}")
    return 0 if abs(error) <= 0.005 else 1


if __name__ == "__main__":
    sys.exit(main())
