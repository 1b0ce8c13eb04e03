# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes and runs small himFoam cases around a DEM script, and reads the frames back. SI units."""

import os
import pathlib
import subprocess

from scenes import STATE

HEADER = "FoamFile {{ version 2.0; format ascii; class {}; object {}; }}\n"


class Stopped(SystemExit):
    """A program ended with an error; `report` is what its log says from the word ERROR on, `frames` are those before it."""

    def __init__(self, text, report="", frames=()):
        super().__init__(text)
        self.report, self.frames = report, list(frames)


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


def read_frames(path):
    """Frames of a dump: {tag: {column: value}}."""
    frames = []
    for block in path.read_text().split("ITEM: TIMESTEP")[1:]:
        rows = [row.split() for row in block.split("ITEM: ATOMS")[1].splitlines()[1:]]
        frames.append({int(row[0]): dict(zip(STATE, map(float, row[1:]))) for row in rows})
    return frames


def run(folder, entries, script, every_frame, control_text, walls, extra=None, programs=("himFoam",)):
    """Runs a case in `folder`. `entries` of constant/electrostaticProperties, `walls` of couplingProperties, `extra` files by path with
    their class. Returns frames and the text of himFoam's log; raises Stopped when a program fails."""
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
    script += f"dump out all custom {every_frame} out.dump id {' '.join(STATE)}\n"
    script += f'dump_modify out format "%d {" ".join(["%.17g"]*len(STATE))}" sort id\n'
    (case/"DEM").mkdir(exist_ok=True)
    (case/"DEM/in.scene").write_text(script)
    for program in programs:
        path = case/f"log.{program}"
        with open(path, "w") as log:
            code = subprocess.run([program, "-case", folder], stdout=log, stderr=subprocess.STDOUT, env=os.environ).returncode
        if code:
            text = path.read_text(errors="replace")
            frames = read_frames(case/"out.dump") if (case/"out.dump").exists() else []
            raise Stopped(f"{program} stopped; see {path}", text[text.rfind("ERROR"):] if "ERROR" in text else text[-500:], frames)
    return read_frames(case/"out.dump"), (case/"log.himFoam").read_text(errors="replace")
