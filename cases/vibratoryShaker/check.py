#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Compares the shaker's runs with what they must give, prints a result table and fails when a claim does not hold."""

import os
import re
import sys

import numpy as np

import shaker
from exact_field import GroundedCylinder

NANO = 1e9
REPORT_TIMES = (1, 3, 5, 10, 20, 30, 60)        # [s], the times of R section 4.3.2
LONG_RUN = 30                                   # [s]; shorter runs are not asked to saturate

rows = []


def claim(text, measured, allowed, holds):
    rows.append((text, measured, allowed, "ok" if holds else "FAILED"))


def at(columns, name, time):
    return np.interp(time, columns["Time"], columns[name])


def summary(run):
    """The lines of the log's closing summary by name."""
    with open(os.path.join(run, "log.himFoam")) as file:
        text = file.read().rpartition("\nSummary\n")[2]
    return dict(re.findall(r"^    (\S.*?)  +(\S.*)$", text, re.MULTILINE))


def report(name, run, columns):
    end = columns["Time"][-1]
    print(f"\nRun {name}: {end:g} s of shaking")
    for time in REPORT_TIMES:
        if time <= end + 1e-9:
            total = at(columns, "total", time)
            print(f"    bulk charge at {time:3d} s {NANO*total:9.3f} nC   {100*total/(shaker.SPHERES*shaker.Q_SAT):6.2f} % of "
                  f"isolated saturation   particles {NANO*at(columns, 'min', time):.3f} to {NANO*at(columns, 'max', time):.3f} nC")
    for key, value in summary(run).items():
        print(f"    {key:36s}{value}")


def field_error(run):
    """RMS error of the field at the spheres at all written times over the RMS exact field, and the latter [V/m]."""
    cylinder = GroundedCylinder()
    wrong = exact = count = 0
    for time in shaker.write_times(run):
        position, charge, found = (shaker.read_cloud(run, time, field) for field in ("positions", "charge", "electricField"))
        field = cylinder.field(position[:, :3], charge[:, 0])
        wrong, exact, count = wrong + np.sum((found - field)**2), exact + np.sum(field**2), count + len(field)
    return np.sqrt(wrong/exact), np.sqrt(exact/count)


def check(name, run, columns):
    end, total = columns["Time"][-1], columns["total"]
    isolated = shaker.SPHERES*shaker.Q_SAT
    log = summary(run)

    claim(f"{name}: spheres at the end", log["particles"], f"{shaker.SPHERES}", log["particles"] == str(shaker.SPHERES))
    charges = np.maximum(np.abs(total), sum(np.abs(columns[wall]) for wall in ("cyl", "floor", "lid")))
    closure = np.max(np.abs(columns["closureError"]))/charges.max()
    claim(f"{name}: closure error of the books over all charge", f"{closure:.1e}", "<= 1e-12", closure <= 1e-12)
    claim(f"{name}: every sphere charges negatively", f"max {NANO*columns['max'][-1]:.3f} nC", "< 0", columns["max"][-1] < 0)
    claim(f"{name}: bulk charge within isolated saturation (R17)", f"{NANO*total.min():.2f} nC", f">= {NANO*isolated:.2f} + 0.5 %",
          total.min() >= 1.005*isolated)
    # Pair contacts in the field E of the others part two spheres by up to E 4 pi epsilon0 r^2, each by half of it.
    share = np.max(columns["largestField"])/abs(shaker.GAMMA_WALL)/2
    beyond = columns["min"].min()/shaker.Q_SAT
    claim(f"{name}: most charged sphere over isolated saturation", f"{beyond:.3f}", f"<= {1 + share:.3f}", beyond <= 1 + share)

    window = min(2.0, end/8)
    parts = np.array_split(total, int(round(end/window)))
    growth = np.diff([part.mean() for part in parts])/isolated
    # Once saturated the means scatter (chaotic motion); the scatter is that of the second half, by its median, which one fall leaves alone.
    scatter = 1.4826*np.median(np.abs(growth[len(growth)//2:]))
    claim(f"{name}: mean of every {window:g} s beyond that before", f"least {100*growth.min():+.2f} % of isolated",
          f">= -{400*scatter:.2f} % (4 s)", growth.min() >= -4*scatter)
    error, size = field_error(run)
    claim(f"{name}: RMS error of the him field at the spheres", f"{100*error:.0f} % of {1e-3*size:.0f} kV/m", "<= 35 %", error <= 0.35)
    if end < LONG_RUN:
        return
    q_inf, tau, residual = shaker.fit_saturation(columns["Time"], total)
    claim(f"{name}: residual of Q_inf (1 - exp(-t/tau))", f"{100*residual:.1f} % of Q_inf", "<= 3 %", residual <= 0.03)
    print(f"    {name}: Q_inf {NANO*q_inf:.2f} nC, tau {tau:.2f} s, saturation fraction {total[-1]/isolated:.3f} of the isolated "
          f"spheres at {end:g} s")


def main():
    runs = {os.path.basename(run): run for run in (shaker.SELF, shaker.TOTAL) if os.path.isdir(run)}
    history = {name: shaker.charge_history(run) for name, run in runs.items()}
    for name, run in runs.items():
        report(name, run, history[name])
        check(name, run, history[name])
    if len(history) == 2:
        share = history["total"]["total"][-1]/history["self"]["total"][-1]
        claim("the others' field limits charging: total/self", f"{share:.3f}", "< 1", share < 1)
    width = [max(len(row[i]) for row in rows) for i in range(4)]
    print("\n" + "   ".join(h.ljust(w) for h, w in zip(("claim", "measured", "allowed", "result"), width)))
    for row in rows:
        print("   ".join(cell.ljust(w) for cell, w in zip(row, width)))
    return 0 if all(row[3] == "ok" for row in rows) else 1


if __name__ == "__main__":
    sys.exit(main())
