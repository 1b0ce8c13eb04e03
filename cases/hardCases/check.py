#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the stability suite, holds every scene to its law and writes runs/report.md and hardCases.png.

Usage: check.py [-short] [-long] [-only contact|bed|headOn|collapse|orbit|wall|sizes|neighbours|limiter|mesh|held|limits]
"""

import sys

import contacts
import energies
import held
import limits
import mesh

SCENES = {
    "contact": contacts.oscillating, "bed": contacts.bed, "headOn": contacts.head_on, "collapse": energies.collapse, "orbit": energies.orbit, "wall": energies.wall,
    "sizes": contacts.sizes, "neighbours": contacts.neighbours, "limiter": energies.limiter, "mesh": mesh.collapse, "held": held.held,
    "limits": limits.limits,
}


class Report:
    """Collects what must hold, tables, and curves for the picture."""

    def __init__(self, short, long, only=None):
        self.short, self.long, self.only = short, long, only
        self.summary, self.details, self.failed, self.curves = [], [], [], {}

    def title(self, text):
        self.details += ["", f"### {text}", ""]

    def table(self, header, rows):
        self.details += ["| " + " | ".join(header) + " |", "|" + "---|"*len(header)]
        self.details += ["| " + " | ".join(map(str, row)) + " |" for row in rows] + [""]

    def note(self, text):
        self.details += [text, ""]

    def must(self, scene, what, found, holds, limit):
        """One line of the summary: what must hold, what was found, the limit."""
        verdict = "holds" if holds else "**FAILED**"
        self.summary.append(f"| {scene} | {what} | {found} | {limit} | {verdict} |")
        if not holds:
            self.failed.append(f"{scene}: {what}: {found}, limit {limit}")

    def text(self):
        lines = ["| scene | what must hold | found | limit | |", "|---|---|---|---|---|"] + self.summary + self.details
        return "\n".join(lines) + "\n"


def draw(curves):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, all_axes = plt.subplots(1, len(curves), figsize=(4.6*len(curves), 4.2))
    for axes, (name, (labels, lines)) in zip(all_axes if len(curves) > 1 else [all_axes], curves.items()):
        for (label, (x, y)), colour in zip(lines.items(), ("#1f5fa8", "#d9772b", "#3f8f5f", "#8a8f98", "#22262e")):
            axes.plot(x, y, "o-", ms=4, lw=1.4, color=colour, label=label)
        axes.set(xscale="log", yscale="log", xlabel=labels[0], ylabel=labels[1])
        axes.set_title(name, loc="left", fontsize=11)
        axes.legend(frameon=False, fontsize=8)
    figure.tight_layout()
    figure.savefig("hardCases.png", dpi=100)
    print("wrote hardCases.png")


def main():
    words = sys.argv[1:]
    only = words[words.index("-only") + 1] if "-only" in words else None
    report = Report("-short" in words, "-long" in words, only)
    if only and only not in SCENES:
        raise SystemExit(f"unknown scene '{only}'; known: {', '.join(SCENES)}")
    for name, scene in SCENES.items():
        if only in (None, name):
            scene(report)
            print(name, "done", flush=True)
    text = report.text()
    with open("runs/report.md", "w") as file:
        file.write(text)
    print("\n" + text)
    for what in report.failed:
        print("FAILED:", what)
    if report.curves and not report.short:
        draw(report.curves)
    return 1 if report.failed else 0


if __name__ == "__main__":
    sys.exit(main())
