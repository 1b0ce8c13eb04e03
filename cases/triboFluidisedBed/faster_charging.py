# SPDX-License-Identifier: GPL-3.0-or-later
"""Ways to charge faster than plain a = 1, accelerated and projective, beside a plain run at the same charging time: time and error."""

import glob
import pathlib
import re
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from lagrangianCloud import charges  # noqa: E402

CLOSE = 0.01        # [1] states are compared that lie so near the same charging time


def written(run):
    """Times [s] of the written states after the start, in order, with their folders."""
    states = [(float(folder.rsplit("/", 1)[-1]), folder) for folder in glob.glob(f"{run.folder}/[0-9]*")]
    return sorted(state for state in states if state[0] > run.begin())


def state_at(run, charging_time):
    """Time [s] and charges [C] of the state written next to a charging time [s]; None where that is not close."""
    time, folder = min(written(run), key=lambda state: abs(run.charging_time_at(state[0]) - charging_time), default=(0, ""))
    if not folder or abs(run.charging_time_at(time)/charging_time - 1) > CLOSE:
        return None
    return time, charges(folder)


def processor_time(run, time):
    """Processor time [s] from the start of charging to a time [s]; nan where the log holds a later part of the run only."""
    with open(f"{run.folder}/log.himFoam") as file:
        stamps = re.findall(r"^Time = (\S+)$|^ExecutionTime = (\S+) s", file.read(), re.M)
    times, costs, now = [], [], np.nan
    for at, cost in stamps:
        if at:
            now = float(at)
        elif np.isfinite(now):
            times.append(now)
            costs.append(float(cost))
    interval = times[0] - run.begin() if times else np.inf        # of the log
    first = times and interval < 0.25*(time - run.begin())
    return float(np.interp(time, times, costs)) if first and times[-1] > time - interval else np.nan


class Way:
    """A run's charges at a charging time."""

    def __init__(self, run, charging_time, time, charge):
        self.run, self.charge = run, np.sort(charge)
        self.name = "plain" if run.acceleration*(1 + run.leap) == 1 else f"leap {run.leap}" if run.leap else f"a = {run.acceleration:g}"
        self.cost = processor_time(run, time)
        self.mean = self.charge.mean()
        self.spread = self.charge.std()/self.mean
        self.segregation = run.segregation(charging_time)
        since = time - 0.2*(time - run.begin())
        self.layer = np.mean(run.bed["wallParticles"][(run.time >= since) & (run.time <= time + 1e-3)])     # samples of 1 ms

    def beside(self, plain):
        """Relative deviations from a plain run: mean charge, spread over mean, charge at walls over inside, particles at the walls, and the
        mean difference between the n-th largest charges (Wasserstein's distance) over the mean."""
        return dict(mean=self.mean/plain.mean - 1, spread=self.spread/plain.spread - 1, segregation=self.segregation/plain.segregation - 1,
                    layer=self.layer/plain.layer - 1, distribution=np.mean(np.abs(self.charge - plain.charge))/plain.mean)


def indicator(run):
    """Mean and largest error that a projective run has seen itself. Before the first leap nothing was assumed."""
    errors = run.leaps["error"][1:]
    return (np.mean(errors), np.max(errors)) if len(errors) else (np.nan, np.nan)


def ways(runs):
    """Every e/g with a plain run that has written a state: its charging time, the plain way, the others."""
    for plain in (run for run in runs if run.acceleration == 1 and not run.leap and not run.uniform):
        if not written(plain):
            print(f"{plain.name}: no state was written, nothing is compared with it")
            continue
        charging_time = plain.charging_time_at(written(plain)[-1][0])
        others = []
        for run in sorted((run for run in runs if run.strength == plain.strength and run is not plain and not run.uniform and run.hangs_since() is None),
                          key=lambda run: (run.leap, run.acceleration)):
            state = state_at(run, charging_time)
            if state is None:
                print(f"{run.name}: no state was written within {100*CLOSE:g} % of a t = {charging_time:.2f} s, not compared")
            else:
                others.append(Way(run, charging_time, *state))
        yield plain.strength, charging_time, Way(plain, charging_time, *state_at(plain, charging_time)), others


def report(runs, size):
    """Prints time against error of every way, and draws it."""
    for strength, charging_time, plain, others in ways(runs):
        print(f"\nFaster charging, e/g = {strength:g}, a t = {charging_time:.1f} s: deviations from plain a = 1")
        print(f"{'':10}{'CPU [s]':>9}{'faster':>8}{'mean':>9}{'spread/mean':>13}{'walls/inside':>14}{'at walls':>10}{'distribution':>14}")
        print(f"{plain.name:10}{plain.cost:9.0f}{1:8.1f}{1e15*plain.mean:6.1f} fC{plain.spread:13.2f}{plain.segregation:14.2f}{plain.layer:10.0f}")
        for way in others:
            off = way.beside(plain)
            print(f"{way.name:10}{way.cost:9.0f}{plain.cost/way.cost:8.1f}{100*off['mean']:+8.1f}%{100*off['spread']:+12.1f}%{100*off['segregation']:+13.1f}%"
                  f"{100*off['layer']:+9.1f}%{100*off['distribution']:13.1f}%" + ("   its indicator: mean %.2f, largest %.2f" % indicator(way.run) if way.run.leap else ""))
        if others:
            draw(plain, others, f"doc/{size}-faster-eg{strength:g}.png")


def draw(plain, others, path):
    import matplotlib.pyplot as plt
    from matplotlib.ticker import LogLocator, ScalarFormatter
    figure, axes = plt.subplots(1, 3, figsize=(13, 3.8), constrained_layout=True)
    for axis, key, label in ((axes[0], "spread", "spread over mean"), (axes[1], "distribution", "distribution")):
        for kind, mark in (("accelerated", "o-"), ("projective", "s-")):
            those = [way for way in others if bool(way.run.leap) == (kind == "projective")]
            axis.plot([plain.cost/way.cost for way in those], [100*abs(way.beside(plain)[key]) for way in those], mark, label=kind)
        axis.set(xlabel="times as fast as plain", ylabel=f"deviation of the {label} [%]", xscale="log", ylim=(0, None))
        axis.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
        axis.xaxis.set_major_formatter(ScalarFormatter())
        axis.minorticks_off()
        axis.legend(fontsize=7)
    for way in [plain, *others]:
        axes[2].plot(1e15*way.charge, np.linspace(0, 1, len(way.charge)), lw=2 if way is plain else 1, ls="--" if way.run.leap else "-",
                     color="k" if way is plain else None, label=way.name)
    axes[2].set(xlabel="charge [fC]", ylabel="share of particles below", xlim=(0, 1e15*np.quantile(plain.charge, 0.99)))
    axes[2].legend(fontsize=7)
    figure.savefig(path, dpi=120)
