#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Gamma for a wanted charge per mass, interpolated between preliminary runs (Sippola et al. 2018, section 4.3).

    calibrateGamma -runs runs.dat -target 5e-5 [-target 8e-5 ...]

runs.dat has one line per run, `#` starts a comment:

    <Gamma [V/m]> <saturated charge per mass [C/kg]>
    <Gamma [V/m]> <charge.dat> [<charge.dat> ...] <mass [kg]>

For the second kind the saturated charge is that of the curve Q_0 + Q_inf (1 - exp(-a (t - t_0)/tau)) (S6.1) fitted to the columns
Time and total; t_0 and Q_0 are those of the last line before the charge begins to change. A run that was continued has a file for
every time it started from; name them all, of times that two of them hold the later start counts. Gamma is interpolated linearly between the runs whose charges enclose the target; beyond all runs it is extrapolated
from the last two, and the line says so.
"""

import argparse
import math
import pathlib
import sys


class Fault(Exception):
    pass


def fitted_limit(times, charges):
    """Q_inf of S6.1 by least squares: linear in Q_inf, golden section over the rate a/tau after a scan."""
    points = [(t, q) for t, q in zip(times, charges) if t > 0]
    if len(points) < 3:
        raise Fault("fewer than three lines after the charge begins to change")

    def trial(rate):
        shape = [-math.expm1(-rate * t) for t, _ in points]
        limit = sum(f * q for f, (_, q) in zip(shape, points)) / sum(f * f for f in shape)
        return sum((q - limit * f)**2 for f, (_, q) in zip(shape, points)), limit

    slow, fast = 0.01 / max(t for t, _ in points), 100 / min(t for t, _ in points)
    step = math.log(fast / slow) / 200
    best = min(range(201), key=lambda n: trial(slow * math.exp(n * step))[0])
    if best in (0, 200):
        raise Fault("the charge shows no saturation yet; run longer")
    low, high = (best - 1) * step, (best + 1) * step
    golden = 0.5 * (math.sqrt(5) - 1)
    while high - low > 1e-12:
        a, b = high - golden * (high - low), low + golden * (high - low)
        if trial(slow * math.exp(a))[0] < trial(slow * math.exp(b))[0]:
            high = b
        else:
            low = a
    rate = slow * math.exp(0.5 * (low + high))
    limit = trial(rate)[1]
    if rate * max(t for t, _ in points) < 1:
        raise Fault("the run ends before its charging time, tau/a = %g s; run longer" % (1 / rate))
    return limit


def lines_of(file):
    """Time [s] and total charge [C] of every line of a charge.dat."""
    lines = file.read_text().splitlines()
    titles = [line for line in lines if line.startswith("#")]
    names = titles[-1][1:].split() if titles else []
    if "Time" not in names or "total" not in names:
        raise Fault("%s has no columns Time and total" % file.name)
    time, total = names.index("Time"), names.index("total")
    rows = [line.split() for line in lines if line.strip() and not line.startswith("#")]
    if not rows:
        raise Fault("%s has no lines" % file.name)
    return [(float(row[time]), float(row[total])) for row in rows]


def joined(parts):
    """One series from those of the starts of a run: what comes after a later start counts from that start alone."""
    series = []
    for part in sorted(parts):
        series = [line for line in series if line[0] < part[0][0]] + part
    return series


def charge_of_run(files, mass):
    series = joined([lines_of(file) for file in files])
    begin = 0
    while begin + 1 < len(series) and series[begin + 1][1] == series[0][1]:
        begin += 1
    first_time, first_charge = series[begin]
    return (first_charge + fitted_limit([t - first_time for t, _ in series], [q - first_charge for _, q in series])) / mass


def read_runs(path):
    runs, faults = [], []
    for number, line in enumerate(path.read_text().splitlines(), 1):
        words = line.split("#")[0].split()
        if not words:
            continue
        try:
            if len(words) == 2:
                runs.append((float(words[1]), float(words[0])))
            elif len(words) > 2:
                mass = float(words[-1])
                if not mass > 0:
                    raise Fault("a mass of %s kg is not positive" % words[-1])
                runs.append((charge_of_run([path.parent / word for word in words[1:-1]], mass), float(words[0])))
            else:
                raise Fault("found one word; allowed are 2 (Gamma, charge per mass) or 3 and more (Gamma, charge.dat ..., mass)")
        except (Fault, ValueError, OSError, IndexError) as fault:
            faults.append("%s: line %d: %s" % (path, number, fault))
    if not faults and len({charge for charge, _ in runs}) < 2:
        faults.append("%s: at least two runs with different charges are needed, found %d run(s)" % (path, len(runs)))
    if faults:
        raise Fault("\n".join(faults))
    return sorted(runs)


def gamma_for(target, runs):
    """Gamma [V/m] and whether it lies within the runs. Linear between neighbours by charge."""
    inside = runs[0][0] <= target <= runs[-1][0]
    for (q0, g0), (q1, g1) in zip(runs, runs[1:]):
        if target <= q1 or (q1, g1) == runs[-1]:
            if q1 == q0:
                continue
            return g0 + (g1 - g0) * (target - q0) / (q1 - q0), inside
    raise Fault("two runs have the same charge per mass and no other Gamma to go on from")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-runs", required=True, type=pathlib.Path, help="table of preliminary runs")
    parser.add_argument("-target", required=True, type=float, action="append", help="wanted charge per mass [C/kg]")
    words = sys.argv[1:]
    for n in range(len(words) - 1, 0, -1):
        if words[n - 1] == "-target":  # argparse takes -5e-6 for an option
            words[n - 1:n + 1] = ["-target=" + words[n]]
    options = parser.parse_args(words)
    try:
        runs = read_runs(options.runs)
        print("# charge per mass [C/kg]   Gamma [V/m]")
        for charge, gamma in runs:
            print("# run: %.6g %.6g" % (charge, gamma))
        for target in options.target:
            gamma, inside = gamma_for(target, runs)
            print("%.8g %.8g%s" % (target, gamma, "" if inside else "  # extrapolated beyond the runs"))
    except (Fault, OSError) as fault:
        sys.exit("calibrateGamma: %s" % fault)


if __name__ == "__main__":
    main()
