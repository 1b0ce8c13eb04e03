# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes and runs small himFoam cases around a DEM script, and reads the frames back. SI units."""

import os
import pathlib
import subprocess

from scenes import STATE, dem

HEADER = "FoamFile {{ version 2.0; format ascii; class {}; object {}; }}\n"


def control(step, every, updates):
    """system/controlDict for that many field updates, one every `every` DEM steps."""
    return f"""
application himFoam;
startFrom startTime; startTime 0; stopAt endTime;
endTime {updates*every*step!r}; deltaT {every*step!r};
writeControl timeStep; writeInterval {updates + 1};
writeFormat ascii; writePrecision 12; timePrecision 12; runTimeModifiable false;
"""


def coupling(walls):
    return f'demScript "DEM/in.scene";\nwalls {{ {walls} }}\nlogInterval 1000000; chargeInterval 1000000; demCheckpoint no;\n'


def run(folder, entries, script, every_frame, control_text, walls, extra=None, programs=("himFoam",)):
    """Runs a case in `folder`. `entries` of constant/electrostaticProperties, `walls` of couplingProperties, `extra` files by path with
    their class. Returns frames and the text of himFoam's log; raises dem.Stopped when a program fails."""
    case = pathlib.Path(folder)
    files = {
        "system/controlDict": ("dictionary", control_text),
        "constant/electrostaticProperties": ("dictionary", entries + "\nfieldError { active no; }\n"),
        "constant/couplingProperties": ("dictionary", coupling(walls)),
        **(extra or {}),
    }
    for name, (kind, text) in files.items():
        (case/name).parent.mkdir(parents=True, exist_ok=True)
        (case/name).write_text(HEADER.format(kind, pathlib.Path(name).name) + text)
    script += dem.dump(STATE, every_frame)
    (case/"DEM").mkdir(exist_ok=True)
    (case/"DEM/in.scene").write_text(script)
    for program in programs:
        path = case/f"log.{program}"
        with open(path, "w") as log:
            code = subprocess.run([program, "-case", folder], stdout=log, stderr=subprocess.STDOUT, env=os.environ).returncode
        if code:
            raise dem.Stopped(program, str(path), dem.read_frames(case/"out.dump", STATE))
    return dem.read_frames(case/"out.dump", STATE), (case/"log.himFoam").read_text(errors="replace")
