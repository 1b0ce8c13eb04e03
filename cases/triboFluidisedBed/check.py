#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""What the runs of one size have found: pressure drop over weight, charge per mass and its saturation, the wall layer; draws them.
Exit code 1 when the uncharged bed does not carry its weight, a charge book does not close, or what the paper says (findings.py) is not so. Usage: check.py small|medium|full"""

import glob
import os
import sys

import numpy as np

import faster_charging
from findings import findings
from runs import Run, read

def line(run, weight, uncharged):
    bed = run.bed
    drop = run.late("pressureDrop")
    text = (f"{run.name:18}  {drop:8.2f} Pa  {100*(drop/uncharged - 1):+7.2f} %  {1e6*run.late('chargePerMass'):9.2f} uC/kg"
            f"  {run.late('wallParticles'):8.1f}  {100*run.late('wallShare'):7.1f} %  {run.late('wallSpeed'):8.4f} m/s")
    if run.acceleration:
        text += f"  {run.segregation():6.2f}"
    if run.acceleration and not run.uniform:
        text += f"  saturates at {1e6*bed['saturation'][-1]:.2f} uC/kg, tau {bed['tau'][-1]:.2f} s of a t"
    return text


def holds(so):
    """Whether a finding does not speak against the paper: it is so, or nothing was expected. numpy's False is not Python's."""
    return so is None or bool(so)


def draw(size, runs, weight):
    import matplotlib.pyplot as plt
    figure, axes = plt.subplots(1, 3, figsize=(13, 3.8), constrained_layout=True)
    for number, run in enumerate(runs):
        colour = f"C{number}"
        if run.acceleration and not run.uniform:
            axes[0].plot(run.bed["chargingTime"], 1e6*run.bed["chargePerMass"], lw=1, label=run.name, color=colour)
        width = min(50, len(run.time))      # samples of 1 ms
        smooth = np.convolve(run.bed["pressureDrop"], np.ones(width)/width, mode="valid")
        axes[1].plot(run.time[width - 1:], smooth/weight, lw=1, label=run.name, color=colour)
        axes[2].plot(run.time, run.bed["wallParticles"], lw=0.6, label=run.name, color=colour)
    axes[0].set(xlabel="charging time a t [s]", ylabel="charge per mass [uC/kg]")
    axes[1].set(xlabel="time [s]", ylabel="pressure drop over weight/area, mean of 0.05 s", ylim=(0, 1.3))
    axes[2].set(xlabel="time [s]", ylabel="particles in the wall layer")
    for axis in axes:
        if axis.get_legend_handles_labels()[1]:
            axis.legend(fontsize=7)
    figure.savefig(f"doc/{size}.png", dpi=120)


def main():
    size = sys.argv[1]
    folders = sorted(folder for folder in glob.glob(f"runs/{size}/*") if os.path.isdir(f"{folder}/postProcessing"))
    runs = [Run(folder) for folder in folders]
    base = [run for run in runs if not run.acceleration][0]
    buoyant = 1 - 1.149/960
    weight = base.bed["weight"][-1]*buoyant/(2*base.half_width())**2
    uncharged = base.late("pressureDrop", 0.3)
    off = uncharged/weight - 1
    ok = abs(off) <= 0.03
    print(f"{int(base.bed['particles'][-1])} particles, weight/area {weight:.2f} Pa, uncharged pressure drop {uncharged:.2f} Pa, "
          f"{100*off:+.2f} %: {'ok' if ok else 'FAILED'}")
    print("run                 drop          to uncharged  charge             at wall   weight on walls  RMS speed there  charge at walls / inside")
    for run in runs:
        print(line(run, weight, uncharged))
        if run.charge is not None:
            worst = np.max(np.abs(run.charge["closureError"]))/np.max(np.abs(run.charge["total"]))
            if worst > 1e-9:
                ok = False
                print(f"    the books are off by {worst:.1e}: FAILED")
        gas = read(f"runs/{size}/{run.name}", "gas/*/gas.dat")
        steps = (gas["Time"][-1] - gas["Time"][0])/np.mean(gas["deltaT"])
        # The gas is ahead by what its last solve gave; anything that piled up would show.
        ahead = np.sqrt(sum((gas["given" + axis] - gas["got" + axis])**2 for axis in "XYZ"))
        one = np.sqrt(sum(gas["force" + axis]**2 for axis in "XYZ"))*gas["deltaT"]
        worst = ahead[-1]/np.mean(one)
        print(f"    momentum: after {steps:.0f} gas steps the gas is ahead of the particles by {worst:.2f} steps' exchange: "
              f"{'ok' if worst < 2 else 'FAILED'}")
        ok = ok and worst < 2
    for sentence, so in findings(runs, base):
        print(f"{sentence}: {'as found' if so is None else 'ok' if so else 'FAILED'}")
        ok = ok and holds(so)
    os.makedirs("doc", exist_ok=True)
    draw(size, [run for run in runs if not run.leap], weight)
    faster_charging.report(runs, size)
    return 0 if ok else 1


if __name__ == "__main__":
    sys.exit(main())
