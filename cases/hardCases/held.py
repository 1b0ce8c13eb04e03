# SPDX-License-Identifier: GPL-3.0-or-later
"""Fields that himFoam holds between two updates, as a whole or less a near field that follows: when charges do not stay together, and
what energy it costs. No mesh: the pair sum is exact, so that what is lost or won comes from holding alone."""

import math
import re

import numpy as np

import foam
from scenes import COULOMB, NO_CHARGING, RADIUS, SPHERE, charge, cloud, coulomb, dem, head, kinetic, mass, springs, states, time_step

STRONG = 3e6                                                        # surface field at which air breaks down [V/m]
CHARGE = charge(STRONG)
# What himFoam estimates for two of these spheres in contact, and for one that touches a grounded wall [1/s].
CONTACT = math.sqrt(2*COULOMB*CHARGE**2/((2*RADIUS)**2*mass()*RADIUS))
DRIFTING, LARGEST = 0.1, 0.75                                       # as in dem_coupling/field_frequency.hpp


def run(name, script, share, time, held, near=None, images=False, walls="", frames=200):
    """Frames, and omega T of the whole field and of its far part by the log. `held`: time between two updates [s]; `near`: interval
    [DEM steps] and reach [m] of nearField."""
    step = time_step(share)
    every = max(1, round(held/step))
    updates = max(1, round(time/step/every))
    entries = "fieldMethod pairwiseSum;" + (" pairwiseSumCoeffs { images yes; }" if images else "")
    entries += f" nearField {{ interval {near[0]}; reach {near[1]!r}; }}" if near else ""
    try:
        found, log = foam.run(f"runs/held-{name}", entries, script, max(1, every*updates//frames), foam.control(step, every, updates), walls)
    except dem.Stopped as stop:
        found, log = stop.frames, ""        # a sphere that left the box; what it had won by then is in the frames
        if "missing: particle" not in stop.report:
            raise
    phases = [re.search(rf"{part} field held, largest omega T +(\S+)", log) for part in ("near", "far")]
    return states([frame for frame in found if len(frame) == len(found[0])]), [float(p[1]) if p else float("nan") for p in phases]


def circle(apart, phase, turns, near=None):
    """A pair on a circle, `apart` radii between centres; `phase` is omega T of the update. Returns the energy won in a turn over the
    energy that binds, and the turns after which it no longer binds, or none."""
    distance = apart*RADIUS
    turning = math.sqrt(2*COULOMB*CHARGE**2/(mass()*distance**3))
    omega = math.sqrt(2*COULOMB*CHARGE**2/(distance**2*mass()*RADIUS))
    speed = turning*distance/2
    script = head(0.02, 0.4) + NO_CHARGING
    script += dem.spheres([(-distance/2, 0.0, 0.0, 0.0, -speed, 0.0, CHARGE), (distance/2, 0.0, 0.0, 0.0, speed, 0.0, -CHARGE)], RADIUS,
                          SPHERE["density"])
    name = f"circle-{apart:g}-{phase:g}" + (f"-{near[0]}-{near[1]/RADIUS:g}" if near else "")
    state, phases = run(name, script, 0.4, turns*2*math.pi/turning, phase/omega, near, frames=100*turns)
    energy = np.array([kinetic(s) + springs(s) + coulomb(s) for s in state])
    won = (energy - energy[0])/abs(energy[0])
    parted = np.argmax(won >= 1)/100 if (won >= 1).any() else None
    return won[min(100, len(won) - 1)], parted, phases


def falling(phase, near=None):
    """The energy that a sphere under its own image has won over 0.055 s and about six bounces, over that of its fall."""
    start, share = 1.5*RADIUS, 0.1
    script = head(0.01, share, floor=-RADIUS) + dem.wall_line("floor", "zplane 0.0")
    script += "fix tribo all charge/gran/contact pair 1 1 none pair 1 2 none\n"
    script += dem.spheres([(0.0, 0.0, start, 0.0, 0.0, 0.0, CHARGE)], RADIUS, SPHERE["density"])
    name = f"wall-{phase:g}" + (f"-{near[0]}-{near[1]/RADIUS:g}" if near else "")
    state, phases = run(name, script, share, 0.055, phase/CONTACT, near, True, "floor grounded;", 4000)
    energy = [kinetic(s) + springs(s, floor=True) + coulomb(s, floor=True) for s in state]
    return (energy[-1] - energy[0])/(COULOMB*CHARGE**2/4*(1/RADIUS - 1/start)), phases


def collapsing(phase, near=None, time=0.055):
    """The energy that a cloud of 64 charges of both signs has won, over its binding energy; its kinetic energy comes to 2.2 of that."""
    share = 0.4
    script = head(0.1, share) + NO_CHARGING + dem.spheres(cloud(4, 1.6, STRONG), RADIUS, SPHERE["density"])
    name = f"cloud-{phase:g}" + (f"-{near[0]}-{near[1]/RADIUS:g}" if near else "")
    state, phases = run(name, script, share, time, phase/CONTACT, near)
    first, last = (kinetic(s) + springs(s) + coulomb(s) for s in (state[0], state[-1]))
    return (last - first)/abs(coulomb(state[0])), phases


def told(parted):
    return "no" if parted is None else f"after {parted:.2f} turns"


def held(report):
    pairs = {}

    def pair(apart, phase, turns=10, near=None):
        pairs[apart, phase, near] = circle(apart, phase, turns, near)
        return pairs[apart, phase, near]

    report.title("How long himFoam can hold a field")
    if report.short:
        for phase in (LARGEST, 0.8):
            pair(2.2, phase, 2)
    else:
        phases = (0.01, 0.03, 0.1, 0.3, 0.5, 0.7, 0.75, 0.8, 0.85, 0.9, 1.0, 1.5)
        apart = (2.05, 2.2, 2.5, 3.0, 6.0) if report.long else (2.2, 3.0)
        rows = []
        for phase in phases:
            found = [pair(a, phase) for a in apart]
            rows.append((f"{phase:g}", *(f"{won:+.2f}, {told(parted)}" for won, parted, _ in found)))
        report.table(["omega T", *(f"{a:g} radii apart" for a in apart)], rows)
        report.note("Two unlike charges on a circle: energy won in the first turn, over the energy that binds them; whether they part within ten turns.")
        near_tables(report, pair)
    stay, part = (pairs[2.2, phase, None] for phase in (LARGEST, 0.8))
    report.must("held", f"a pair next to contact stays together at omega T = {LARGEST:g} and parts at 0.8", f"{told(stay[1])}; {told(part[1])}",
                stay[1] is None and part[1] is not None, "")
    if report.short:
        return
    report.curves["A pair on a circle, himFoam"] = (
        ("omega T", "energy won in a turn, over what binds"),
        {f"{a:g} radii apart": ([p for p in phases if (a, p, None) in pairs], [pairs[a, p, None][0] for p in phases if (a, p, None) in pairs])
         for a in apart})
    if report.long:
        clouds_and_walls(report)


def near_tables(report, pair):
    """nearField: reach against update, then its own interval."""
    reaches = (3, 6, 12)
    rows = []
    for phase in (0.1, 0.3, 1.0, 2.0, 3.0, 5.0, 10.0):
        found = [pair(2.2, phase, 4, (1, reach*RADIUS)) for reach in reaches]
        rows.append((f"{phase:g}", *(f"{won:+.2f}, {told(parted)} ({phases[1]:.2g})" for won, parted, phases in found)))
    report.table(["omega T of the update", *(f"reach {reach/2:g} diameters" for reach in reaches)], rows)
    report.note("The same pair, 2.2 radii apart, with nearField { interval 1; }; within four turns; in brackets omega T of what stays held, as himFoam prints it.")
    step, omega = time_step(0.4), CONTACT*(2/2.2)
    rows = []
    for phase in (0.01, 0.1, 0.3, 0.75, 0.8, 1.0):
        interval = max(1, round(phase/omega/step))
        won, parted, phases = pair(2.2, max(1.0, phase), 4, (interval, 12*RADIUS))
        rows.append((f"{phase:g}", f"{won:+.2f}", told(parted)))
    report.table(["omega T of nearField's interval", "energy won in a turn", "parts"], rows)
    report.note("The near field itself held; reach six diameters, update at omega T = 1.")


def clouds_and_walls(report):
    clouds, walls = {}, {}
    phases = (0.01, 0.03, 0.1, 0.2, 0.3, 0.5, 0.75, 1.0, 2.0)
    rows = []
    for phase in phases:
        clouds[phase], walls[phase] = collapsing(phase), falling(phase)
        rows.append((f"{phase:g}", f"{clouds[phase][0]:+.3f}", f"{clouds[phase][1][0]:.2g}", f"{walls[phase][0]:+.3f}"))
    report.table(["omega T of a pair in contact", "cloud: energy won over what bound it", "largest omega T by the log", "wall: energy won over that of the fall"],
                 rows)
    rows = []
    for phase in (0.3, 1.0, 3.0):
        cells = []
        for reach in (3, 6, 12, 24):
            won, told_phases = collapsing(phase, (1, reach*RADIUS))
            cells.append(f"{won:+.3f} ({told_phases[1]:.2g})")
            clouds[phase, reach] = won
        for reach in (3, 6, 12):
            cells.append(f"{falling(phase, (1, reach*RADIUS))[0]:+.3f}")
        rows.append((f"{phase:g}", *cells))
    report.table(["omega T of the update", *(f"cloud, reach {reach/2:g} diameters" for reach in (3, 6, 12, 24)),
                  *(f"wall, reach {reach/2:g}" for reach in (3, 6, 12))], rows)
    report.note("The cloud and the wall again, with nearField { interval 1; }; in brackets omega T of what stays held.")
    report.must("held", "cloud, held at omega T = 0.03: energy won over what bound it", f"{clouds[0.03][0]:.3f}", abs(clouds[0.03][0]) < 0.05, "0.05")
    report.must("held", "cloud at omega T = 1: won with a reach of six diameters over without", f"{clouds[1.0, 12]/clouds[1.0][0]:.3f}",
                abs(clouds[1.0, 12]) < 0.1*clouds[1.0][0], "0.1")
