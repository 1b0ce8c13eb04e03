#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Bulk charge and share of wall contacts against the number of 12.7 mm spheres in the shaker (R Fig. 14).

Usage: packing.py [-short]
"""

import math
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]/"vibratoryShaker"))
import bands  # noqa: E402
import shaker  # noqa: E402

NUMBERS = (1, 4, 8, 13, 20, 30)
GAMMA, KAPPA = bands.PARAMETERS[12.7]["average"]
# A sphere in the middle and nine around it, in layers: room for thirty. [mm]
LAYER = [(0.0, 0.0)] + [(21*math.cos(2*math.pi*k/9), 21*math.sin(2*math.pi*k/9)) for k in range(9)]
POSITIONS = [(x, y, z) for z in (8.0, 22.5, 37.0) for x, y in LAYER]
SIDEWAYS = [(0.1*math.cos(2.4*k), 0.1*math.sin(2.4*k)) for k in range(len(POSITIONS))]      # [m/s]
CONTAINER = math.pi*shaker.CONTAINER_RADIUS**2*shaker.CONTAINER_HEIGHT     # [m3]


def contacts(folder):
    """Contacts between spheres and with walls, over the whole run."""
    text = (pathlib.Path(folder)/"log.himFoam").read_text()
    return map(int, re.search(r"contacts with particles, walls +(\d+), (\d+)", text).groups())


def measure(count, field, end):
    folder = f"runs/{count}-{field}"
    text = bands.script(3, 12.7, POSITIONS[:count], 144, GAMMA, KAPPA, SIDEWAYS[:count])
    columns = bands.run_case(folder, 3, text, field, end)
    pairs, walls = contacts(folder)
    closure = max(abs(columns["closureError"]))/max(abs(columns["total"]))
    return {"bulk": bands.late(columns, "total")/(count*shaker.Q_SAT), "share": walls/(walls + pairs), "closure": closure,
            "spread": (bands.late(columns, "max") - bands.late(columns, "min"))/abs(shaker.Q_SAT)}


def draw(found):
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(7.4, 4.4))
    axes.plot(NUMBERS, [100*found[n, "self"]["share"] for n in NUMBERS], "s--", color="#8a8f98", label="share of wall contacts")
    for field, colour in (("self", "#1f5fa8"), ("total", "#d9772b")):
        axes.plot(NUMBERS, [100*found[n, field]["bulk"] for n in NUMBERS], "o-", color=colour, label=f"bulk charge, {field}")
    axes.set(xlabel="number of 12.7 mm spheres", ylabel="% of all contacts, % of isolated spheres at saturation", ylim=(0, 105))
    axes.legend(frameon=False)
    axes.set_title("Packing in the shaken cylinder", loc="left", fontsize=12)
    figure.savefig("packing.png", dpi=100, bbox_inches="tight")
    print("wrote packing.png")


def main():
    short = "-short" in sys.argv[1:]
    numbers, fields, end = ((1, 8), ("total",), 2.0) if short else (NUMBERS, bands.FIELDS, 30.0)
    found = {}
    lines = [f"{end:g} s of shaking; charges are means over the last sixth.", "",
             "| spheres | volume fraction | wall contacts | " + " | ".join(f"bulk charge, {field} | most - least, {field}" for field in fields) + " |",
             "|---|---|---|" + "---|---|"*len(fields)]
    for count in numbers:
        for field in fields:
            found[count, field] = measure(count, field, end)
        volume = count*4/3*math.pi*shaker.RADIUS**3/CONTAINER
        lines.append(f"| {count} | {100*volume:.1f} % | {100*found[count, fields[0]]['share']:.1f} % | " + " | ".join(
            f"{100*found[count, field]['bulk']:.1f} % | {100*found[count, field]['spread']:.0f} %" for field in fields) + " |")
        print(lines[-1], flush=True)
    failed = []
    for field in fields:
        for few, many in zip(numbers, numbers[1:]):
            for what in ("bulk", "share") if not short else ("share",):
                if not found[many, field][what] < found[few, field][what]:
                    failed.append(f"{field}: {what} does not fall from {few} to {many} spheres")
    failed += [f"{key}: the books close to {row['closure']:.1e}" for key, row in found.items() if not row["closure"] <= 1e-12]
    text = "\n".join(lines) + "\n"
    pathlib.Path("runs/report.md").write_text(text)
    print("\n" + text)
    for what in failed:
        print("FAILED:", what)
    if not short:
        draw(found)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
