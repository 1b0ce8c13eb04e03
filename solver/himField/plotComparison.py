#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws speed against error from the table of himField -compare: plotComparison.py compare.csv [title]

Writes compare.png and compare.svg beside the table. Down and to the left is better. A line joins the variants of one method.
"""

import csv
import pathlib
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

MARKERS = {"him": "s", "himCell": "D", "p3m": "o", "pairwiseSum": "^", "directTruncation": "v", "hybridParticleCell": "P"}


def read(path):
    with open(path, newline="") as file:
        rows = [row for row in csv.DictReader(file) if not row["left_out"]]
    for row in rows:
        row["seconds"] = float(row["warm_total_s"])
        row["error"] = float(row["rms_error"])
    return [row for row in rows if row["seconds"] > 0 and row["error"] > 0]


def draw(axes, rows, unit=1, unit_name="seconds"):
    """One marker per row: warm time of a field against its RMS error."""
    for method in dict.fromkeys(row["fieldMethod"] for row in rows):
        mine = sorted((row for row in rows if row["fieldMethod"] == method), key=lambda row: row["error"])
        points = [(row["seconds"] / unit, row["error"]) for row in mine]
        axes.plot(*zip(*points), marker=MARKERS.get(method, "x"), linestyle=":", label=method)
        for row, point in zip(mine, points):
            axes.annotate(row["name"], point, textcoords="offset points", xytext=(5, 4), fontsize=7)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel(unit_name + " per field")
    axes.set_ylabel("RMS field error, relative")
    axes.grid(True, which="major", alpha=0.4)


def main(path, title=""):
    path = pathlib.Path(path)
    rows = read(path)
    if not rows:
        sys.exit("%s: no method has both a time and an error" % path)
    figure, axes = plt.subplots(figsize=(7, 5), constrained_layout=True)
    draw(axes, rows)
    axes.set_title(title or "%s particles, %s rank(s)\n%s" % (rows[0]["particles"], rows[0]["ranks"], rows[0]["mesh"][:100]),
                   fontsize=9)
    axes.legend(fontsize=8)
    for ending in (".png", ".svg"):
        figure.savefig(path.with_suffix(ending), dpi=110)


if __name__ == "__main__":
    main(*sys.argv[1:])
