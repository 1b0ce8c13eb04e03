#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws a run of the shaker: bulk charge, particle charges, and the container. Usage: draw.py [folder for the pictures]"""

import os
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import ListedColormap, Normalize

import render
import shaker

INK, BLUE, ORANGE, GREY = "#22262e", "#1f5fa8", "#d9772b", "#8a8f98"
plt.rcParams.update({
    "font.size": 11, "axes.edgecolor": INK, "axes.labelcolor": INK, "text.color": INK, "xtick.color": INK,
    "ytick.color": INK, "axes.spines.top": False, "axes.spines.right": False, "axes.grid": True, "grid.color": "#e4e6ea",
    "grid.linewidth": 0.8, "axes.axisbelow": True, "legend.frameon": False, "figure.dpi": 110, "lines.solid_capstyle": "round"})
NANO = 1e9


def thin(columns, points=1500):
    """Every n-th row: a line needs no more points than pixels."""
    step = max(1, len(columns["Time"])//points)
    return {name: column[::step] for name, column in columns.items()}


def binned(column, count, reduce):
    return np.array([reduce(part) for part in np.array_split(column, count)])


def save(figure, folder, name):
    path = os.path.join(folder, name)
    figure.savefig(path, bbox_inches="tight", pad_inches=0.12)
    plt.close(figure)
    print("wrote", path)


def bulk_charge(runs, folder):
    figure, axes = plt.subplots(figsize=(7.4, 4.4))
    for (name, columns), colour in zip(runs.items(), (BLUE, ORANGE)):
        q_inf, tau, _ = shaker.fit_saturation(columns["Time"], columns["total"])
        drawn = thin(columns)
        axes.plot(drawn["Time"], NANO*drawn["total"], color=colour, lw=2.2, label=f"wall contact field {name}")
        axes.plot(drawn["Time"], NANO*q_inf*(1 - np.exp(-drawn["Time"]/tau)), color=INK, lw=1.1, ls=(0, (4, 3)),
                  label=rf"  fit $Q_\infty(1-e^{{-t/\tau}})$:  {NANO*q_inf:.1f} nC,  {tau:.2f} s")
    axes.axhline(NANO*shaker.SPHERES*shaker.Q_SAT, color=GREY, lw=1.4, ls=":",
                 label=f"{shaker.SPHERES} isolated spheres at saturation, {NANO*shaker.SPHERES*shaker.Q_SAT:.1f} nC")
    axes.set(xlabel="time [s]", ylabel="charge of all spheres [nC]", xlim=(0, max(c["Time"][-1] for c in runs.values())))
    axes.set_ylim(NANO*shaker.SPHERES*shaker.Q_SAT*1.06, 0)
    axes.set_title("Thirteen 12.7 mm PTFE spheres in a shaken steel cylinder", loc="left", fontsize=12)
    axes.legend(loc="upper right")
    save(figure, folder, "bulkCharge.png")


def particle_charges(runs, folder):
    figure, all_axes = plt.subplots(1, len(runs), figsize=(4.4*len(runs) + 0.8, 3.8), sharey=True, squeeze=False)
    for axes, (name, columns), colour in zip(all_axes[0], runs.items(), (BLUE, ORANGE)):
        count = min(240, len(columns["Time"]))
        time, mean, low, high = (binned(columns[c], count, np.mean) for c in ("Time", "mean", "min", "max"))
        axes.fill_between(time, NANO*binned(columns["min"], count, np.min), NANO*binned(columns["max"], count, np.max),
                          color=colour, alpha=0.13, lw=0, label="extremes")
        axes.fill_between(time, NANO*low, NANO*high, color=colour, alpha=0.28, lw=0, label="smallest to largest, on average")
        axes.plot(time, NANO*mean, color=colour, lw=2, label="mean")
        axes.axhline(NANO*shaker.Q_SAT, color=GREY, lw=1.4, ls=":", label=f"isolated sphere, {NANO*shaker.Q_SAT:.2f} nC")
        axes.set(xlabel="time [s]", xlim=(0, columns["Time"][-1]))
        axes.set_title(f"wall contact field {name}", loc="left", fontsize=12)
    all_axes[0, 0].legend(loc="upper right", fontsize=10)
    lowest = min(columns["min"].min() for columns in runs.values())
    all_axes[0, 0].set_ylim(NANO*min(lowest, shaker.Q_SAT)*1.04, 0)
    all_axes[0, 0].set_ylabel("charge of a sphere [nC]")
    save(figure, folder, "particleCharge.png")


def container_outline(right):
    """Rims of floor and lid and the two edges seen from a camera with that direction to the right [m]."""
    turn, up = np.linspace(0, 2*np.pi, 720), np.linspace(0, shaker.CONTAINER_HEIGHT, 200)
    for z in (0, shaker.CONTAINER_HEIGHT):
        yield np.column_stack((shaker.CONTAINER_RADIUS*np.cos(turn), shaker.CONTAINER_RADIUS*np.sin(turn), np.full_like(turn, z)))
    for sign in (-1, 1):
        edge = sign*shaker.CONTAINER_RADIUS*right
        yield np.column_stack((np.full_like(up, edge[0]), np.full_like(up, edge[1]), up))


def container(run, folder, time):
    positions, charges, centres, potential = shaker.last_scene(run)
    _, table = render.slice_potential(centres, potential)
    spheres = Normalize(NANO*charges.min(), NANO*charges.max())
    deepest = np.quantile(table, 0.005)     # the cell of a sphere that the slice cuts would outshine the rest
    plane = Normalize(deepest*1e-3, 0)
    sphere_map = plt.get_cmap("plasma")
    plane_map = ListedColormap(plt.get_cmap("Blues_r")(np.linspace(0, 1, 256)**1.6))    # darker in the middle
    levels = np.linspace(deepest, 0, 13)[1:-1]
    image, depth, camera = render.picture(positions, NANO*charges, centres, potential*1e-3,
                                          lambda q: np.array(sphere_map(spheres(q))), lambda v: plane_map(plane(v)), levels*1e-3)
    height, width = image.shape[:2]
    figure = plt.figure(figsize=(width/110 + 1.9, height/110))
    axes = figure.add_axes([0, 0, width/110/(width/110 + 1.9), 1])
    axes.imshow(np.round(63*image)/63, interpolation="nearest")     # 6 bits a channel: half the file, no visible bands
    axes.axis("off")
    for outline in container_outline(camera.right):
        column, row = camera.pixel(outline)
        axes.plot(column, np.where(camera.hidden(outline, depth), np.nan, row), color=INK, lw=1.2, alpha=0.8)
    axes.set_xlim(0, width)
    axes.set_ylim(height, 0)
    left = width/110/(width/110 + 1.9) + 0.01
    for bottom, norm, colours, label in ((0.53, spheres, sphere_map, "charge of a sphere [nC]"),
                                         (0.09, plane, plane_map, "mesh potential on the slice [kV]")):
        bar = figure.colorbar(ScalarMappable(norm, colours), extend="min" if norm is plane else "neither", cax=figure.add_axes([left, bottom, 0.03, 0.36]))
        bar.set_label(label)
        bar.outline.set_linewidth(0.6)
    figure.text(0.02, 0.965, f"t = {time:g} s", fontsize=13)
    save(figure, folder, "container.png")


def main():
    folder = sys.argv[1] if len(sys.argv) > 1 else "."
    os.makedirs(folder, exist_ok=True)
    runs = {os.path.basename(run): shaker.charge_history(run) for run in (shaker.SELF, shaker.TOTAL) if os.path.isdir(run)}
    bulk_charge(runs, folder)
    particle_charges(runs, folder)
    container(shaker.SELF, folder, runs["self"]["Time"][-1])


if __name__ == "__main__":
    main()
