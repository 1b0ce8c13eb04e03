# SPDX-License-Identifier: GPL-3.0-or-later
"""Small scenes for liggghtsHim that cases share: materials, the head of a script, a run, and Hertz's impact. SI units."""

import math
import os
import subprocess

EPSILON0 = 8.8541878128e-12     # [F/m]

# R Tables 2 and 4 (Rasera et al. 2022); the walls' moduli are assumed (aluminium, stainless steel), R gives none.
PTFE = dict(density=2150.0, young=0.564e9, poisson=0.42, friction=0.065)
HDPE = dict(density=968.0, young=0.800e9, poisson=0.46, friction=0.31)
LACTOSE = dict(density=1540.0, young=18.0e9, poisson=0.30, friction=0.5)
ASPIRIN = dict(density=1400.0, young=7.2e9, poisson=0.30, friction=0.5)
SUCROSE = dict(density=1581.0, young=23.0e9, poisson=0.21, friction=0.5)
PA66 = dict(density=1140.0, young=1.27e9, poisson=0.49, friction=0.26)
ALUMINIUM = dict(young=70e9, poisson=0.33)
STEEL = dict(young=193e9, poisson=0.30)


def surface(radius):
    """Area of a sphere [m2]."""
    return 4*math.pi*radius**2


def saturation_charge(gamma, radius):
    """Charge at which an isolated sphere stops charging at a wall [C], R17."""
    return EPSILON0*surface(radius)*gamma


def rayleigh_step(material, radius):
    """Rayleigh time step [s], R13."""
    shear = material["young"]/(2*(1 + material["poisson"]))
    return math.pi*radius*math.sqrt(material["density"]/shear)/(0.8766 + 0.163*material["poisson"])


def effective_modulus(one, other=None):
    """Y* of two bodies [Pa], R6; without a second one it is rigid."""
    return 1/sum((1 - body["poisson"]**2)/body["young"] for body in (one, other) if body)


class Impact:
    """Elastic Hertz impact of a sphere on a flat wall, or of two equal spheres: largest area [m2] and duration [s]."""

    def __init__(self, material, radius, speed, wall=None, pair=False):
        """`wall`: its material, rigid without. `speed`: relative, along the normal [m/s]."""
        mass = 4/3*math.pi*radius**3*material["density"]
        if pair:
            mass, effective_radius, modulus = mass/2, radius/2, effective_modulus(material, material)
        else:
            effective_radius, modulus = radius, effective_modulus(material, wall)
        overlap = (15*mass*speed**2/(16*modulus*math.sqrt(effective_radius)))**0.4
        self.area = math.pi*effective_radius*overlap
        self.duration = 2.9432*overlap/speed


def script_head(box, time_step, sphere, wall, restitution, skin, boundary="f f f"):
    """Box ((x, x), (y, y), (z, z)), materials (type 1 spheres, type 2 walls) and contact models."""
    ends = " ".join(f"{end!r}" for axis in box for end in axis)
    four = " ".join(["%r"]*4)
    return f"""units si
atom_style hybrid granular charge
atom_modify map array
boundary {boundary}
newton off
communicate single vel yes
hard_particles yes
region box block {ends} units box
create_box 2 box
neighbor {skin!r} bin
neigh_modify delay 0
fix modulus all property/global youngsModulus peratomtype {sphere['young']} {wall['young']}
fix poisson all property/global poissonsRatio peratomtype {sphere['poisson']} {wall['poisson']}
fix restitution all property/global coefficientRestitution peratomtypepair 2 {four % ((restitution,)*4)}
fix friction all property/global coefficientFriction peratomtypepair 2 {four % ((sphere['friction'],)*4)}
pair_style gran model hertz tangential history cohesion charge
pair_coeff * *
timestep {time_step!r}
"""


def wall_line(name, words):
    """A primitive wall of type 2, like wall_line("floor", "zplane 0.0")."""
    return f"fix {name} all wall/gran model hertz tangential history cohesion charge primitive type 2 {words}\n"


def spheres(rows, radius, density):
    """`rows` are (x, y, z, vx, vy, vz, charge)."""
    text = "".join(f"create_atoms 1 single {x!r} {y!r} {z!r} units box\n" for x, y, z, *_ in rows)
    text += f"set group all diameter {2*radius!r} density {density!r}\n"
    for tag, (*_, vx, vy, vz, charge) in enumerate(rows, start=1):
        text += f"set atom {tag} charge {charge!r} vx {vx!r} vy {vy!r} vz {vz!r}\n"
    return text + "fix motion all nve/sphere\n"


class Stopped(SystemExit):
    """A program ended with an error. `report`: what its log says of it; `frames`: those before it."""

    def __init__(self, program, log, frames):
        super().__init__(f"{program} stopped; see {log}")
        with open(log, errors="replace") as file:
            text = file.read()
        self.report = " ".join(text[text.rfind("ERROR"):].split()) if "ERROR" in text else text[-500:]
        self.frames = frames


def dump(columns, every):
    """Lines of a script that write `columns` of all spheres to out.dump with all digits."""
    formats = " ".join(["%.17g"]*len(columns))
    return f'dump out all custom {every} out.dump id {" ".join(columns)}\ndump_modify out format "%d {formats}" sort id\n'


def read_frames(path, columns):
    """Frames of a dump: {tag: {column: value}} per dumped step."""
    if not os.path.exists(path):
        return []
    with open(path) as file:
        blocks = file.read().split("ITEM: TIMESTEP")[1:]
    rows = [[row.split() for row in block.split("ITEM: ATOMS")[1].splitlines()[1:]] for block in blocks]
    return [{int(row[0]): dict(zip(columns, map(float, row[1:]))) for row in frame} for frame in rows]


def run(folder, text, columns, every, steps, thermo=None, lost="warn"):
    """Runs a script with a dump; returns its frames: {tag: {column: value}} per dumped step, that of step 0 included. With
    `thermo`, words like "f_tribo[1] f_field", also their values per dumped step. `lost`: what LIGGGHTS does when spheres are gone,
    `error` looks after every dump. Raises Stopped."""
    os.makedirs(folder, exist_ok=True)
    text += dump(columns, every) + f"""thermo_style custom step atoms {thermo or 'ke'}
thermo_modify format float %.17g lost {lost}
thermo {every if thermo or lost == 'error' else max(steps, 1)}
run {steps}
"""
    with open(os.path.join(folder, "in.scene"), "w") as file:
        file.write(text)
    with open(os.path.join(folder, "log.liggghtsHim"), "w") as log:
        done = subprocess.run(["liggghtsHim", "-in", "in.scene", "-log", "none"], cwd=folder, stdout=log, stderr=subprocess.STDOUT)
    frames = read_frames(os.path.join(folder, "out.dump"), columns)
    if done.returncode:
        raise Stopped("liggghtsHim", f"{folder}/log.liggghtsHim", frames)
    if thermo is None:
        return frames
    with open(os.path.join(folder, "log.liggghtsHim")) as file:
        rows = [line.split() for line in file]
    count = 2 + len(thermo.split())
    return frames, [list(map(float, row[2:])) for row in rows if len(row) == count and row[0].isdigit() and row[1].isdigit()]
