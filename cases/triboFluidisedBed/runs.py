# SPDX-License-Identifier: GPL-3.0-or-later
"""A run of the bed as it was written: its series, its states, and the charging time that each of them stands for."""

import glob
import os
import re

import numpy as np

DIAMETER = 277e-6   # [m]
LID = 0.05          # [1] of the weight: a plug that hangs at the lid presses with more
WINDOW = 5.0        # [s] of charging time over which profiles are averaged, for every acceleration the same; a = 20 writes one in that time


def read(folder, pattern):
    """The columns of all series of a run, in order of time; where a run was continued, the later one holds."""
    rows, names = [], []
    for path in sorted(glob.glob(f"{folder}/postProcessing/{pattern}"), key=lambda p: float(p.split("/")[-2])):
        with open(path) as file:
            lines = file.read().splitlines()
        names = [line for line in lines if line.startswith("# Time")][0][2:].split()
        new = [[float(word) for word in line.split()] for line in lines if not line.startswith("#")]
        rows = [row for row in rows if row[0] < float(path.split("/")[-2])] + new
    table = np.array(rows).reshape(len(rows), -1)
    return {name: table[:, n] if rows else np.empty(0) for n, name in enumerate(names) if not rows or n < table.shape[1]}


class Run:
    def __init__(self, folder):
        self.folder = folder
        self.name = os.path.basename(folder)
        self.bed = read(folder, "particleStatistics/*/bed.dat")
        self.time = self.bed["Time"]
        found = re.match(r"a([\d.]+)-eg([\d.]+)(?:-leap(\d+))?(-uniform)?$", self.name)
        self.acceleration, self.strength = (float(found.group(1)), float(found.group(2))) if found else (0, 0)
        self.leap = int(found.group(3) or 0) if found else 0
        self.uniform = bool(found and found.group(4))
        self.charge = read(folder, "charge/*/charge.dat") if found else None
        self.leaps = read(folder, "projectiveCharging/*/projectiveCharging.dat") if self.leap else None

    def late(self, name, seconds=0.5):
        return np.mean(self.bed[name][self.time > self.time[-1] - seconds])

    def hangs_since(self):
        """Time [s] from which a plug hangs at the lid to the end, held by the gas; None where none does. It is no bed any more then."""
        lid = self.bed["by_lid"]
        if len(lid) < 100 or np.mean(lid[-100:]) > -LID:
            return None
        free = np.nonzero(lid > -LID)[0]
        return self.time[free[-1]] if len(free) else self.time[0]

    def begin(self):
        """Where the run has begun [s]."""
        try:
            with open(f"{self.folder}/DEM/begin") as file:
                return float(file.read())
        except FileNotFoundError:   # the uncharged bed
            return 0.0

    def charging_time_at(self, time):
        """Charging time [s] that the run stands for at a time [s]: a t, and its leaps."""
        beyond = 0
        if self.leaps:
            done = self.leaps["Time"] < time + 1e-9
            beyond = (self.leaps["chargingTime"] - self.leaps["Time"])[done][-1] if np.any(done) else 0
        return self.acceleration*(time - self.begin()) + beyond

    def half_width(self):
        """Of the column [m]."""
        with open(f"{self.folder}/system/bedSize") as file:
            return 1e-3*float(re.search(r"^high\s+([\d.]+);", file.read(), re.M).group(1))

    def segregation(self, charging_time=np.inf):
        """Mean charge of the first layer, centres within a diameter of a wall, over that of the rest: from the profiles of the last
        WINDOW up to a charging time [s], at least one."""
        paths = sorted(glob.glob(f"{self.folder}/postProcessing/particleStatistics/*/bedProfile.dat"), key=lambda p: float(p.split("/")[-2]))
        ends = [float(path.split("/")[-2]) for path in paths]
        stands = [self.charging_time_at(end) for end in ends]
        upTo = [n for n in range(len(paths)) if stands[n] < charging_time*1.01]
        if not upTo:        # a run that was stopped before its first checkpoint
            return np.nan
        number, charge = np.zeros(2), np.zeros(2)       # of the layer, of the rest
        for n in upTo:
            if n != upTo[-1] and stands[n] < stands[upTo[-1]] - 0.99*WINDOW:
                continue
            distance, density, mean = np.loadtxt(paths[n], usecols=(0, 1, 2), unpack=True)
            half = self.half_width()
            width = 2*distance[0]
            # Shells of the square column: the last one may be cut off by the middle.
            shell = np.maximum(half - distance + width/2, 0)**2 - np.maximum(half - distance - width/2, 0)**2
            weight = density*shell*(ends[n] - (ends[n - 1] if n else self.begin()))
            layer = distance < DIAMETER
            number += [np.sum(weight[layer]), np.sum(weight[~layer])]
            charge += [np.sum((weight*mean)[layer]), np.sum((weight*mean)[~layer])]
        return charge[0]/number[0]/(charge[1]/number[1]) if np.all(number > 0) and charge[1] > 0 else np.nan
