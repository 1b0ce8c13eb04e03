#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""How wide thirteen spheres' charges spread in 2D and 3D when what R does not state is chosen otherwise. Runs the cases
spread/<variant>-<scene> and prints the table of README.md. Usage: spread.py [end time, default 30 s]"""

import re
import sys

import bands

# name: (line of DEM/in.shaker, what it becomes)
VARIANTS = {
    "as in README.md": None,
    "restitution 0.5": (r"(coefficientRestitution peratomtypepair 2) .*", r"\1 0.5 0.5 0.5 0.5"),
    "restitution 0.95": (r"(coefficientRestitution peratomtypepair 2) .*", r"\1 0.95 0.95 0.95 0.95"),
    "friction 0.5": (r"(coefficientFriction +peratomtypepair 2) .*", r"\1 0.5 0.5 0.5 0.5"),
    "amplitude 0.5 mm": (r"1\.0e-3\*188", "0.5e-3*188"),
    "amplitude 2 mm": (r"1\.0e-3\*188", "2.0e-3*188"),
    "kappa 360 among spheres": ("kappa 3600", "kappa 360"),
    "no charge between spheres": ("kappa 3600", "kappa 0"),
}


def spreads(variant, change, scene, end):
    """Most less least charged sphere [nC] over the last third of the run, and over 0.5 to 2 s; the mean charge over the last third."""
    text = bands.script(*bands.SCENES[scene], *bands.PARAMETERS[12.7]["average"])
    if change:
        text, count = re.subn(*change, text)
        if count == 0:
            raise SystemExit(f"DEM/in.shaker has no '{change[0]}'; spread.py must be adapted")
    columns = bands.run_case(f"spread/{variant.replace(' ', '-')}-{scene}", bands.SCENES[scene][0], text, "self", end)
    time, width = columns["Time"], bands.NANO*(columns["max"] - columns["min"])
    late, early = time >= end*2/3, (time > 0.5) & (time <= 2)
    return width[late].mean(), width[early].mean(), bands.NANO*columns["mean"][late].mean()


def main():
    end = float(sys.argv[1]) if len(sys.argv) > 1 else 30.0
    print("| set-up | 3D | 2D | 2D over 3D | mean of 2D over 3D |\n|---|---|---|---|---|")
    for variant, change in VARIANTS.items():
        three, two = (spreads(variant, change, scene, end) for scene in ("3d-13x12.7", "2d-13x12.7"))
        ratio = f"{two[0]/three[0]:.1f}" if three[0] > 0.01 else "without bound"
        print(f"| {variant} | {three[0]:.2f} ({three[1]:.2f}) | {two[0]:.2f} ({two[1]:.2f}) | {ratio} ({two[1]/three[1]:.1f}) | {two[2]/three[2]:.2f} |",
              flush=True)


if __name__ == "__main__":
    main()
