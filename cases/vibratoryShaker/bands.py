#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The shaker with the weakest, average and strongest charging parameters, in 3D and 2D, for both wall contact fields (R Figs. 9-13).

Makes and runs the cases bands/<scene>-<parameters>-<field>, one after the other, then writes bands/report.md and bands.png.
Usage: bands.py [end time, default 60 s] [-only-report]
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys

import numpy as np

import shaker

NANO = 1e9
CASE = pathlib.Path(__file__).resolve().parent
REPORT_TIMES = (1, 3, 5, 10, 20, 30, 60)    # [s], R section 4.3.2
FIELDS = ("self", "total")

# Gamma [V/m] and kappa_c of sphere-wall contacts, weakest to strongest: R Table 5 (11.11 mm) and Table 6 (12.7 mm). The
# diameters are in mm.
PARAMETERS = {
    11.11: {"minimum": (-7.66e5, 13.0), "average": (-8.03e5, 19.7), "maximum": (-8.41e5, 28.1)},
    12.7: {"minimum": (-7.32e5, 12.0), "average": (-7.67e5, 20.0), "maximum": (-8.03e5, 35.5)},
}

LAYERS_3D = [(0.0, 0.0, 8.0), (14.0, 0.0, 8.0), (7.0, 12.12, 8.0), (-7.0, 12.12, 8.0), (-14.0, 0.0, 8.0), (-7.0, -12.12, 8.0),
             (7.0, -12.12, 8.0), (12.12, 7.0, 23.0), (0.0, 14.0, 23.0), (-12.12, 7.0, 23.0), (-12.12, -7.0, 23.0), (0.0, -14.0, 23.0),
             (12.12, -7.0, 23.0)]                                                                      # [mm], as in DEM/in.shaker
ROWS_2D = [(x, 0.0, z) for z in (8.0, 22.0, 36.0, 50.0) for x in (-21.0, -7.0, 7.0, 21.0)][:13]        # [mm], the plane y = 0

# name: (dimension, diameter [mm], start positions [mm], DEM steps per field update of 2 ms: at most 20 % of the Rayleigh step)
SCENES = {
    "3d-1x11.11": (3, 11.11, [(4.0, 3.0, 8.0)], 168),
    "2d-1x11.11": (2, 11.11, [(4.0, 0.0, 8.0)], 168),
    "3d-13x12.7": (3, 12.7, LAYERS_3D, 144),
    "2d-13x12.7": (2, 12.7, ROWS_2D, 144),
    "2d-4x12.7": (2, 12.7, ROWS_2D[:4], 144),
}
WALLS = {3: ["cyl zcylinder 0.03 0. 0.", "floor zplane 0.0", "lid zplane 0.06"],
         2: ["left xplane -0.03", "right xplane 0.03", "floor zplane 0.0", "lid zplane 0.06"]}


def q_sat(diameter, gamma):
    """Charge at which an isolated sphere stops charging [C], R17."""
    return 4*np.pi*shaker.EPSILON0*(diameter*5e-4)**2*gamma


def script(dimension, diameter, positions, steps, gamma, kappa, sideways=()):
    """DEM/in.shaker with other spheres (diameter and positions in mm), walls, time step and wall parameters. `sideways`: speeds
    (x, y) of the first spheres [m/s]; few spheres would bounce each on its own spot for ever."""
    lines = [line for line in (CASE/"DEM/in.shaker").read_text().splitlines()
             if not re.match(r"create_atoms|# ---|#  |# Thirteen|# 20", line)]
    text = "\n".join(lines)

    def replace(pattern, new):
        nonlocal text
        text, count = re.subn(pattern, new, text, flags=re.M)
        if count == 0:
            raise SystemExit(f"DEM/in.shaker has no line {pattern}; bands.py must be adapted")

    model = "model hertz tangential history cohesion charge"
    text = re.sub(r"^fix  (floor|lid) .*\n", "", text, flags=re.M)
    replace(r"^fix  cyl .*$", "\n".join(f"fix {wall.split()[0]} all wall/gran {model} primitive type 2 {wall.split(' ', 1)[1]}"
                                        for wall in WALLS[dimension]))
    replace(r"pair 1 2 gamma \S+ kappa \S+", f"pair 1 2 gamma {gamma!r} kappa {kappa!r}")
    replace(r"^timestep .*$", f"timestep {2e-3/steps!r}")
    push = "\n".join(f"set atom {tag} vx {x:.4f} vy {y:.4f}" for tag, (x, y) in enumerate(sideways, 1))
    plane = "fix flat all constrain/plane normal 0 1 0" if dimension == 2 else ""
    jitter = "3.0e-4 3.0e-4 3.0e-4" if dimension == 3 else "3.0e-4 0.0 3.0e-4"
    spheres = "\n".join(f"create_atoms 1 single {x*1e-3:.5f} {y*1e-3:.5f} {z*1e-3:.5f}" for x, y, z in positions)
    replace(r"^set +group all diameter .*$", f"{spheres}\nset group all diameter {diameter*1e-3!r} density 2150 charge 0.0\n{push}")
    replace(r"^displace_atoms .*$", f"displace_atoms all random {jitter} ${{seed}} units box\n{plane}")
    return text + "\n"


def run_case(folder, dimension, text, field, end):
    """Makes a case without a mesh around a script, and runs it. Returns the columns of its charge.dat."""
    shutil.rmtree(folder, ignore_errors=True)
    for part in ("DEM", "constant", "system"):
        os.makedirs(os.path.join(folder, part))
    control = re.sub(r"(?m)^(endTime|writeInterval) .*$", rf"\1 {end:g};", (CASE/"system/controlDict").read_text())
    header = "FoamFile { version 2.0; format ascii; class dictionary; object %s; }\n"
    walls = " ".join(f"{wall.split()[0]} grounded;" for wall in WALLS[dimension])
    files = {
        "system/controlDict": control,
        "constant/electrostaticProperties": header % "electrostaticProperties" + "fieldMethod pairwiseSum;\npairwiseSumCoeffs { images yes; }\n",
        "constant/couplingProperties": header % "couplingProperties" + f'demScript "DEM/in.shaker";\nwalls {{ {walls} }}\n'
                                       f"wallContactField {field};\nlogInterval 500;\nchargeInterval 5;\ndemCheckpoint no;\n",
        "DEM/in.shaker": text,
    }
    for name, content in files.items():
        with open(os.path.join(folder, name), "w") as file:
            file.write(content)
    with open(os.path.join(folder, "log.himFoam"), "w") as log:
        if subprocess.run(["himFoam"], cwd=folder, stdout=log, stderr=subprocess.STDOUT).returncode:
            raise SystemExit(f"himFoam stopped; see {folder}/log.himFoam")
    return shaker.charge_history(folder)


def runs():
    """(scene, parameters, field) of every run: the averages first."""
    order = [("average", scene) for scene in SCENES] + [(p, scene) for scene in ("3d-13x12.7", "3d-1x11.11", "2d-1x11.11", "2d-13x12.7", "2d-4x12.7")
                                                         for p in ("minimum", "maximum")]
    return [(scene, parameters, field) for parameters, scene in order for field in FIELDS]


def folder_of(scene, parameters, field):
    return f"bands/{scene}-{parameters}-{field}"


def finished(folder):
    log = pathlib.Path(folder, "log.himFoam")
    return log.exists() and "\nEnd\n" in log.read_text()


def run_all(end):
    """A run that is there already is kept."""
    for scene, parameters, field in runs():
        folder = folder_of(scene, parameters, field)
        if finished(folder):
            continue
        sideways = [(0.03, 0.02 if SCENES[scene][0] == 3 else 0.0)] if len(SCENES[scene][2]) == 1 else []
        text = script(*SCENES[scene], *PARAMETERS[SCENES[scene][1]][parameters], sideways)
        columns = run_case(folder, SCENES[scene][0], text, field, end)
        print(f"{folder}: {NANO*columns['total'][-1]:.2f} nC at {columns['Time'][-1]:g} s", flush=True)


def late(columns, name):
    """Mean over the last sixth of the run: 50 to 60 s."""
    return columns[name][columns["Time"] >= columns["Time"][-1]*5/6].mean()


class Report:
    def __init__(self):
        self.histories = {(scene, parameters, field): shaker.charge_history(folder_of(scene, parameters, field))
                          for scene in SCENES for field in FIELDS for parameters in PARAMETERS[SCENES[scene][1]]}
        self.end = min(columns["Time"][-1] for columns in self.histories.values())
        self.lines, self.failed = [], []

    def bulk_table(self):
        times = [t for t in REPORT_TIMES if t <= self.end + 1e-9]
        self.lines += ["Bulk charge [nC]:", "", "| scene | field | parameters | " + " | ".join(f"{t} s" for t in times) + " | isolated |",
                       "|---|---|---|" + "---|"*(len(times) + 1)]
        for (scene, parameters, field), columns in self.histories.items():
            diameter, count = SCENES[scene][1], len(SCENES[scene][2])
            limit = count*q_sat(diameter, PARAMETERS[diameter][parameters][0])
            values = " | ".join(f"{NANO*np.interp(t, columns['Time'], columns['total']):.2f}" for t in times)
            self.lines.append(f"| {scene} | {field} | {parameters} | {values} | {NANO*limit:.2f} |")

    def spread_table(self):
        self.lines += ["", "Charge of single spheres, average parameters, mean over the last sixth of the run [nC]:", "",
                       "| scene | field | least | mean | most | most - least |", "|---|---|---|---|---|---|"]
        for scene in ("3d-13x12.7", "2d-13x12.7", "2d-4x12.7"):
            for field in FIELDS:
                least, mean, most = (NANO*late(self.histories[scene, "average", field], name) for name in ("max", "mean", "min"))
                self.lines.append(f"| {scene} | {field} | {least:.2f} | {mean:.2f} | {most:.2f} | {least - most:.2f} |")

    def claim(self, text, holds):
        self.lines.append(f"- {text}: {'holds' if holds else '**FAILED**'}")
        self.failed += [] if holds else [text]

    def claims(self):
        self.lines += ["", "Claims:", ""]
        worst = max(np.max(np.abs(c["closureError"]))/np.max(np.abs(c["total"])) for c in self.histories.values())
        self.claim(f"the books close to {worst:.1e} of the charge in every run (allowed 1e-12)", worst <= 1e-12)
        ordered = all(abs(late(self.histories[s, "minimum", f], "total")) < abs(late(self.histories[s, "average", f], "total"))
                      < abs(late(self.histories[s, "maximum", f], "total")) for s in SCENES for f in FIELDS)
        self.claim("weaker parameters charge less in every scene", ordered)
        if self.end < 30:
            return
        off = max(abs(late(self.histories[s, p, "self"], "total")/q_sat(11.11, PARAMETERS[11.11][p][0]) - 1)
                  for s in ("3d-1x11.11", "2d-1x11.11") for p in PARAMETERS[11.11])
        self.claim(f"a single sphere with `self` ends at q_sat to {100*off:.2f} % in 2D and 3D (allowed 0.5 %)", off <= 5e-3)
        for field in FIELDS:
            spread = {s: late(self.histories[s, "average", field], "max") - late(self.histories[s, "average", field], "min")
                      for s in ("3d-13x12.7", "2d-13x12.7")}
            ratio = spread["2d-13x12.7"]/spread["3d-13x12.7"]
            means = late(self.histories["2d-13x12.7", "average", field], "mean")/late(self.histories["3d-13x12.7", "average", field], "mean")
            self.claim(f"{field}: thirteen spheres in 2D spread {ratio:.2f} times as wide as in 3D (R: far wider), their mean is "
                       f"{means:.2f} times that of 3D", ratio > 1)

    def write(self):
        self.bulk_table()
        self.spread_table()
        self.claims()
        text = "\n".join(self.lines) + "\n"
        with open("bands/report.md", "w") as file:
            file.write(text)
        print(text)


def draw(report):
    import matplotlib.pyplot as plt
    from draw import BLUE, GREY, ORANGE, thin

    figure, all_axes = plt.subplots(2, 3, figsize=(13.5, 7.4), sharex=True)
    for row, field in enumerate(FIELDS):
        def band(axes, scene, colour, label, name="total"):
            histories = [thin(report.histories[scene, parameters, field], 300) for parameters in ("minimum", "average", "maximum")]
            weak, mean, strong = (h[name] for h in histories)
            axes.fill_between(histories[0]["Time"], NANO*weak, NANO*strong, color=colour, alpha=0.2, lw=0)
            axes.plot(histories[1]["Time"], NANO*mean, color=colour, lw=1.8, label=label)

        single, bulk, spheres = all_axes[row]
        band(single, "3d-1x11.11", BLUE, "3D")
        band(single, "2d-1x11.11", ORANGE, "2D")
        single.axhline(NANO*q_sat(11.11, -8.03e5), color=GREY, ls=":", label="isolated sphere")
        band(bulk, "3d-13x12.7", BLUE, "3D, 13 spheres")
        band(bulk, "2d-13x12.7", ORANGE, "2D, 13 spheres")
        bulk.axhline(13*NANO*q_sat(12.7, -7.67e5), color=GREY, ls=":", label="13 isolated spheres")
        for scene, colour, label in (("2d-13x12.7", ORANGE, "2D, 13"), ("2d-4x12.7", GREY, "2D, 4"), ("3d-13x12.7", BLUE, "3D, 13")):
            columns = thin(report.histories[scene, "average", field], 300)
            spheres.fill_between(columns["Time"], NANO*columns["min"], NANO*columns["max"], color=colour, alpha=0.25, lw=0)
            spheres.plot(columns["Time"], NANO*columns["mean"], color=colour, lw=1.8, label=label)
        for axes, title in zip(all_axes[row], ("one 11.11 mm sphere", "bulk charge, 12.7 mm", "least, mean, most charged sphere")):
            axes.set_title(f"{title}, {field}", loc="left", fontsize=11)
            axes.legend(fontsize=9)
            axes.invert_yaxis()
        single.set_ylabel("charge [nC]")
    for axes in all_axes[1]:
        axes.set_xlabel("time [s]")
    figure.tight_layout()
    figure.savefig("bands.png")
    print("wrote bands.png")


def main():
    arguments = sys.argv[1:]
    if "-only-report" not in arguments:
        run_all(float(arguments[0]) if arguments else 60.0)
    report = Report()
    report.write()
    draw(report)
    return 1 if report.failed else 0


if __name__ == "__main__":
    sys.exit(main())
