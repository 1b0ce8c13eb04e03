# SPDX-License-Identifier: GPL-3.0-or-later
"""The same charges in LAMMPS: a grounded cube is an eighth of a periodic cube of twice the size that holds every charge with
eight images of alternating sign. pair_style coul/long with kspace_style pppm, one core, neighbour list kept."""

import itertools
import os
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np

STEPS = 10  # force evaluations per run; nothing moves

SCRIPT = """units lj
atom_style charge
atom_modify sort 0 0
boundary p p p
newton on
read_data {data}
pair_style coul/long {cutoff}
pair_coeff * *
kspace_style pppm {accuracy}
kspace_modify order {order}
neighbor 0.0 bin
neigh_modify every 1000000 delay 1000000 check no
thermo 1000000
dump forces all custom 1 {dump} id fx fy fz
dump_modify forces sort id format float %.12g
run 0
undump forces
run {steps} pre no
"""


def available():
    return shutil.which("lmp") is not None


def write_images(path, position, charge, size):
    """Data file of the 8 N charges; the first N are the real ones. Unit charges, lengths in sphere diameters."""
    rows = []
    for mirror in itertools.product((0, 1), repeat=3):
        image = np.where(mirror, 2 * size - position, position)
        rows.append(np.column_stack([charge * (-1) ** sum(mirror), image]))
    rows = np.concatenate(rows)
    lines = ["charges and images\n", "%d atoms" % len(rows), "1 atom types\n"]
    lines += ["0 %.12g %slo %shi" % (2 * size, axis, axis) for axis in "xyz"] + ["\nMasses\n\n1 1\n\nAtoms # charge\n"]
    lines += ["%d 1 %g %.12g %.12g %.12g" % (n, *row) for n, row in enumerate(rows, 1)]
    Path(path).write_text("\n".join(lines) + "\n")


def run(folder, data, charge, cutoff, accuracy, order=5, core=None):
    """Seconds of one evaluation (of them pair and k-space) and the field E of the real charges, 4 pi eps0 = 1."""
    script = SCRIPT.format(data=data, cutoff=cutoff, accuracy=accuracy, order=order, steps=STEPS, dump="forces.txt")
    (folder / "in.pppm").write_text(script)
    pinned = ["taskset", "-c", str(core)] if core is not None and shutil.which("taskset") else []
    done = subprocess.run([*pinned, "lmp", "-in", "in.pppm", "-log", "log.lammps"], cwd=folder, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, env=dict(os.environ, OMP_NUM_THREADS="1"))
    if done.returncode:
        raise RuntimeError("LAMMPS failed; see %s" % (folder / "log.lammps"))
    timed = done.stdout[done.stdout.rindex("Loop time of"):]  # of the second run
    loop = float(re.search(r"Loop time of ([0-9.e+-]+)", timed).group(1)) / STEPS
    parts = {name: float(re.search(r"%s *\| *([0-9.e+-]+)" % name, timed).group(1)) / STEPS for name in ("Pair", "Kspace")}
    forces = np.loadtxt(folder / "forces.txt", skiprows=9)[: len(charge), 1:4]
    return loop, parts, forces / charge[:, None]


def error(field, exact):
    return float(np.sqrt(((field - exact) ** 2).sum() / (exact**2).sum()))
