# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes of contact charging: oscillating and resting contacts, fast impacts, many sizes, many neighbours."""

import math

import numpy as np

from scenes import (NO_CHARGING, SPHERE, charge, coulomb, dem, dodecahedron, field, head, kinetic, law_of_a_pair, mass, mixed, spheres_of_sizes,
                    springs, states, time_step)

SHARES = (0.01, 0.05, 0.1, 0.2, 0.3, 0.4)
PAIR_RADIUS = 1.59e-3       # [m]


def oscillating(report):
    """Two spheres pressed against each other breathe for ever without opening (restitution 1)."""
    kappa, radius, steps = 0.5, PAIR_RADIUS, 4000 if report.short else 100000
    modulus = dem.effective_modulus(SPHERE, SPHERE)
    rest = 1e-5                                                     # overlap in equilibrium [m]
    force = 4/3*modulus*math.sqrt(radius/2)*rest**1.5
    place = radius - rest/4                                         # half the overlap of equilibrium
    rows = []
    worst = {}
    for reloading in ("counted", "beyondMaximum"):
        for electric in (False, True):
            for equal in (False, True):
                text = head(5*radius, 0.1, radius=radius)
                text += f"fix tribo all charge/gran/contact pair 1 1 gamma 0 kappa {kappa} pair 1 2 none pair 2 2 none reloading {reloading}\n"
                text += field(1) if electric else ""
                q = charge(1e5, radius)
                text += dem.spheres([(-place, 0.0, 0.0, 0.0, 0.0, 0.0, q), (place, 0.0, 0.0, 0.0, 0.0, 0.0, q if equal else 0.0)], radius,
                                    SPHERE["density"])
                text += f"group one id 1\ngroup two id 2\nfix right one addforce {force!r} 0 0\nfix left two addforce {-force!r} 0 0\n"
                name = f"runs/contact-{reloading}{'-field' if electric else ''}{'-equal' if equal else ''}"
                state = states(dem.run(name, text, ["x", "y", "z", "vx", "vy", "vz", "q"], 1, steps))
                moved = state[:, 0, 6] - state[:, 1, 6]
                if equal:
                    # Equal charges have nothing to exchange, however often the contact breathes.
                    worst["equal"] = max(worst.get("equal", 0), abs(moved).max()/q)
                    continue
                law = law_of_a_pair(state, kappa, radius, reloading == "beyondMaximum")
                off = abs(moved/q - law).max()
                worst["law"] = max(worst.get("law", 0), off)
                worst["sum"] = max(worst.get("sum", 0), abs(state[:, :, 6].sum(1)/q - 1).max())
                turns = (np.diff(np.sign(np.diff(state[:, 0, 0]))) != 0).sum()/2
                rows.append((reloading, "yes" if electric else "no", f"{turns:.0f}", f"{moved[-1]/q:.6f}", f"{law[-1]:.6f}", f"{off:.0e}"))
                if reloading == "beyondMaximum":
                    worst["late"] = max(worst.get("late", 0), abs(moved[-1] - moved[len(moved)//2])/q)
    report.title("Two charged spheres that breathe in contact")
    report.table(["reloading", "field", "oscillations", "charge difference left", "law", "largest difference over all steps"], rows)
    report.must("contact", "charge difference follows the law at every step", f"{worst['law']:.0e}", worst["law"] < 1e-9, "1e-9")
    report.must("contact", "equal charges stay equal", f"{worst['equal']:.0e}", worst["equal"] < 1e-12, "1e-12")
    report.must("contact", "sum of the charges", f"{worst['sum']:.0e}", worst["sum"] < 1e-12, "1e-12")
    report.must("contact", "beyondMaximum: moved in the second half", f"{worst['late']:.0e}", worst["late"] < 1e-3, "1e-3")


def bed(report):
    """Thirty-six spheres rest in a box that vibrates with less than gravity."""
    radius, share, gamma = 1e-3, 0.1, -1e6
    steps = 1000000 if report.long else 20000 if report.short else 200000
    q_sat = charge(gamma, radius)
    frequency, amplitude = 100.0, 4e-6
    rows, worst = [], {"books": 0.0, "beyond": 0.0}
    creep = {}
    for reloading in ("counted", "beyondMaximum"):
        text = head(6e-3, share, 0.5, radius, floor=-1e-3)
        walls = {"floor": "zplane 0.0", "left": "xplane -0.0035", "right": "xplane 0.0035", "front": "yplane -0.0035", "back": "yplane 0.0035"}
        text += "".join(dem.wall_line(name, words) for name, words in walls.items())
        text += f"fix tribo all charge/gran/contact pair 1 1 gamma 0 kappa 100 pair 1 2 gamma {gamma!r} kappa 20 reloading {reloading}\n"
        text += field(50, "images yes")
        omega = 2*math.pi*frequency
        text += "fix weight all gravity v_pull vector 0. 0. -1.\n"
        text += f"variable pull equal 9.81-{amplitude!r}*{omega!r}^2*sin({omega!r}*step*dt)\n"
        places = [(-2.2e-3 + 2.2e-3*i + 1e-5*k, -2.2e-3 + 2.2e-3*j - 2e-5*k, 1.05e-3 + 2.1e-3*k) for k in range(4) for j in range(3) for i in range(3)]
        text += dem.spheres([(*place, 0.0, 0.0, 0.0, 0.0) for place in places], radius, SPHERE["density"])
        words = " ".join(f"f_tribo[{n}]" for n in range(1, 7))
        frames, books = dem.run(f"runs/bed-{reloading}", text, ["x", "y", "z", "vx", "vy", "vz", "q"], steps//20, steps, words)
        state = states(frames)
        total = state[:, :, 6].sum(1)
        scale = np.array([abs(s[:, 6]).sum() + abs(np.array(b)).sum() for s, b in zip(state, books)]).max()
        worst["books"] = max(worst["books"], max(abs(t + sum(b)) for t, b in zip(total, books))/scale)
        worst["beyond"] = max(worst["beyond"], (state[:, :, 6]/q_sat).max())
        at = {share: total[round(share*20)]/(len(places)*q_sat) for share in (0.1, 0.5, 1.0)}
        creep[reloading] = at[1.0] - at[0.5]
        rows.append((reloading, f"{steps:.0e}", *(f"{100*value:.4f} %" for value in at.values()), f"{state[-1, :, 5].std():.1e}"))
    report.title("A resting bed under vibration")
    report.table(["reloading", "steps", "bulk charge after a tenth", "half", "all", "vertical speeds at the end [m/s]"], rows)
    report.must("bed", "charge of particles and walls together", f"{worst['books']:.0e}", worst["books"] < 1e-12, "1e-12")
    report.must("bed", "largest charge of one sphere, over q_sat", f"{worst['beyond']:.3f}", worst["beyond"] < 1, "1")
    report.must("bed", "creep in the second half, beyondMaximum over counted", f"{creep['beyondMaximum']/creep['counted']:.3f}",
                0 <= creep["beyondMaximum"] < 0.2*creep["counted"], "0.2")


def head_on(report):
    """Unlike charges that meet at 10 m/s."""
    radius, speed, kappa, surface_field = PAIR_RADIUS, 10.0, 20.0, 1e6
    q = charge(surface_field, radius)
    impact = dem.Impact(SPHERE, radius, speed, pair=True)
    law = math.exp(-2*kappa*impact.area/dem.surface(radius))
    shares = (0.05, 0.2) if report.short else SHARES
    phases = (0.0, 0.25, 0.5, 0.75)

    def run(share, every, charging, phase):
        step = time_step(share, radius)
        gap = 0.1*radius + phase*step*speed
        text = head(8*radius, share, radius=radius)
        text += f"fix tribo all charge/gran/contact pair 1 1 gamma 0 kappa {kappa} pair 1 2 none pair 2 2 none\n" if charging else NO_CHARGING
        text += field(every)
        start = radius + gap/2
        text += dem.spheres([(-start, 0.0, 0.0, speed/2, 0.0, 0.0, q), (start, 0.0, 0.0, -speed/2, 0.0, 0.0, -q)], radius, SPHERE["density"])
        steps = int((2*gap/speed + 1.2*impact.duration)/step)
        name = f"runs/headOn-{100*share:g}-{every}-{phase:g}{'-charging' if charging else ''}"
        return states(dem.run(name, text, ["x", "y", "z", "vx", "vy", "vz", "q"], steps, steps))

    def energy(state):
        return kinetic(state, radius) + springs(state, radius) + coulomb(state)

    rows, off, drift = [], {}, {}
    for share in shares:
        charges = [run(share, 1, True, phase)[-1, 0, 6]/q for phase in phases]
        off[share] = max((charge/law - 1 for charge in charges), key=abs)
        ends = [run(share, 1, False, phase) for phase in phases]
        drift[share] = max(((energy(s[-1]) - energy(s[0]))/energy(s[0]) for s in ends), key=abs)
        rows.append((f"{100*share:g} %", f"{charges[0]:.4f}", f"{law:.4f}", f"{100*off[share]:+.2f} %", f"{drift[share]:+.1e}"))
    report.title("Unlike charges meet at 10 m/s")
    report.table(["time step over Rayleigh step", "charge left", "law", "worst of 4 off by", "energy lost or won, charging off"], rows)
    intervals = (1, 10) if report.short else (1, 2, 5, 10, 50)
    kept = {every: kinetic(run(0.1, every, False, 0.0)[-1], radius) for every in (*intervals, 10**6)}
    scale = abs(coulomb(run(0.1, 1, False, 0.0)[0]))
    report.table(["field updated every ... steps (10 % of Rayleigh)"] + list(map(str, intervals[1:])) + ["never"],
                 [["kinetic energy at the end less that with a field of every step, over the Coulomb energy of the pair"]
                  + [f"{(value - kept[1])/scale:+.1e}" for every, value in kept.items() if every != 1]])
    small = [share for share in shares if share <= 0.2]
    report.must("headOn", "charge left, against the law, up to 20 % of Rayleigh", f"{100*max(abs(off[s]) for s in small):.2f} %",
                all(abs(off[s]) <= 0.01 for s in small), "1 %")
    report.must("headOn", "energy, up to 20 % of Rayleigh", f"{max(abs(drift[s]) for s in small):.1e}", all(abs(drift[s]) < 0.01 for s in small), "1 %")
    report.must("headOn", "charges stay between those of the start, at every time step", "yes", all(abs(1 + o) <= 1/law for o in off.values()), "")


def sizes(report):
    """280 spheres of 0.2 to 2 mm share charge at kappa 1e5 in a box without charging walls."""
    box, steps = 8e-3, 4000 if report.short else 40000
    rows_of_table, worst = [], {"range": 0.0, "sum": 0.0}
    rows, radii = mixed(box)
    surfaces = dem.EPSILON0*4*math.pi*np.array(radii)**2
    for share in ((0.1, 0.4) if report.short else (0.01, 0.1, 0.2, 0.4)):
        for electric in (False, True):
            text = dem.script_head(((-1e-4, box + 1e-4),)*3, time_step(share, min(radii)), SPHERE, SPHERE, 0.9, 5e-4)
            for axis in "xyz":
                text += dem.wall_line(f"{axis}low", f"{axis}plane 0.0") + dem.wall_line(f"{axis}high", f"{axis}plane {box!r}")
            text += "fix tribo all charge/gran/contact pair 1 1 gamma 0 kappa 1e5 pair 1 2 none\n"
            text += field(10) if electric else ""
            text += spheres_of_sizes(rows, radii)
            state = states(dem.run(f"runs/sizes-{100*share:g}{'-field' if electric else ''}", text, ["x", "y", "z", "vx", "vy", "vz", "q"],
                                   steps//20, steps))
            fields = state[:, :, 6]/surfaces
            absolute = abs(state[0, :, 6]).sum()
            sums = abs(state[:, :, 6].sum(1) - state[0, :, 6].sum()).max()/absolute
            worst["sum"] = max(worst["sum"], sums)
            beyond = max(fields.max()/fields[0].max(), fields.min()/fields[0].min()) - 1
            if not electric:
                worst["range"] = max(worst["range"], beyond)
                worst["moved"] = fields[-1].std()/fields[0].std()
            rows_of_table.append((f"{100*share:g} %", "yes" if electric else "no", f"{fields[0].std():.3g}", f"{fields[-1].std():.3g}", f"{beyond:+.1e}",
                                  f"{sums:.0e}"))
    report.title("Sizes 1:10 at kappa 1e5")
    report.table(["time step over the smallest Rayleigh step", "field", "spread of surface fields at the start [V/m]", "at the end",
                  "beyond the range of the start", "sum of charges changed by"], rows_of_table)
    report.must("sizes", "without a field no surface field leaves the range of the start", f"{worst['range']:+.0e}", worst["range"] < 1e-12, "1e-12")
    report.must("sizes", "sum of the charges", f"{worst['sum']:.0e}", worst["sum"] < 1e-12, "1e-12")
    report.must("sizes", "charge moves: spread at the end over that at the start", f"{worst['moved']:.2f}", worst["moved"] < 0.9, "0.9")


def neighbours(report):
    """Twenty spheres hit a charged one of twice their radius at the same moment, kappa 1e5."""
    radius, large, speed = 0.5e-3, 1.0e-3, 1.0
    q = charge(1e6, large)
    mean = q/(large**2 + 20*radius**2)*np.array([large**2] + [radius**2]*20)     # all surface fields equal
    rows, worst, ends = [], 0.0, 0.0
    for share in ((0.05, 0.4) if report.short else SHARES):
        step = time_step(share, radius)
        away = large + radius + 1e-6
        text = head(6e-3, share, radius=radius)
        text += "fix tribo all charge/gran/contact pair 1 1 gamma 0 kappa 1e5 pair 1 2 none pair 2 2 none\n"
        text += spheres_of_sizes([(0.0,)*6 + (q,)] + [(*(away*d for d in way), *(-speed*d for d in way), 0.0) for way in dodecahedron()],
                                 [large] + [radius]*20)
        duration = 2.9432*(15*mass(radius)*speed**2/(16*dem.effective_modulus(SPHERE, SPHERE)*math.sqrt(radius*large/(radius + large))))**0.4/speed
        steps = int(2*duration/step)
        state = states(dem.run(f"runs/neighbours-{100*share:g}", text, ["x", "y", "z", "vx", "vy", "vz", "q"], 1, steps))
        fields = state[:, :, 6]/np.array([large**2] + [radius**2]*20)
        overshoot = (fields[:, 1:].max(1) - fields[:, 0]).max()/fields[0, 0]
        end = abs(state[-1, :, 6]/mean - 1).max()
        total = abs(state[:, :, 6].sum(1)/q - 1).max()
        worst, ends = max(worst, overshoot, total), max(ends, end)
        rows.append((f"{100*share:g} %", f"{state[1:, 0, 6].min()/q:.6f}", f"{mean[0]/q:.6f}", f"{overshoot:+.0e}", f"{end:.0e}", f"{total:.0e}"))
    report.title("Twenty neighbours at kappa 1e5")
    report.table(["time step over Rayleigh step", "least charge of the centre", "common mean", "neighbours' surface field above the centre's",
                  "end off the common mean by", "sum of charges changed by"], rows)
    # Rounding lets some of the twenty touch a step before the others.
    report.must("neighbours", "no neighbour passes the centre, sum of the charges", f"{worst:.0e}", worst < 1e-10, "1e-10")
    report.must("neighbours", "all surface fields equal at the end", f"{ends:.0e}", ends < 1e-6, "1e-6")
