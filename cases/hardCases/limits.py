# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the scenes of this suite fail: time steps up to four times the Rayleigh step, fields held for thousands of steps.

A setting counts as failed when the energy changes by a tenth of its scale, or a sphere is lost."""

import math

import numpy as np

import mesh
from scenes import (COULOMB, NO_CHARGING, RADIUS, SPHERE, STATE, charge, cloud, coulomb, dem, dodecahedron, field, head, kinetic, mass,
                    spheres_of_sizes, springs, states, time_step)

STRONG = 3e6                    # surface field at which air breaks down [V/m]
SHARES = (0.4, 0.6, 0.8, 1.0, 1.2, 1.5, 2.0, 2.5)
INTERVALS = (50, 100, 200, 500, 1000, 2000)
MESH_SHARES = (0.1, 0.2, 0.4, 0.8, 1.2, 1.6, 2.0)
FAILED = 0.1
PAIR_RADIUS = 1.59e-3           # [m]


class Outcome:
    """Largest change of the energy, deepest overlap over the radius, and what the program says of lost spheres ('' when none is)."""

    def __init__(self, energy, overlap, lost=""):
        self.energy, self.overlap, self.lost = energy, overlap, lost
        self.failed = bool(lost) or not energy < FAILED

    def cell(self):
        return f"{self.energy:.1e}" + (", lost" if self.lost else "")


def watch(folder, text, every, steps, energy, scale, overlap, ends=False):
    """Runs a scene until a sphere is lost; `energy` and `overlap` of a frame, `scale` of all frames. `ends`: the energy of the last frame
    counts alone, where springs change within few steps."""
    lost = ""
    try:
        frames = dem.run(folder, text, STATE, every, steps, lost="error")
    except dem.Stopped as stop:
        frames, lost = stop.frames, stop.report
        if "ost atoms" not in lost:
            raise
    state = states([frame for frame in frames if len(frame) == len(frames[0])])
    totals = np.array([energy(s) for s in (state[[0, -1]] if ends else state)])
    return Outcome(abs(totals - totals[0]).max()/scale(state), max(overlap(s) for s in state), lost)


def deepest(state, radius=RADIUS, floor=False):
    """Deepest overlap over the radius."""
    first, second = np.triu_indices(len(state), 1)
    gaps = np.sqrt(((state[first, :3] - state[second, :3])**2).sum(-1)) - 2*radius
    gaps = np.append(gaps, state[:, 2].min() - radius if floor else [])
    return max(0.0, -gaps.min())/radius


def fallen_cloud(share, every=1, time=0.055):
    steps = int(time/time_step(share))
    text = head(0.1, share) + NO_CHARGING + field(every) + dem.spheres(cloud(4, 1.6, STRONG), RADIUS, SPHERE["density"])
    return watch(f"runs/limits-cloud-{100*share:g}-{every}", text, max(1, steps//1000), steps, lambda s: kinetic(s) + springs(s) + coulomb(s),
                 lambda state: 2.17*abs(coulomb(state[0])), deepest)


def at_wall(share, every=1):
    q, start, steps = charge(STRONG), 1.5*RADIUS, int(0.055/time_step(share))
    text = head(0.01, share, floor=-RADIUS) + dem.wall_line("floor", "zplane 0.0")
    text += "fix tribo all charge/gran/contact pair 1 1 none pair 1 2 none\n" + field(every, "images yes")
    text += dem.spheres([(0.0, 0.0, start, 0.0, 0.0, 0.0, q)], RADIUS, SPHERE["density"])
    return watch(f"runs/limits-wall-{100*share:g}-{every}", text, max(1, steps//4000), steps,
                 lambda s: kinetic(s) + springs(s, floor=True) + coulomb(s, floor=True),
                 lambda state: COULOMB*q**2/4*(1/RADIUS - 1/start), lambda s: deepest(s, floor=True))


def head_on(share):
    """Worst of eight phases of a step at 10 m/s: energy, overlap, and the charge left against the law."""
    speed, kappa, q = 10.0, 20.0, charge(1e6, PAIR_RADIUS)
    impact = dem.Impact(SPHERE, PAIR_RADIUS, speed, pair=True)
    law = math.exp(-2*kappa*impact.area/dem.surface(PAIR_RADIUS))
    step, worst, off = time_step(share, PAIR_RADIUS), Outcome(0.0, 0.0), 0.0
    for phase in np.arange(8)/8:
        gap = 0.1*PAIR_RADIUS + phase*step*speed
        start, steps = PAIR_RADIUS + gap/2, int((2*gap/speed + 1.2*impact.duration)/step) + 2
        pair = dem.spheres([(-start, 0.0, 0.0, speed/2, 0.0, 0.0, q), (start, 0.0, 0.0, -speed/2, 0.0, 0.0, -q)], PAIR_RADIUS, SPHERE["density"])
        text = head(12*PAIR_RADIUS, share, radius=PAIR_RADIUS)
        found = watch(f"runs/limits-headOn-{100*share:g}-{phase:g}", text + NO_CHARGING + field(1) + pair, 1, steps,
                      lambda s: kinetic(s, PAIR_RADIUS) + springs(s, PAIR_RADIUS) + coulomb(s),
                      lambda state: kinetic(state[0], PAIR_RADIUS), lambda s: deepest(s, PAIR_RADIUS), ends=True)
        worst = Outcome(max(worst.energy, found.energy), max(worst.overlap, found.overlap), worst.lost or found.lost)
        text += f"fix tribo all charge/gran/contact pair 1 1 gamma 0 kappa {kappa} pair 1 2 none pair 2 2 none\n" + field(1) + pair
        frames = dem.run(f"runs/limits-headOn-{100*share:g}-{phase:g}-charging", text, STATE, steps, steps)
        off = max(off, states(frames)[-1, 0, 6]/q/law - 1, key=abs)
    return worst, off


def many_contacts(share):
    """Twenty spheres hit a large one at kappa 1e5: kinetic energy after the rebound, and whether charges stay in range and in sum."""
    radius, large, speed = 0.5e-3, 1.0e-3, 1.0
    q, away = charge(1e6, large), large + radius + 1e-6
    text = head(6e-3, share, radius=radius) + "fix tribo all charge/gran/contact pair 1 1 gamma 0 kappa 1e5 pair 1 2 none pair 2 2 none\n"
    text += spheres_of_sizes([(0.0,)*6 + (q,)] + [(*(away*d for d in way), *(-speed*d for d in way), 0.0) for way in dodecahedron()],
                             [large] + [radius]*20)
    duration = 2.9432*(15*mass(radius)*speed**2/(16*dem.effective_modulus(SPHERE, SPHERE)*math.sqrt(radius*large/(radius + large))))**0.4/speed
    steps = int(2*duration/time_step(share, radius)) + 2
    state = states(dem.run(f"runs/limits-neighbours-{100*share:g}", text, STATE, 1, steps))
    masses = np.array([mass(large)] + [mass(radius)]*20)
    energy = [0.5*(masses*(s[:, 3:6]**2).sum(1)).sum() for s in (state[0], state[-1])]
    fields = state[:, :, 6]/np.array([large**2] + [radius**2]*20)
    beyond = max((fields[:, 1:].max(1) - fields[:, 0]).max()/fields[0, 0], abs(state[:, :, 6].sum(1)/q - 1).max())
    return abs(energy[1]/energy[0] - 1), beyond, duration/time_step(share, radius)


def last_before(outcomes):
    """The largest setting before the first that fails, and that one (None when none does)."""
    settings = sorted(outcomes)
    for n, setting in enumerate(settings):
        if outcomes[setting].failed:
            return settings[n - 1] if n else None, setting
    return settings[-1], None


def limit_words(name, outcomes, unit):
    holds, fails = last_before(outcomes)
    if fails is None:
        return f"{name}: nothing fails up to {unit(holds)}"
    found = outcomes[fails]
    how = f"a sphere is lost ({found.lost[:90]})" if found.lost else f"energy off by {found.energy:.2g}, overlaps to {found.overlap:.3f} radii"
    return f"{name}: {unit(holds) if holds is not None else 'nothing'} holds, {unit(fails)} fails: {how}"


def percent(share):
    return f"{100*share:g} %"


def limits(report):
    if not report.long and report.only != "limits":
        return
    clouds, walls, heads, touches = {}, {}, {}, {}
    rows = []
    for share in SHARES:
        clouds[share], walls[share] = fallen_cloud(share), at_wall(share)
        (heads[share], off), touches[share] = head_on(share), many_contacts(share)
        energy, beyond, steps = touches[share]
        impact = dem.Impact(SPHERE, PAIR_RADIUS, 10.0, pair=True).duration/time_step(share, PAIR_RADIUS)
        slow = dem.Impact(SPHERE, RADIUS, 0.8, pair=True).duration/time_step(share)
        rows.append((percent(share), clouds[share].cell(), f"{slow:.1f}", walls[share].cell(), heads[share].cell(), f"{heads[share].overlap:.3f}",
                     f"{100*off:+.1f} %", f"{impact:.1f}", f"{energy:.1e}", f"{beyond:.0e}"))
        print(f"limits: {percent(share)} done", flush=True)
    report.title("Beyond 40 % of the Rayleigh step")
    report.table(["time step over Rayleigh step", "cloud: energy", "steps per contact at 0.8 m/s", "wall: energy", "head-on at 10 m/s: energy, worst of 8",
                  "overlap over radius", "charge against the law", "steps per contact", "twenty neighbours: kinetic energy", "charges out of range or sum"], rows)
    for name, found in (("cloud", clouds), ("wall", walls), ("head-on", heads)):
        report.note(limit_words(name, found, percent) + ".")
    for name, found in (("cloud", clouds), ("wall", walls), ("head-on", heads)):
        holds, fails = last_before(found)
        report.must("limits", f"{name}: a limit is found above 40 % of Rayleigh", limit_words(name, found, percent), holds is not None and holds >= 0.4
                    and fails is not None, "")
    worst = max(beyond for _, beyond, _ in touches.values())
    report.must("limits", "twenty neighbours: charges in range and sum at every time step", f"{worst:.0e}", worst < 1e-10, "1e-10")
    shares = {name: ([100*s for s in found], [found[s].energy for s in found]) for name, found in (("cloud", clouds), ("wall", walls), ("head-on", heads))}
    report.curves["Limits of the time step"] = (("time step [% of Rayleigh]", "largest change of the energy"), shares)
    held_fields(report)
    on_a_mesh(report)


def held_fields(report):
    rows = []
    found = {("cloud", every): fallen_cloud(0.1, every) for every in INTERVALS}
    found.update({("wall", every): at_wall(0.1, every) for every in (5, 10, 20, *INTERVALS)})
    for name in ("cloud", "wall"):
        rows.append((name, *(found[name, every].cell() if (name, every) in found else "" for every in (5, 10, 20, *INTERVALS))))
    report.title("Fields held for more than 50 steps")
    report.table(["pair sum, 10 % of Rayleigh", *(f"every {every}" for every in (5, 10, 20, *INTERVALS))], rows)
    for name in ("cloud", "wall"):
        report.note(limit_words(name, {every: outcome for (n, every), outcome in found.items() if n == name}, lambda every: f"every {every} steps") + ".")


def on_a_mesh(report):
    found, rows = {}, []
    for name in ("p3m", "p3m, 3 cells", "him"):
        cells = []
        for share in MESH_SHARES:
            step = time_step(share)
            steps = max(mesh.FRAMES, int(0.011/step)//mesh.FRAMES*mesh.FRAMES)
            folder = f"runs/limits-mesh-{name.replace(',', '').replace(' ', '-')}-{100*share:g}"
            try:
                found[name, share] = Outcome(mesh.drift(mesh.run(folder, mesh.METHODS[name], 1, steps, step))[0], 0.0)
            except dem.Stopped as stop:
                found[name, share] = Outcome(math.inf, 0.0, stop.report)
            cells.append(found[name, share].cell())
            print(f"limits: {name}, {percent(share)}: {cells[-1]}", flush=True)
        rows.append((name, *cells))
    report.title("The cloud in a grounded cube at longer time steps (himFoam)")
    report.table(["field of every step", *(percent(share) for share in MESH_SHARES)], rows)
    for name in ("p3m", "p3m, 3 cells"):
        report.note(limit_words(name, {share: outcome for (n, share), outcome in found.items() if n == name}, percent) + ".")
    rows, step = [], time_step(mesh.SHARE)
    for name in ("p3m, 3 cells", "p3m, 3 cells, nearField", "him"):
        cells = []
        for every in (1000, 2000, 5000, 20000):
            folder = f"runs/limits-mesh-{name.replace(',', '').replace(' ', '-')}-held-{every}"
            cells.append(f"{mesh.drift(mesh.run(folder, mesh.METHODS[name], every, 20000, step))[0]:.1e}")
        rows.append((name, *cells))
    report.table(["10 % of Rayleigh, field of every ... steps", "1000", "2000", "5000", "20000 (never)"], rows)
