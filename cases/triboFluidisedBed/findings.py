# SPDX-License-Identifier: GPL-3.0-or-later
"""What the paper says of the bed, sentence by sentence, against the runs that are there."""

import numpy as np

SAME_RATE = 0.10        # charges at equal a t may differ by this share between accelerations
GOOD_FIT = 0.05         # deviation of S6.1's curve from the charge, root mean square, over the last charge
EARLY = 5.0             # [s] of a t before which a few first contacts make the charge
FROZEN = 0.5            # a layer that stands holds more particles than the uncharged one (a full one not twice as many) at less than this share of its RMS speed
MUCH_MORE = 1.5         # uniform charge loses this many times the pressure drop of as much charge that the walls have given


def same_start(runs):
    """Dynamic runs without leaps by e/g, in order of a, of those that are beds to the end."""
    groups = {}
    for run in sorted((run for run in runs if run.acceleration and not run.uniform and not run.leap and run.hangs_since() is None), key=lambda run: run.acceleration):
        groups.setdefault(run.strength, []).append(run)
    return groups


def charge_at(run, charging_time):
    """Charge per mass [C/kg], mean of 1 s of a t."""
    around = np.abs(run.bed["chargingTime"] - charging_time) < 0.5
    return np.mean(run.bed["chargePerMass"][around])


def independent_of_a(strength, group):
    end = min(run.bed["chargingTime"][-1] for run in group) - 0.5
    worst = 0.0
    for time in np.linspace(EARLY, end, 8):
        charges = [charge_at(run, time) for run in group]
        worst = max(worst, max(charges)/min(charges) - 1)
    names = ", ".join(f"{run.acceleration:g}" for run in group)
    return (f"e/g = {strength:g}: charge at equal a t from {EARLY:g} to {end:.0f} s differs by {100*worst:.1f} % at most between a = {names}",
            worst <= SAME_RATE)


def segregation_grows(strength, group):
    end = min(run.bed["chargingTime"][-1] for run in group)
    ratios = [run.segregation(end) for run in group]
    text = ", ".join(f"{run.acceleration:g}: {ratio:.2f}" for run, ratio in zip(group, ratios))
    return (f"e/g = {strength:g}: charge at the walls over that inside at a t = {end:.0f} s, by a: {text}; grows with a",
            all(a < b for a, b in zip(ratios, ratios[1:])))


def drop_at(run, time):
    """Pressure drop [Pa] of a dynamic run at a time, and its standard error: by a straight line through the 0.5 s before, in which the charge rises."""
    window = (run.time > time - 0.5) & (run.time <= time)
    drop, ago = run.bed["pressureDrop"][window], run.time[window] - time
    if len(drop) < 10:      # a short trial
        return np.nan, np.nan
    line = np.polyfit(ago, drop, 1)
    if len(drop) < 100:
        return line[1], np.nan
    # Bubbles pass for some hundredths of a second: means of 0.05 s know nothing of one another. At its end a line errs twice as much as a mean.
    blocks = np.array_split(drop - np.polyval(line, ago), 10)
    error = 2*np.std([np.mean(block) for block in blocks], ddof=2)/np.sqrt(len(blocks))
    return line[1], error


def findings(runs, base):
    """Sentences and whether each is so (None: nothing was expected)."""
    found = [(f"{run.name}: a plug hangs at the lid from {run.hangs_since():.2f} s on: not judged", None) for run in runs if run.hangs_since() is not None]
    for strength, group in same_start(runs).items():
        for run in group:
            if run.bed["chargingTime"][-1] < 4*EARLY - 0.1:
                found.append((f"{run.name}: a t = {run.bed['chargingTime'][-1]:.0f} s, below {4*EARLY:g} s: fit and wall layer are not judged", None))
                continue
            if np.isfinite(run.bed["tau"][-1]):
                off = run.bed["fitDeviation"][-1]/run.bed["chargePerMass"][-1]
                found.append((f"{run.name}: S6.1 fits the charge to {100*off:.1f} % RMS; {100*run.bed['chargePerMass'][-1]/run.bed['saturation'][-1]:.0f} % of "
                              f"its saturation after {run.bed['chargingTime'][-1]/run.bed['tau'][-1]:.1f} tau", off <= GOOD_FIT))
            else:
                found.append((f"{run.name}: the charge does not bend yet: no fit by S6.1", None))
            layer = run.late("wallParticles")/run.bed["particles"][-1]
            slow = run.late("wallSpeed")/base.late("wallSpeed", 0.3)
            stands = layer > base.late("wallParticles", 0.3)/base.bed["particles"][-1] and slow < FROZEN
            found.append((f"{run.name}: {100*layer:.0f} % of the particles in the wall layer at {slow:.2f} of the uncharged speed: the layer "
                          f"{'stands' if stands else 'moves'}", stands if strength >= 4 else None))
        # A run may end a gas step short of its time.
        if len(group) > 1 and min(run.bed["chargingTime"][-1] for run in group) > 2*EARLY - 0.1:
            found.append(independent_of_a(strength, group))
            found.append(segregation_grows(strength, group))
    for run in runs:
        twin = [other for other in runs if other.name == run.name + "-uniform"]
        if not twin:
            continue
        before = base.late("pressureDrop", 0.3)
        drop, error = drop_at(run, twin[0].time[0])     # the charged run may have gone on since
        lost = [1 - drop/before, 1 - twin[0].late("pressureDrop")/before]
        wide = base.bed["particles"][-1] > 10000     # smaller columns are all wall
        found.append((f"{run.name}: with {1e6*twin[0].bed['chargePerMass'][-1]:.1f} uC/kg dynamic charge loses {100*lost[0]:.1f} +- {100*error/before:.1f} % "
                      f"of the pressure drop, the same charge spread uniformly {100*lost[1]:.1f} %", lost[1] > MUCH_MORE*max(lost[0], 0) if wide else None))
    return found
