#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bed height and pressure drop of himFoam against DPMFoam's from the same fluidised state, as time means; exit code 1 when one is off.
The first 5 ms are left out: both programs start with a jump of the pressure. DPMFoam's numbers are those of runs/dpmFoam, else the
record in dpmFoam.csv.

    check.py            compares, and draws doc/comparison.png
    check.py -record    writes dpmFoam.csv from runs/dpmFoam
    check.py -speed     seconds per simulated second from runs/speed*"""

import glob
import os
import re
import sys

import numpy as np

LIMIT = 0.1
DENSITY, GRAVITY, COLUMN = 1.2, 9.81, 0.45          # gas [kg/m3], [m/s2], height of the column [m]
AREA = 0.015*0.15                                   # [m2]
WEIGHT = 24750*np.pi/6*2.5e-3**3*(2526 - DENSITY)*GRAVITY/AREA      # [Pa]
RECORD = "dpmFoam.csv"


def numbers(paths):
    """Rows of tables of OpenFOAM, in the order of time; where a run was continued, the later one holds."""
    rows = {}
    for path in sorted(paths, key=lambda p: float(p.split("/")[-2])):
        with open(path) as file:
            new = np.array([line.split() for line in file if not line.startswith("#")], float)
        rows = {time: row for time, row in rows.items() if time < new[0, 0]}
        rows.update({row[0]: row for row in new})
    return np.array(list(rows.values()))


def him_foam():
    """Time [s], gas step [s], pressure drop [Pa] and mean height of the centres [m] of every step from the fluidised state on."""
    with open("runs/himFoam/state") as file:
        start = float(file.read())
    paths = [path for path in glob.glob("runs/himFoam/postProcessing/gas/*/gas.dat") if float(path.split("/")[-2]) >= start]
    with open(paths[0]) as file:
        names = [line for line in file if line.startswith("# Time")][0][2:].split()
    rows = numbers(paths)
    return {"time": rows[:, 0], "step": rows[:, names.index("deltaT")],
            "drop": rows[:, names.index("p_bottom")] - rows[:, names.index("p_top")], "centre": rows[:, names.index("massCentreZ")]}


def mean_centre(path):
    """[m], of the positions that DPMFoam wrote."""
    with open(path) as file:
        found = re.findall(r"(?m)^\(\S+ \S+ (\S+)\) \d", file.read())
    return np.mean(np.array(found, float))


def dpm_foam_run():
    """Rows of time [s], pressure drop since the row before [Pa], mean height of the centres [m]."""
    steps = numbers(glob.glob("runs/dpmFoam/postProcessing/inlet/*/surfaceFieldValue.dat"))
    # Its pressure is over the density and holds the weight of the gas.
    drop = DENSITY*(steps[:, 1] - GRAVITY*COLUMN)
    written = [path.split("/")[-4] for path in glob.glob("runs/dpmFoam/*/lagrangian/kinematicCloud/positions")]
    rows = []
    for time in sorted(written, key=float):
        within = (steps[:, 0] > (rows[-1][0] if rows else np.inf) + 1e-7) & (steps[:, 0] < float(time) + 1e-7)
        rows.append((float(time), np.mean(drop[within]) if rows else np.nan,
                     mean_centre(f"runs/dpmFoam/{time}/lagrangian/kinematicCloud/positions")))
    return np.array(rows)


def dpm_foam():
    if os.path.isdir("runs/dpmFoam"):
        return dpm_foam_run()
    return np.genfromtxt(RECORD, delimiter=",", comments="#")


def record():
    with open(RECORD, "w") as file:
        file.write("# DPMFoam v1912 from himFoam's state at the first time. SPDX-License-Identifier: GPL-3.0-or-later\n"
                   "# time [s], mean pressure drop since the row before [Pa], mean height of the centres [m]\n")
        for time, drop, centre in dpm_foam_run():
            file.write(f"{time:.6g},{drop:.5g},{centre:.6g}\n")


def time_mean(times, values):
    return np.trapz(values, times)/(times[-1] - times[0])


def rows_of(him, times):
    """Pressure drop of himFoam between neighbouring times."""
    drops = [np.nan]
    for begin, end in zip(times, times[1:]):
        within = (him["time"] > begin) & (him["time"] <= end + 1e-9)
        drops.append(np.average(him["drop"][within], weights=him["step"][within]))
    return np.array(drops)


def draw(him, dpm):
    import matplotlib.pyplot as plt
    figure, axes = plt.subplots(2, sharex=True, figsize=(6.5, 6), constrained_layout=True)
    times = dpm[:, 0]
    middle = (times[1:] + times[:-1])/2
    axes[0].plot(middle, rows_of(him, times)[1:], "o-", ms=3, label="himFoam")
    axes[0].plot(middle, dpm[1:, 1], "s-", ms=3, label="DPMFoam")
    axes[0].axhline(WEIGHT, color="k", ls=":", lw=1, label="weight/area")
    axes[0].set(ylabel="pressure drop [Pa]", ylim=(0, None))
    axes[1].plot(times, 2e3*np.interp(times, him["time"], him["centre"]), "o-", ms=3, label="himFoam")
    axes[1].plot(times, 2e3*dpm[:, 2], "s-", ms=3, label="DPMFoam")
    axes[1].set(xlabel="time [s]", ylabel="bed height (twice the centres') [mm]")
    for one in axes:
        one.legend()
    os.makedirs("doc", exist_ok=True)
    figure.savefig("doc/comparison.png", dpi=130)


def compare():
    him, dpm = him_foam(), dpm_foam()
    times = dpm[:, 0]
    if him["time"][-1] < times[-1] - 1e-3:
        sys.exit(f"himFoam ends at {him['time'][-1]} s, DPMFoam at {times[-1]} s")
    if len(times) < 3:
        sys.exit(f"DPMFoam has written {len(times)} states; a comparison needs 3")
    late, steps = times[1:], np.diff(times[1:])         # row 1 ends the first 5 ms
    heights = 2e3*np.interp(late, him["time"], him["centre"]), 2e3*dpm[1:, 2]
    drops = rows_of(him, times)[2:], dpm[2:, 1]
    pairs = (("bed height [mm]", *(time_mean(late, one) for one in heights)),
             ("pressure drop [Pa]", *(np.average(one, weights=steps) for one in drops)))
    print(f"time means from {late[0]:.4g} to {late[-1]:.4g} s; weight/area {WEIGHT:.0f} Pa")
    print(f"height at the end {heights[0][-1]:.1f} and {heights[1][-1]:.1f} mm, at the start {2e3*dpm[0, 2]:.1f} mm")
    print(f"{'':20}{'himFoam':>10}{'DPMFoam':>10}  difference")
    ok = True
    for name, found, expected in pairs:
        good = abs(found/expected - 1) <= LIMIT
        ok = ok and good
        print(f"{name:20}{found:10.1f}{expected:10.1f}{100*(found/expected - 1):+10.2f} %  {'ok' if good else 'FAILED'}")
    draw(him, dpm)
    return 0 if ok else 1


def cost(log):
    """CPU seconds per simulated second between the first step and the last."""
    with open(log) as file:
        text = file.read()
    times = np.array(re.findall(r"(?m)^Time = (\S+)", text), float)
    spent = np.array(re.findall(r"(?m)^ExecutionTime = (\S+) s", text), float)
    count = min(len(times), len(spent))
    return (spent[count - 1] - spent[0])/(times[count - 1] - times[0])


def speed():
    costs = {}
    for name, program in (("speedHimFoam", "himFoam"), ("speedDpmFoam", "DPMFoam")):
        costs[program] = [cost(path) for path in sorted(glob.glob(f"runs/{name}[0-9]*/log.{program}"))]
        print(f"{program}: " + ", ".join(f"{value:.0f}" for value in costs[program]) + " CPU s per simulated second")
    ratio = np.mean(costs["DPMFoam"])/np.mean(costs["himFoam"])
    good = ratio >= 15
    print(f"himFoam is {ratio:.0f} times faster  {'ok' if good else 'FAILED'}")
    return 0 if good else 1


if __name__ == "__main__":
    if "-record" in sys.argv:
        record()
    sys.exit(speed() if "-speed" in sys.argv else compare())
