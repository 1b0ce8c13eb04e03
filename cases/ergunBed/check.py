#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Pressure drop of the bed against gas velocity: below minimum fluidisation against Ergun's equation with the porosity that the
settled spheres have at each height, above it against their weight. Exit code 1 when a number is off."""

import re
import sys

import numpy as np

DIAMETER, DENSITY = 1e-3, 1000
GAS, VISCOSITY, GRAVITY = 1.2, 1.8e-5, 9.81
AREA, LAYER = 25e-6, 2e-3
SETTLED = 0.35              # [s] time at which the gas begins to flow
INSIDE = (3, 30)            # layers whose centres are the two heights inside the bed, those of the probes in system/controlDict


def table(model):
    with open(f"runs/{model}/postProcessing/gas/0/gas.dat") as file:
        lines = file.read().splitlines()
    names = [line for line in lines if line.startswith("# Time")][0][2:].split()
    rows = np.array([[float(word) for word in line.split()] for line in lines if not line.startswith("#")])
    return {name: rows[:, n] for n, name in enumerate(names)}


def weight_of(model):
    """[Pa] of the spheres that fitted in, over the area, buoyancy taken off."""
    return table(model)["solidVolume"][-1]*(DENSITY - GAS)*GRAVITY/AREA


def layers(model, name, time):
    """A written field, one value per layer, from below."""
    with open(f"runs/{model}/{time:.8g}/{name}") as file:
        found = re.search(r"internalField\s+nonuniform List<scalar>\s+\d+\s*\((.*?)\)", file.read(), re.S)
    return np.array(found.group(1).split(), float)


def ergun(speed, voids):
    """[Pa] over layers of spheres, at an empty-column speed [m/s] (Ergun 1952)."""
    solid = 1 - voids
    return LAYER*np.sum(150*solid**2*VISCOSITY*speed/(voids**3*DIAMETER**2)
                        + 1.75*solid*GAS*speed**2/(voids**3*DIAMETER))


def inside(model, speed_at):
    """Deviations from Ergun's equation between two heights inside the packed bed, two layers away from its edges: there the gas
    knows the porosity; at an edge it sees the mean of two layers. Thirteen of them: means of the pressure over the 0.05 s about
    each written time, whose porosity they use. Instants would not do: spheres that shift take momentum from the gas for a moment."""
    probed = np.loadtxt(f"runs/{model}/postProcessing/insidePressure/0/p")
    times, drops = probed[:, 0], probed[:, 1] - probed[:, 2]
    low, high = INSIDE
    weights = np.ones(high - low + 1)
    weights[[0, -1]] = 0.5                                          # from centre to centre
    deviations = []
    for time in np.arange(0.6, 1.21, 0.05):
        about = np.abs(times - time) <= 0.025
        voids = layers(model, "voidFraction", time)[low:high + 1]
        expected = np.mean([sum(w*ergun(speed, np.array([v])) for w, v in zip(weights, voids)) for speed in speed_at(times[about])])
        deviations.append(np.mean(drops[about])/expected - 1)
    return np.array(deviations)


def measure(model):
    rows = table(model)
    weight = weight_of(model)
    speed = rows["in_inlet"]/AREA
    drop = rows["p_inlet"] - rows["p_outlet"]
    voids = layers(model, "voidFraction", SETTLED)
    voids = voids[voids < 0.8]
    speeds = np.linspace(0, 0.5, 5001)
    predicted = np.interp(weight, [ergun(s, voids) for s in speeds], speeds)
    held = rows["Time"] > 1.7
    plateau = np.mean(drop[held])
    # Minimum fluidisation: where the line of the packed bed, drop = b u + c u^2, meets the plateau.
    packed = (speed > 0.2*predicted) & (speed < 0.8*predicted) & (rows["Time"] > SETTLED)
    b, c = np.linalg.lstsq(np.stack([speed[packed], speed[packed]**2], axis=1), drop[packed], rcond=None)[0]
    found = (-b + np.sqrt(b*b + 4*c*plateau))/(2*c)
    rising = (rows["Time"] > SETTLED) & (rows["Time"] < 1.55)
    return {"speed": speed[rising], "drop": drop[rising], "held": drop[held], "voids": voids, "predicted": predicted,
            "inside": inside(model, lambda time: np.interp(time, rows["Time"], speed)),
            "whole": np.mean(drop[packed]/[ergun(s, voids) for s in speed[packed]]) - 1,
            "plateau": plateau/weight - 1, "found": found, "mean": np.mean(voids)}


def draw(found):
    import matplotlib.pyplot as plt
    figure, axes = plt.subplots(figsize=(6.5, 4), constrained_layout=True)
    for (model, m), colour in zip(found.items(), ("tab:blue", "tab:orange")):
        axes.plot(m["speed"], m["drop"], lw=1, color=colour, label=model)
        axes.plot(0.44, np.mean(m["held"]), "o", color=colour, ms=5)
    m = found["modelA"]
    speeds = np.linspace(0, 1.2*m["predicted"], 100)
    axes.plot(speeds, [ergun(s, m["voids"]) for s in speeds], "k--", lw=1, label="Ergun")
    weight = weight_of("modelA")
    axes.axhline(weight, color="k", ls=":", lw=1, label="weight/area")
    axes.set(xlabel="gas velocity of the empty column [m/s]", ylabel="pressure drop [Pa]", xlim=(0, 0.45), ylim=(0, 1.6*weight))
    axes.legend()
    figure.savefig("doc/pressureDrop.png", dpi=130)


def main():
    found = {model: measure(model) for model in ("modelA", "modelB")}
    ok = True
    weight = weight_of("modelA")
    print(f"weight/area {weight:.2f} Pa")
    print("model   mean porosity  inside the bed over Ergun: mean, worst  whole bed over Ergun  plateau over weight  u_mf [m/s]  by Ergun")
    for model, m in found.items():
        good = np.max(np.abs(m["inside"])) <= 0.02 and abs(m["plateau"]) <= 0.02 and abs(m["found"]/m["predicted"] - 1) <= 0.1
        ok = ok and good
        print(f"{model}  {m['mean']:13.3f}  {100*np.mean(m['inside']):+25.2f}, {100*max(m['inside'], key=abs):+.2f} %  {100*m['whole']:+18.2f} %  {100*m['plateau']:+17.2f} %"
              f"  {m['found']:10.4f}  {m['predicted']:8.4f}  {'ok' if good else 'FAILED'}")
    a, b = found["modelA"]["found"], found["modelB"]["found"]
    same = abs(a/b - 1) <= 0.05
    print(f"u_mf of model A over that of model B: {100*(a/b - 1):+.2f} %  {'ok' if same else 'FAILED'}")
    draw(found)
    return 0 if ok and same else 1


if __name__ == "__main__":
    sys.exit(main())
