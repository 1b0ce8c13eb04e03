#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Table of the halving study: bulk charge against field update interval, three seeds each. Reads study/<ms>ms-<seed>/."""

import os
import re
import sys

import numpy as np

import shaker


def main():
    runs = {}
    for folder in os.listdir("study"):
        name = re.fullmatch(r"(\d+)ms-(\d+)", folder)
        if name:
            runs.setdefault(int(name[1]), {})[int(name[2])] = shaker.charge_history(os.path.join("study", folder))
    end = min(columns["Time"][-1] for seeds in runs.values() for columns in seeds.values())
    print(f"Bulk charge [nC] after {end:g} s\n")
    print("| deltaT | " + " | ".join(f"seed {seed}" for seed in sorted(runs[min(runs)])) + " | mean | scatter of seeds | change on halving |")
    print("|---|" + "---|"*(len(runs[min(runs)]) + 3))
    previous = None
    for interval in sorted(runs, reverse=True):
        charges = np.array([1e9*np.interp(end, c["Time"], c["total"]) for _, c in sorted(runs[interval].items())])
        change = "" if previous is None else f"{charges.mean() - previous:+.3f}"
        print(f"| {interval} ms | " + " | ".join(f"{q:.3f}" for q in charges)
              + f" | {charges.mean():.3f} | {charges.std(ddof=1):.3f} | {change} |")
        previous = charges.mean()
    return 0


if __name__ == "__main__":
    sys.exit(main())
