#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Tables of the halving study: bulk charge against field update interval, three seeds each. Reads study/<field>-<ms>ms-<seed>/."""

import os
import re
import sys

import numpy as np

import shaker


def main():
    runs = {}
    for folder in os.listdir("study"):
        name = re.fullmatch(r"(self|total)-(\d+)ms-(\d+)", folder)
        if name:
            seeds = runs.setdefault(name[1], {}).setdefault(int(name[2]), {})
            seeds[int(name[3])] = shaker.charge_history(os.path.join("study", folder))
    for field, intervals in sorted(runs.items()):
        end = min(columns["Time"][-1] for seeds in intervals.values() for columns in seeds.values())
        names = sorted(intervals[min(intervals)])
        print(f"\nwallContactField {field}: bulk charge [nC] after {end:g} s\n")
        print("| deltaT | " + " | ".join(f"seed {seed}" for seed in names) + " | mean | scatter of seeds | change on halving |")
        print("|---|" + "---|"*(len(names) + 3))
        previous = None
        for interval in sorted(intervals, reverse=True):
            charges = np.array([1e9*np.interp(end, c["Time"], c["total"]) for _, c in sorted(intervals[interval].items())])
            change = "" if previous is None else f"{charges.mean() - previous:+.2f}"
            print(f"| {interval} ms | " + " | ".join(f"{q:.2f}" for q in charges)
                  + f" | {charges.mean():.2f} | {charges.std(ddof=1):.2f} | {change} |")
            previous = charges.mean()
    return 0


if __name__ == "__main__":
    sys.exit(main())
