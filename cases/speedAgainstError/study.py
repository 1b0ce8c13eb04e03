# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the scenes and writes the report: study.py short|default|full. Called by Allrun, which sets up PATH."""

import datetime
import os
import platform
import shutil
import subprocess
import sys
from pathlib import Path
from statistics import median

import numpy as np

import lammps
import meshes
import particles
import report
import scenes
from scenes import CHARGE, DIAMETER, Scene

HERE = Path(__file__).resolve().parent
CORE = 0
BOX_METHODS = ("him-diagonal", "him-3h", "himCell-adjacent", "truncation-3h", "particleCell-3h", "pairwise",
               "pairwise-images", "p3m-2h", "p3m-3h", "p3m-4h", "p3m-6h",
               "p3m-2h-single", "p3m-3h-single", "p3m-4h-single")
CURVED_METHODS = tuple(name for name in BOX_METHODS if name not in ("pairwise", "pairwise-images", "p3m-6h"))
DRUM_METHODS = (*CURVED_METHODS, "pairwise-images")
SHORT = ("diluteMixed", "bedMixed", "bedMixedFine", "wallLayer", "polyhedra", "sphere", "cylinder")
MOST_MIRRORED = 3000  # particles for `pairwise-images`: each has 26 images, and every pair of all is summed
MOST_DILUTE = 100000  # a million would take 6.5 million cells, and OpenFOAM's mesh alone about 1 kB for each
GROWTH_METHODS = ("him-diagonal", "p3m-2h", "p3m-3h")


def accuracy_scenes(size):
    """Scenes for error against time. `size`: short, default or full."""
    wide, deep = {"short": (30, 14), "default": (84, 24), "full": (84, 24)}[size]
    rounds = 3 if size == "short" else 7
    rng = np.random.default_rng(2022)
    cloud = particles.dilute(rng, wide)
    heap = particles.bed(rng, deep, 0.45 if size == "short" else 0.55)
    walls = particles.layer(rng, deep)
    drum = particles.in_cylinder(rng, 600, 10, 20, 150)
    ball = particles.in_sphere(rng, 340, 9, 60)
    half = particles.random_box(rng, 3341 if size != "short" else 556, (0, 0, 0), (18, 18, 18))

    def charged(position, kind):
        return position, particles.charges(rng, len(position), kind)

    def box(length, cell):
        return meshes.box(length, int(round(length / cell)), DIAMETER)

    scenes_of_all_sizes = [
        Scene("diluteMixed", "Dilute cloud, +-q, h = 2 d", *charged(cloud, "mixed"), 2, box(wide, 2), names=BOX_METHODS, rounds=rounds),
        Scene("diluteLike", "Dilute cloud, all +q, h = 2 d", *charged(cloud, "like"), 2, box(wide, 2), names=BOX_METHODS, rounds=rounds),
        Scene("bedMixed", "Dense bed, +-q, h = 2 d", *charged(heap, "mixed"), 2, box(deep, 2), names=BOX_METHODS, rounds=rounds),
        Scene("bedMixedFine", "Dense bed, +-q, h = d", *charged(heap, "mixed"), 1, box(deep, 1), names=BOX_METHODS, rounds=rounds),
        Scene("bedLike", "Dense bed, all +q, h = 2 d", *charged(heap, "like"), 2, box(deep, 2), names=BOX_METHODS, rounds=rounds),
        Scene("wallLayer", "Layer on all six walls, +-q, h = 2 d", *charged(walls, "mixed"), 2, box(deep, 2), names=BOX_METHODS,
              rounds=rounds),
        Scene("wallLayerLike", "Layer on all six walls, all +q, h = 2 d", *charged(walls, "like"), 2, box(deep, 2), names=BOX_METHODS,
              rounds=rounds),
        Scene("polyhedra", "Polyhedral mesh of a box, +-q, h = 1.5 d", *charged(half, "mixed"), 1.5,
              gmsh=meshes.tetrahedra(18, 9, DIAMETER, rng), stretch=1.5, rounds=rounds),
        Scene("sphere", "Sphere, all +q, h = d", *charged(ball, "like"), 1, meshes.sphere(9, 1, DIAMETER), ball=9, stretch=1.5,
              names=CURVED_METHODS, rounds=rounds),
        Scene("cylinder", "Cylinder, +-q, h = d", *charged(drum, "mixed"), 1, meshes.cylinder(10, 20, 1, DIAMETER), stretch=1.5,
              names=DRUM_METHODS, rounds=rounds),
        Scene("bedSnapshot", "State of triboFluidisedBed, h = 2.17 d", *particles.snapshot(HERE / "snapshots/bed.csv", 277e-6, CHARGE),
              3 / 0.277 / 5, meshes.box(3 / 0.277, 5, DIAMETER, 12, 60), names=BOX_METHODS, rounds=rounds),
        Scene("shakerSnapshot", "State of vibratoryShaker, h = 0.35 d", *particles.snapshot(HERE / "snapshots/shaker.csv", 12.7e-3, CHARGE),
              4.5 / 12.7, meshes.cylinder(30 / 12.7, 60 / 12.7, 4.5 / 12.7, DIAMETER), stretch=1.5, names=DRUM_METHODS, rounds=rounds),
    ]
    return [scene for scene in scenes_of_all_sizes if size != "short" or scene.name in SHORT]


def growth_scenes(size):
    """Cost against the number of particles at fixed density, h = 2 d."""
    counts = {"short": (100, 1000), "default": (100, 1000, 10000, 100000), "full": (100, 1000, 10000, 100000, 1000000)}[size]
    rng = np.random.default_rng(2018)
    for count in counts:
        rounds = 7 if count < 50000 else 3
        if count <= MOST_DILUTE:
            length = 2 * round((count * np.pi / 6 / 0.01) ** (1 / 3) / 2)
            cloud = particles.dilute(rng, length)
            yield Scene("growthDilute%d" % count, "dilute", cloud, particles.charges(rng, len(cloud), "mixed"), 2,
                        meshes.box(length, length // 2, DIAMETER), names=GROWTH_METHODS, rounds=rounds)
        heap, length = particles.crystal_bed(rng, count)
        cells = max(3, int(round(length / 2)))
        yield Scene("growthDense%d" % count, "dense", heap, particles.charges(rng, len(heap), "mixed"), length / cells,
                    meshes.box(length, cells, DIAMETER), names=GROWTH_METHODS, rounds=rounds)


def run(scene, root):
    print("    %s: %d particles" % (scene.name, len(scene.position)), flush=True)
    if len(scene.position) > MOST_MIRRORED:
        scene.names = tuple(name for name in scene.names if name != "pairwise-images")
    folder, names = scenes.set_up(scene, root)
    scene.rows = scenes.compare(folder, names, scene.rounds, CORE)
    return folder, names


def beside_lammps(scene, length, cutoffs, folder, names, rounds):
    """LAMMPS and himField in turns on one core, in a copy of the scene's case, whose own comparison stays as it is; rows like
    those of himField with the medians over the turns."""
    folder = Path(shutil.copytree(folder, folder.with_name(folder.name + "BesideLammps"), ignore=shutil.ignore_patterns("postProcessing", "log.*")))
    names = [name for name in names if name.startswith(("him-diagonal", "p3m"))]
    lammps.write_images(folder / "data.images", scene.position, scene.charge, length)
    exact = lammps.run(folder, "data.images", scene.charge, 9 if length > 30 else 5, 1e-6, 7, CORE)[2]
    settings = [(cutoff, accuracy) for accuracy in (1e-1, 1e-2, 1e-3) for cutoff in cutoffs]
    ours, theirs = {name: [] for name in names}, {setting: [] for setting in settings}
    errors = {}
    for _ in range(rounds):
        for row in scenes.compare(folder, names, 2, CORE):
            ours[row["name"]].append(row["warm_total_s"])
            errors[row["name"]] = row["rms_error"]
        for setting in settings:
            seconds, _, field = lammps.run(folder, "data.images", scene.charge, *setting, core=CORE)
            theirs[setting].append(seconds)
            errors[setting] = lammps.error(field, exact)
    return {
        "scene": scene.title, "particles": len(scene.charge), "rounds": rounds,
        "ours": [(name, errors[name], median(times)) for name, times in ours.items()],
        "theirs": [("rc %g d, accuracy %g" % setting, errors[setting], median(times)) for setting, times in theirs.items()],
        "check": reference_check(scene, folder, exact),
    }


def reference_check(scene, folder, exact):
    """RMS difference of p3m-4h from the tight LAMMPS run, which must equal its error against himField's exact reference."""
    subprocess.run(["himField", "-particles", "particles.csv", "-method", "p3m-4h", "-output", "p3m-4h.csv"], cwd=folder, check=True,
                   env=dict(os.environ, PWD=str(folder)), stdout=subprocess.DEVNULL)
    field = np.loadtxt(folder / "p3m-4h.csv", delimiter=",", skiprows=1)[:, 4:7]
    unit = scenes.CHARGE / (4 * np.pi * 8.8541878128e-12 * DIAMETER**2)
    return lammps.error(field / unit, exact)


def machine():
    name = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), platform.machine())
    flags = next((line for line in open("/proc/cpuinfo") if line.startswith("flags")), "").split()
    vectors = next((label for flag, label in (("avx512f", "AVX-512"), ("avx2", "AVX2")) if flag in flags), "no AVX2")
    return "%s with %s, %d cores, each run on one of them" % (name, vectors, os.cpu_count())


def main(size):
    root = HERE / "runs"
    print("Error against time", flush=True)
    compared = accuracy_scenes(size)
    folders = {scene.name: run(scene, root) for scene in compared}
    print("Cost against number", flush=True)
    growth = []
    for scene in growth_scenes(size):
        run(scene, root)
        scene.position = None  # a million take room
        growth.append(scene)
    pairs = []
    if lammps.available():
        wide, deep, rounds = (30, 14, 1) if size == "short" else (84, 24, 3)
        for name, length, cutoffs in (("diluteMixed", wide, (5, 6, 7, 8, 10)), ("bedMixedFine", deep, (1.5, 2, 2.5, 3))):
            print("LAMMPS beside himField: %s" % name, flush=True)
            scene = next(s for s in compared if s.name == name)
            cutoffs = cutoffs[1:3] if size == "short" else cutoffs
            pairs.append(beside_lammps(scene, length, cutoffs, *folders[name], rounds=rounds))
    else:
        print("LAMMPS is not installed: left out")
    target = HERE / ("runs" if size == "short" else "doc")
    report.write(target, size, datetime.date.today().isoformat(), machine(), compared, growth, pairs)
    print("Report: %s" % (target / "report.md"))


if __name__ == "__main__":
    main(sys.argv[1])
