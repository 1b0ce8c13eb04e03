# SPDX-License-Identifier: GPL-3.0-or-later
"""p3m in the shaker's cylinder against p3m on a mesh refined threefold: writes doc/refined.md. The report's own reference stands on the same
mesh and shares its flat facets; this one does not. Called by Allrun."""

import csv
import datetime
from dataclasses import replace

import numpy as np

import meshes
import scenes
import study

REFERENCE = "p3m-6h"  # on the refined mesh
CHECKED = ("p3m-2h", "p3m-3h", "p3m-4h", "p3m-6h")
TOUCHING = 0.02  # gap to a wall [d] up to which a particle counts as touching


def field(scene, radius, height, cell, root, names):
    """Name of the method to the field [any unit] on a mesh of this cell size."""
    finer = replace(scene, name="%s%g" % (scene.name, round(cell, 3)), cell=cell, mesh=meshes.cylinder(radius, height, cell, scenes.DIAMETER),
                    names=names)
    folder, known = scenes.set_up(finer, root)
    found = {}
    for name in known:
        scenes.call(["himField", "-particles", "particles.csv", "-method", name, "-output", name + ".csv"], folder, "log." + name)
        with open(folder / (name + ".csv"), newline="") as file:
            found[name] = np.array([[float(row[part]) for part in ("Ex", "Ey", "Ez")] for row in csv.DictReader(file)])
    return found


def touching(position, radius, height):
    gaps = [radius - np.hypot(position[:, 0], position[:, 1]), position[:, 2], height - position[:, 2]]
    return np.min(gaps, axis=0) < 0.5 + TOUCHING


def rms(difference, reference):
    return np.sqrt(np.sum(difference**2) / np.sum(reference**2))


def table(scene, radius, height, root):
    reference = field(scene, radius, height, scene.cell / 3, root, (REFERENCE, "p3m-4h"))
    exact = reference[REFERENCE]
    near = touching(scene.position, radius, height)
    lines = ["### %s\n" % scene.title,
             "%d particles, %d of them touching a wall. Reference: %s on cells of %.3g d; p3m-4h there differs from it by %.2g, touching %.2g.\n" % (
                 len(exact), near.sum(), REFERENCE, scene.cell / 3, rms(reference["p3m-4h"] - exact, exact),
                 rms((reference["p3m-4h"] - exact)[near], exact[near])),
             "| cells [d] | particles | %s |" % " | ".join(CHECKED), "|---|---|" + "---|" * len(CHECKED)]
    for cell in (scene.cell, scene.cell / 2):
        found = field(scene, radius, height, cell, root, CHECKED)
        for who, rows in (("all", slice(None)), ("touching", near)):
            lines.append("| %.3g | %s | %s |" % (cell, who, " | ".join("%.2g" % rms((found[name] - exact)[rows], exact[rows]) for name in CHECKED)))
    return "\n".join(lines) + "\n"


def main():
    root = study.HERE / "runs"
    scene = next(scene for scene in study.accuracy_scenes("default") if scene.name == "shakerSnapshot")
    parts = ["<!-- SPDX-License-Identifier: GPL-3.0-or-later -->\n<!-- written by ./Allrun -->\n# p3m in the shaker's cylinder against a refined mesh\n",
             "%s. RMS field errors.\n" % datetime.date.today().isoformat(),
             table(scene, 30 / 12.7, 60 / 12.7, root)]
    (study.HERE / "doc" / "refined.md").write_text("\n".join(parts))
    print("The shaker's cylinder against a refined mesh: %s" % (study.HERE / "doc/refined.md"))


if __name__ == "__main__":
    main()
