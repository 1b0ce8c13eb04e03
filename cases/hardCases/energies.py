# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes of motion with charging off or weak: a collapsing cloud, a charge at a wall, the force limiter."""

import re

import numpy as np

from scenes import (COULOMB, NO_CHARGING, RADIUS, SPHERE, STATE, charge, cloud, coulomb, dem, field, head, kinetic, mass, springs, states, time_step)

STRONG = 3e6            # surface field at which air breaks down [V/m]
SHARES = (0.01, 0.05, 0.1, 0.2, 0.3, 0.4)
INTERVALS = (1, 2, 5, 10, 50)
FRAMES = 200


def drift_of(totals, scale):
    """Largest change of the energy and its change at the end, over the scale."""
    change = (np.array(totals) - totals[0])/scale
    return abs(change).max(), change[-1]


def collapse(report):
    """Sixty-four charges of both signs fall together; restitution 1, no friction, no charging."""
    count, time = (2, 0.01) if report.short else (4, 0.055)

    def run(share, every, words="", surface_field=STRONG):
        steps = max(FRAMES, int(time/time_step(share)))
        text = head(0.1, share) + NO_CHARGING + field(every, words)
        text += dem.spheres(cloud(count, 1.6, surface_field), RADIUS, SPHERE["density"])
        return states(dem.run(f"runs/collapse-{100*share:g}-{every}", text, STATE, steps//FRAMES, steps)), steps

    rows, worst, lines = [], {}, {}
    intervals = (1, 10) if report.short else INTERVALS
    for share in ((0.05, 0.2) if report.short else SHARES[1:]):
        cells = []
        for every in intervals:
            state, steps = run(share, every)
            scale = max(kinetic(s) for s in state)
            totals = [kinetic(s) + springs(s) + coulomb(s) for s in state]
            worst[share, every] = drift_of(totals, scale)
            cells.append(f"{worst[share, every][1]:+.1e}")
            if share == 0.1 and every == 1:
                change = (np.array(totals) - totals[0])/scale
                halves = [change[n*FRAMES//4:(n + 1)*FRAMES//4].mean() for n in range(4)]
                recommended = steps, halves
        rows.append((f"{100*share:g} %", *cells))
        lines[f"{100*share:g} % of Rayleigh"] = (intervals, [worst[share, every][0] for every in intervals])
    report.title("A cloud of both signs collapses")
    report.table(["time step over Rayleigh step", *(f"field every {every}" for every in intervals)], rows)
    report.note(f"Change of the energy over {time:g} s, in largest kinetic energies; {count**3} spheres.")
    report.curves["Collapsing cloud, pair sum"] = (("DEM steps per field update", "largest change of the energy"), lines)
    smallest = min(share for share, _ in worst)
    report.must("collapse", f"energy, field every step, {100*smallest:g} % of Rayleigh", f"{worst[smallest, 1][0]:.1e}", worst[smallest, 1][0] < 1e-4, "1e-4")
    if not report.short:
        steps, quarters = recommended
        report.must("collapse", f"recommended (10 %, every step): energy over {steps:.0e} steps", f"{worst[0.1, 1][0]:.1e}", worst[0.1, 1][0] < 1e-4, "1e-4")
        report.must("collapse", "recommended: last quarter less the second", f"{quarters[3] - quarters[1]:+.1e}", abs(quarters[3] - quarters[1]) < 5e-5, "5e-5")
        held = worst[0.1, 50][0]
        report.must("collapse", "held for 50 steps, 10 %: more than with a field of every step, but bounded", f"{held:.1e}",
                    worst[0.1, 1][0] < held < 1e-2, "1e-2")


def orbit(report):
    """Two unlike charges circle each other without touching, a hundred steps per unit of omega T = 1."""
    q, apart = charge(STRONG), 3*RADIUS
    turning = np.sqrt(2*COULOMB*q**2/(mass()*apart**3))               # angular speed of a circle [1/s]
    omega = np.sqrt(2*COULOMB*q**2/(apart**2*mass()*RADIUS))          # what himFoam estimates from the field, the mass and the radius
    share = 0.1
    step = time_step(share)
    turns = 0.25 if report.short else 1.0
    rows, found = [], {}
    for phase in (0.0, 0.003, 0.03) if report.short else (0.0, 0.003, 0.01, 0.03, 0.1, 0.2):
        every = max(1, round(phase/omega/step))
        speed = turning*apart/2
        steps = int(2*np.pi*turns/turning/step)
        text = head(0.02, share) + NO_CHARGING + field(every)
        text += dem.spheres([(-apart/2, 0.0, 0.0, 0.0, -speed, 0.0, q), (apart/2, 0.0, 0.0, 0.0, speed, 0.0, -q)], RADIUS, SPHERE["density"])
        state = states(dem.run(f"runs/orbit-{every}", text, STATE, steps, steps))
        total = [kinetic(s) + coulomb(s) for s in state]
        gain = (total[-1] - total[0])/abs(total[0])
        lag = (every + 1)/2*step if every > 1 else 0.0
        law = 2*turning*lag*2*np.pi*turns
        found[every] = gain, law
        rows.append((every, f"{omega*every*step:.3g}", f"{gain:+.2e}", f"{law:+.2e}"))
    report.title("Two unlike charges circle each other")
    report.table(["DEM steps per field update", "omega T", f"energy won in {turns:g} turns, over the energy that binds", "of a lag of (N+1)/2 steps, while it is small"],
                 rows)
    small = [(gain, law) for every, (gain, law) in found.items() if 1 < every and law < 0.2]
    report.must("orbit", "field every step: energy won in a turn", f"{found[1][0]:+.0e}", abs(found[1][0]) < 1e-6, "1e-6")
    report.must("orbit", "held field: energy won, over that of its lag", ", ".join(f"{gain/law:.2f}" for gain, law in small),
                len(small) > 0 and all(0.8 < gain/law < 1.05 for gain, law in small), "0.8 to 1.05")


def wall(report):
    """A sphere at breakdown charge bounces on a grounded floor under nothing but its image."""
    q, start = charge(STRONG), 1.5*RADIUS
    time = 0.015 if report.short else 0.055
    floor = dem.wall_line("floor", "zplane 0.0")

    def run(share, every, charging, restitution, name, time=time):
        step = time_step(share)
        steps = max(FRAMES, int(time/step))
        text = head(0.01, share, restitution, floor=-RADIUS) + floor + charging + field(every, "images yes")
        text += dem.spheres([(0.0, 0.0, start, 0.0, 0.0, 0.0, q)], RADIUS, SPHERE["density"])
        return states(dem.run(f"runs/wall-{name}-{100*share:g}-{every}", text, STATE, max(1, steps//4000), steps))

    scale = COULOMB*q**2/4*(1/RADIUS - 1/start)         # what the fall to the floor sets free
    rows, worst, lines = [], {}, {}
    intervals = (1, 10) if report.short else INTERVALS
    for share in ((0.05, 0.2) if report.short else SHARES):
        cells = []
        for every in intervals:
            state = run(share, every, "fix tribo all charge/gran/contact pair 1 1 none pair 1 2 none\n", 1.0, "elastic")
            totals = [kinetic(s) + springs(s, floor=True) + coulomb(s, floor=True) for s in state]
            worst[share, every] = drift_of(totals, scale)
            cells.append(f"{worst[share, every][1]:+.1e}")
        rows.append((f"{100*share:g} %", *cells))
        lines[f"{100*share:g} % of Rayleigh"] = (intervals, [worst[share, every][0] for every in intervals])
    report.title("A highly charged sphere falls to a grounded wall")
    report.table(["time step over Rayleigh step", *(f"field every {every}" for every in intervals)], rows)
    report.note("Change of the energy, in energies that the first fall sets free.")
    report.curves["Image attraction at a wall"] = (("DEM steps per field update", "largest change of the energy"), lines)
    report.must("wall", "energy, field every step, 5 % of Rayleigh", f"{worst[0.05, 1][0]:.1e}", worst[0.05, 1][0] < 1e-3, "1e-3")

    # Charged by the floor with the other sign it ends at q_sat and never beyond. Weight holds it down when its charge goes through zero.
    gamma, kappa = -1e6, 2e4
    rows, beyond, ends = [], 0.0, 0.0
    for share in ((0.2,) if report.short else (0.05, 0.2, 0.4)):
        charging = f"fix tribo all charge/gran/contact pair 1 1 none pair 1 2 gamma {gamma!r} kappa {kappa}\n"
        state = run(share, 1, charging + "fix weight all gravity 9.81 vector 0 0 -1\n", 0.8, "charging", 0.06)
        q_sat = charge(gamma)
        charges = state[:, 0, 6]
        beyond = max(beyond, (charges/q_sat).max() - 1, np.diff(charges).max()/q)
        ends = max(ends, abs(charges[-1]/q_sat - 1))
        rows.append((f"{100*share:g} %", f"{charges[-1]/q_sat:.6f}", f"{(charges/q_sat).max() - 1:+.0e}", f"{state[-1, 0, 2]/RADIUS:.5f}"))
    report.table(["time step over Rayleigh step", "charge at the end over q_sat", "beyond q_sat", "height at the end over radius"], rows)
    report.must("wall", "charge falls towards q_sat in every step and not beyond", f"{beyond:+.0e}", beyond < 1e-9, "1e-9")
    report.must("wall", "charge reaches q_sat", f"{ends:.0e}", ends < 1e-3, "1e-3")


def limiter(report):
    """A cloud with a hundred times its possible charge, with the limiter of the field force and without; and a sane one."""
    share, steps = 0.1, 2000
    factor = 1e-4
    rows, found = [], {}
    for name, surface_field in (("possible", STRONG), ("a hundred times as much", 100*STRONG)):
        for words in ("", f"limit_field_force yes field_force_limit_factor {factor!r}"):
            text = head(0.1, share) + NO_CHARGING + field(1, words)
            text += dem.spheres(cloud(2, 1.6, surface_field), RADIUS, SPHERE["density"])
            folder = f"runs/limiter-{name.split()[-1]}{'-limited' if words else ''}"
            frames = dem.run(folder, text, STATE, 1, steps)
            alive = [frame for frame in frames if len(frame) == 8]
            state = states(alive)
            free = np.sqrt(((state[:, :, None, :3] - state[:, None, :, :3])**2).sum(-1)) + 10*RADIUS*np.eye(8) > 2*RADIUS
            untouched = free.all(-1)[1:] & free.all(-1)[:-1]
            kick = np.sqrt((np.diff(state[:, :, 3:6], axis=0)**2).sum(-1))[untouched].max()
            with open(f"{folder}/log.liggghtsHim") as file:
                hits = re.search(r"limited the field force (\d+) times", file.read())
            hits = int(hits.group(1)) if hits else 0
            found[name, bool(words)] = hits, kick, state, len(alive) == len(frames)
            rows.append((name, "on" if words else "off", hits, f"{kick:.3g}", "yes" if len(alive) == len(frames) else "no",
                         f"{np.sqrt((state[-1, :, 3:6]**2).sum(-1)).max():.3g}"))
    skin = 0.5*RADIUS
    allowed = factor*skin/time_step(share)
    report.title("The force limiter")
    report.table(["charge", "limiter", "hits", "largest change of speed in a step without contact [m/s]", "all spheres still there",
                  "fastest at the end [m/s]"], rows)
    report.note(f"The limiter allows {allowed:.3g} m/s per step (factor {factor:g}); mass {mass():.2e} kg.")
    sane = found["possible", False], found["possible", True]
    report.must("limiter", "a possible charge is not limited, same motion to the last bit", f"{sane[1][0]} hits", sane[1][0] == 0
                and np.array_equal(sane[0][2], sane[1][2]), "0 hits")
    wild = found["a hundred times as much", True]
    report.must("limiter", "an impossible charge is held: kick over what is allowed", f"{wild[1]/allowed:.3f}, {wild[0]} hits",
                wild[0] > 0 and wild[1] <= allowed*(1 + 1e-9) and wild[3], "1")
    report.must("limiter", "without it the same charge kicks harder", f"{found['a hundred times as much', False][1]/allowed:.1f}",
                found["a hundred times as much", False][1] > 2*allowed, "2")
