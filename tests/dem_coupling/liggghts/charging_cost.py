# SPDX-License-Identifier: GPL-3.0-or-later
"""What contact charging adds to LIGGGHTS' own time per step. No test: run it by hand, on a core of its own if you can.

    LIGGGHTS_HIM=<build>/bin/liggghtsHim taskset -c 0 python3 charging_cost.py [resting|agitated]

Two programs hold the same bed, one with `cohesion off` and one that charges. Both are set up and settled first, then they take
short turns, and the CPU time of each turn counts. Clocks and neighbours of a shared machine change slower than the turns, so that
they hit both programs alike. Where the system puts a program's memory can make it faster or slower by a tenth for as long as it lives,
so that all is repeated with new programs. Compare ratios only.
"""
import argparse
import pathlib
import statistics
import subprocess
import tempfile

from scene import PROGRAM

RADIUS = 1e-3        # [m]
DENSITY = 2000.0     # [kg/m3]
YOUNG = 1e6          # [Pa], softened
STEP = 1e-5          # [s]
SPEED = 0.15         # of the agitated spheres, largest of each component [m/s]

# Resting: layers under gravity, squeezed sideways by 0.05 % of the diameter and leaning on their tangential springs; six contacts
# each, as many as a loose random packing has. Agitated: a granular gas of 37 % by volume between two walls, without gravity.
SCENES = {
    "resting": dict(spacing=0.9995, restitution=0.5, settle=100,
                    motion="fix g all gravity 9.81 vector 0.1 0 -1"),
    "agitated": dict(spacing=1.12, restitution=0.95, settle=100,
                     motion="".join(f"variable v{axis} atom random(-{SPEED},{SPEED},{seed})\n" for axis, seed in
                                    zip("xyz", (15485863, 32452843, 49979687))) + "velocity all set v_vx v_vy v_vz"),
}


def bed(scene, across, charging):
    """The script up to the first run. Periodic sideways."""
    spacing = 2 * RADIUS * scene["spacing"]
    width, height = across * spacing, across * spacing + (0.1 * RADIUS if scene["spacing"] > 1 else 4 * RADIUS)
    cohesion = "charge" if charging else "off"
    model = f"model hertz tangential history cohesion {cohesion}"
    tribo = "fix tribo all charge/gran/contact pair 1 1 gamma 0 kappa 10 pair 1 2 gamma -1e6 kappa 10" if charging else ""
    matrix = " ".join([str(scene["restitution"])] * 4)
    return f"""units si
atom_style hybrid granular charge
atom_modify map array
boundary p p f
newton off
communicate single vel yes
region box block 0 {width!r} 0 {width!r} 0 {height!r} units box
create_box 2 box
neighbor {0.3 * RADIUS!r} bin
neigh_modify delay 0
soft_particles yes
fix m1 all property/global youngsModulus peratomtype {YOUNG} {YOUNG}
fix m2 all property/global poissonsRatio peratomtype 0.4 0.4
fix m3 all property/global coefficientRestitution peratomtypepair 2 {matrix}
fix m4 all property/global coefficientFriction peratomtypepair 2 0.3 0.3 0.3 0.3
pair_style gran {model}
pair_coeff * *
timestep {STEP}
fix floor all wall/gran {model} primitive type 2 zplane 0.0
fix lid all wall/gran {model} primitive type 2 zplane {height!r}
{tribo}
lattice sc {spacing!r} origin 0.5 0.5 0.4995
region bed block 0 {across} 0 {across} 0 {across} units lattice
create_atoms 1 region bed
set group all diameter {2 * RADIUS!r} density {DENSITY}
{scene["motion"]}
fix integrate all nve/sphere
compute touching all contact/atom
compute contacts all reduce ave c_touching
thermo_style custom step atoms ke
thermo 1000000
"""


class Bed:
    """One liggghtsHim that waits for commands."""

    def __init__(self, text, settle, folder):
        self.process = subprocess.Popen([PROGRAM, "-log", "none"], cwd=folder, stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, encoding="latin-1")
        self.steps = 0
        self.do(text + f"run {settle}\n")

    def do(self, commands):
        """Gives commands and waits for their end; what the program said."""
        self.process.stdin.write(commands + 'print "reached the end"\n')
        self.process.stdin.flush()
        said = ""
        for line in self.process.stdout:
            if line.startswith("reached the end"):
                return said
            said += line
        raise SystemExit(f"liggghtsHim ended:\n{said[-2000:]}")

    def seconds(self):
        """CPU time since its start [s]."""
        return int(pathlib.Path(f"/proc/{self.process.pid}/schedstat").read_text().split()[0]) * 1e-9

    def turn(self, steps):
        """CPU time per step [s]."""
        before = self.seconds()
        self.do(f"run {steps} pre no post no\n")
        return (self.seconds() - before) / steps

    def report(self):
        """Spheres, contacts of each, and kinetic energy [J]."""
        said = self.do("thermo_style custom step atoms ke c_contacts\nrun 0 post no\n").split("\n")
        row = next(n for n, line in enumerate(said) if line.split()[:1] == ["Step"])
        _, spheres, energy, contacts = said[row + 1].split()
        return int(spheres), float(contacts), float(energy)

    def close(self):
        self.process.stdin.close()
        self.process.wait()


def take_turns(scene, arguments):
    """CPU times per step (off, charging) [s] of every pair of turns, and what the bed looked like at the end."""
    pairs = []
    with tempfile.TemporaryDirectory() as folder:
        off, charging = (Bed(bed(scene, arguments.n, on), scene["settle"], folder) for on in (False, True))
        steps = max(1, round(arguments.seconds / off.turn(10)))
        charging.turn(10)
        for turn in range(arguments.turns):
            # Who goes first changes, so that a clock that falls or rises favours neither.
            times = {side: side.turn(steps) for side in ((off, charging) if turn % 2 == 0 else (charging, off))}
            pairs.append((times[off], times[charging]))
        state = charging.report()
        for side in (off, charging):
            side.close()
    return pairs, state


def measure(name, arguments):
    pairs = []
    for program in range(arguments.programs):
        more, (spheres, contacts, energy) = take_turns(SCENES[name], arguments)
        pairs += more
        print(f"{name}, programs {program + 1}: {spheres} spheres, {contacts:.2f} contacts each, {energy:.3g} J; fastest turns "
              f"off {1e3 * min(p[0] for p in more):.1f} ms per step, charging {1e3 * min(p[1] for p in more):.1f} ms", flush=True)
    least = [min(times) for times in zip(*pairs)]
    ratios = sorted(after / before for before, after in pairs)
    quarter = len(ratios) // 4
    print(f"{name}: charging over off: {least[1] / least[0]:.3f} of the fastest turns, {statistics.median(ratios):.3f} median of {len(ratios)} "
          f"pairs of turns (half of them {ratios[quarter]:.3f} to {ratios[-1 - quarter]:.3f})", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", nargs="*", help="resting or agitated; default: both")
    parser.add_argument("-n", type=int, default=46, help="spheres along each edge of the bed (46: 97,336)")
    parser.add_argument("-programs", type=int, default=4, help="pairs of programs, one after the other")
    parser.add_argument("-turns", type=int, default=24, help="turns of each program")
    parser.add_argument("-seconds", type=float, default=0.25, help="length of a turn")
    arguments = parser.parse_args()
    for name in arguments.scene or SCENES:
        if name not in SCENES:
            parser.error(f"there is no scene {name}; there are {', '.join(SCENES)}")
        measure(name, arguments)


if __name__ == "__main__":
    main()
