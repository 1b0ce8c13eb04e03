# SPDX-License-Identifier: GPL-3.0-or-later
"""What check.py, draw.py and study.py share: the numbers of the case, readers of a run, and the saturation fit. SI units."""

import glob
import math
import os
import re
import subprocess
from xml.etree import ElementTree

import numpy as np

EPSILON0 = 8.8541878128e-12     # [F/m]
SPHERES = 13
RADIUS = 6.35e-3                # [m]
CONTAINER_RADIUS = 0.03         # [m]
CONTAINER_HEIGHT = 0.06         # [m]
GAMMA_WALL = -7.67e5            # [V/m], R Table 6
Q_SAT = 4*math.pi*EPSILON0*RADIUS**2*GAMMA_WALL     # R17: an isolated sphere stops charging here [C], -3.441 nC

SELF, TOTAL = "runs/self", "runs/total"


def charge_history(run):
    """Columns of charge.dat by name, as arrays; of a continued run, all its parts in order."""
    folder = os.path.join(run, "postProcessing", "charge")
    parts = sorted(os.listdir(folder), key=float)
    columns = {}
    for part in parts:
        with open(os.path.join(folder, part, "charge.dat")) as file:
            header = [line for line in file if line.startswith("#")]
        names = header[-1].lstrip("# ").split()
        values = np.loadtxt(os.path.join(folder, part, "charge.dat"), ndmin=2)
        earlier = columns.get("Time", np.empty(0)) < values[0, 0]
        for name, column in zip(names, values.T):
            columns[name] = np.concatenate((columns[name][earlier] if name in columns else np.empty(0), column))
    return columns


def fit_saturation(time, charge):
    """Least squares of Q = Q_inf (1 - exp(-t/tau)). Returns Q_inf [C], tau [s] and the RMS residual over |Q_inf|."""
    def solve(tau):
        shape = 1 - np.exp(-time/tau)
        q_inf = (shape @ charge)/(shape @ shape)
        return q_inf, np.sqrt(np.mean((charge - q_inf*shape)**2))

    taus = np.geomspace(time[-1]/1e3, time[-1]*10, 400)
    for _ in range(3):      # each pass narrows the bracket 200 times
        best = min(range(len(taus)), key=lambda i: solve(taus[i])[1])
        taus = np.geomspace(taus[max(best - 1, 0)], taus[min(best + 1, len(taus) - 1)], 100)
    tau = taus[len(taus)//2]
    q_inf, rms = solve(tau)
    return q_inf, tau, rms/abs(q_inf)


def read_cloud(run, time, name):
    """A field of the particles as himFoam wrote it (ascii), one row per particle."""
    with open(os.path.join(run, time, "lagrangian", "particles", name)) as file:
        text = file.read().rpartition("// * *")[2]
    rows = text[text.index("\n(\n") + 3:text.rindex("\n)")].translate(str.maketrans("()", "  ")).splitlines()
    return np.array([row.split() for row in rows], float)


def write_times(run):
    """Names of the time directories after the start, in order."""
    names = [name for name in os.listdir(run) if re.fullmatch(r"\d+(\.\d+)?", name) and float(name) > 0]
    return sorted(names, key=float)


def convert(run):
    """Latest time of a run to VTK/ by OpenFOAM's own converter."""
    environment = {"WM_PROJECT_DIR": "/usr/share/openfoam", **os.environ}
    subprocess.run(["foamToVTK", "-case", run, "-ascii", "-no-boundary", "-no-point-data", "-latestTime", "-overwrite"],
                   check=True, stdout=subprocess.DEVNULL, env=environment)


def read_vtk(path):
    """The data arrays of an ascii VTK XML file by name."""
    arrays = {}
    for array in ElementTree.parse(path).iter("DataArray"):
        values = np.array(array.text.split(), float)
        width = int(array.get("NumberOfComponents", 1))
        arrays[array.get("Name")] = values if width == 1 else values.reshape(-1, width)
    return arrays


def last_scene(run):
    """Spheres and mesh potential at the latest time: positions [m], charges [C], cell centres [m], potential [V]."""
    convert(run)
    cloud, mesh = (read_vtk(glob.glob(os.path.join(run, "VTK", path))[0])
                   for path in ("lagrangian/particles/particles_*.vtp", "*/internal.vtu"))
    corners = np.split(mesh["connectivity"].astype(int), mesh["offsets"].astype(int)[:-1])
    centres = np.array([mesh["Points"][cell].mean(axis=0) for cell in corners])
    return cloud["Points"], cloud["charge"], centres, mesh["electricPotential"]
