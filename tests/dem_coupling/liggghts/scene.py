# SPDX-License-Identifier: GPL-3.0-or-later
"""Small DEM scenes through the program liggghtsHim: write a script, run it, read the last dump."""
import math
import os
import pathlib
import subprocess
import tempfile

EPSILON0 = 8.8541878128e-12
PROGRAM = os.environ.get("LIGGGHTS_HIM", "liggghtsHim")
LAUNCHER = ["mpirun", "--allow-run-as-root", "--oversubscribe", "-np"]

PTFE = dict(radius=1.59e-3, density=2150.0, young=0.564e9, poisson=0.42)
PA66 = dict(radius=1.59e-3, density=1140.0, young=1.27e9, poisson=0.49)
RIGID = dict(young=1e16, poisson=0.0)


def rayleigh_step(material):
    """Rayleigh time step [s], Rasera et al. 2022 Eq. 13."""
    shear = material["young"] / (2 * (1 + material["poisson"]))
    return math.pi * material["radius"] * math.sqrt(material["density"] / shear) / (0.8766 + 0.163 * material["poisson"])


def script(particles, walls="", charging="", box=(-0.02, 0.02), boundary="f f f", material=PTFE, wall_material=RIGID,
           restitution=1.0, step=None, cohesion="charge", model="model hertz tangential history", before="",
           after="", rolling="", friction=0.065, grid="* * *"):
    """A script with particle type 1 and wall type 2. `particles` are (x, y, z, vx, vy, vz, charge); `grid` is how the box is
    cut for the ranks."""
    step = step or 0.05 * rayleigh_step(material)
    lines = f"""
units si
atom_style hybrid granular charge
atom_modify map array
boundary {boundary}
newton off
communicate single vel yes
processors {grid}
region box block {box[0]} {box[1]} {box[0]} {box[1]} {box[0]} {box[1]} units box
create_box 2 box
neighbor {0.5 * material['radius']} bin
neigh_modify delay 0
hard_particles yes
fix m1 all property/global youngsModulus peratomtype {material['young']} {wall_material['young']}
fix m2 all property/global poissonsRatio peratomtype {material['poisson']} {wall_material['poisson']}
fix m3 all property/global coefficientRestitution peratomtypepair 2 {' '.join([str(restitution)] * 4)}
fix m4 all property/global coefficientFriction peratomtypepair 2 {' '.join([str(friction)] * 4)}
fix m5 all property/global coefficientRollingFriction peratomtypepair 2 0 0 0 0
fix m6 all property/global coefficientRollingViscousDamping peratomtypepair 2 0 0 0 0
fix m7 all property/global cohesionEnergyDensity peratomtypepair 2 0 0 0 0
{before}
pair_style gran {model} cohesion {cohesion} {rolling}
pair_coeff * *
timestep {step!r}
{walls.replace('MODEL', f'{model} cohesion {cohesion} {rolling}')}
{charging}
"""
    for x, y, z, *_ in particles:
        lines += f"create_atoms 1 single {x!r} {y!r} {z!r} units box\n"
    lines += f"set group all diameter {2 * material['radius']!r} density {material['density']}\n"
    for tag, (_, _, _, vx, vy, vz, charge) in enumerate(particles, start=1):
        lines += f"set atom {tag} charge {charge!r} vx {vx!r} vy {vy!r} vz {vz!r}\n"
    return lines + "fix integrate all nve/sphere\n" + after


class Run:
    """Result of a run: `out` (text), `code`, `last` and `frames` (tag -> row of the dump)."""

    columns = "id x y z vx vy vz q".split()

    def __init__(self, text, steps, ranks=1, files=None, dump_every=None, thermo="f_tribo[1]", extra=""):
        """`extra`: more columns of the dump, like "f_field[1] omegax"."""
        self.columns = self.columns + extra.split()
        with tempfile.TemporaryDirectory() as folder:
            for name, content in (files or {}).items():
                pathlib.Path(folder, name).write_text(content)
            every = dump_every or max(steps, 1)
            text += f"""
dump out all custom {every} out.dump {' '.join(self.columns)}
dump_modify out format "%d {' '.join(['%.17g'] * (len(self.columns) - 1))}" sort id
thermo_style custom step atoms {thermo}
thermo_modify format float %.17g
thermo {every}
run {steps}
"""
            pathlib.Path(folder, "in.scene").write_text(text)
            command = [PROGRAM, "-in", "in.scene", "-log", "none"]
            if ranks > 1:
                command = LAUNCHER + [str(ranks)] + command
            done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, encoding="latin-1",
                                  timeout=120)
            self.out, self.code = done.stdout, done.returncode
            dump = pathlib.Path(folder, "out.dump")
            self.frames = self.read(dump.read_text()) if dump.exists() else []
        self.last = self.frames[-1] if self.frames else {}
        self.thermo = [line.split() for line in self.out.splitlines() if line.split() and line.split()[0].isdigit()
                       and len(line.split()) == 2 + len(thermo.split())]

    def read(self, text):
        frames = []
        for block in text.split("ITEM: TIMESTEP")[1:]:
            rows = block.split("ITEM: ATOMS")[1].splitlines()[1:]
            frames.append({int(r.split()[0]): dict(zip(self.columns[1:], map(float, r.split()[1:]))) for r in rows})
        return frames

    def charge(self, tag=1):
        if tag not in self.last:
            raise AssertionError(f"particle {tag} is not in the last dump; the program said:\n{self.out[-1500:]}")
        return self.last[tag]["q"]


def stl(triangles):
    """ASCII STL of triangles ((x, y, z), (x, y, z), (x, y, z))."""
    text = "solid wall\n"
    for corners in triangles:
        text += "facet normal 0 0 0\nouter loop\n"
        text += "".join("vertex %.17g %.17g %.17g\n" % c for c in corners)
        text += "endloop\nendfacet\n"
    return text + "endsolid wall\n"


def plate(size=0.015, height=0.0, cells=1):
    """Square plate at z = height, cells x cells squares of two triangles each; diagonals run through x = y."""
    triangles = []
    step = 2 * size / cells
    for i in range(cells):
        for j in range(cells):
            x, y = -size + i * step, -size + j * step
            a, b, c, d = ((x, y, height), (x + step, y, height), (x + step, y + step, height), (x, y + step, height))
            triangles += [(a, b, c), (a, c, d)]
    return stl(triangles)


def trough(radius, facets, length, pieces):
    """Inside of a horizontal cylinder (axis y) of `facets` flat strips, each cut into `pieces` rectangles along y."""
    triangles = []
    for k in range(facets):
        angles = (2 * math.pi * k / facets, 2 * math.pi * (k + 1) / facets)
        (xa, za), (xb, zb) = ((radius * math.cos(t), radius * math.sin(t)) for t in angles)
        for piece in range(pieces):
            near, far = (length * (2 * (piece + end) / pieces - 1) for end in (0, 1))
            a, b, c, d = (xa, near, za), (xa, far, za), (xb, far, zb), (xb, near, zb)
            triangles += [(a, b, c), (a, c, d)]
    return stl(triangles)
