# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes of the stability suite, their exact energies, and the law of a contact that oscillates. SI units."""

import math
import pathlib
import random
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import demScene as dem  # noqa: E402

SPHERE = dict(dem.PTFE, friction=0.0)       # without friction nothing but the contact's spring and the field holds energy
RADIUS = 0.5e-3                             # [m]
COULOMB = 1/(4*math.pi*dem.EPSILON0)
STATE = ["x", "y", "z", "vx", "vy", "vz", "q"]
NO_CHARGING = "fix tribo all charge/gran/contact pair 1 1 none pair 1 2 none pair 2 2 none\n"


def mass(radius=RADIUS):
    return 4/3*math.pi*radius**3*SPHERE["density"]


def time_step(share, radius=RADIUS):
    """That share of the Rayleigh step [s]."""
    return share*dem.rayleigh_step(SPHERE, radius)


def charge(surface_field, radius=RADIUS):
    """Charge [C] that makes this field [V/m] at the surface of its sphere."""
    return dem.EPSILON0*dem.surface(radius)*surface_field


def head(half, share, restitution=1.0, radius=RADIUS, floor=None):
    """Script of a box of 2*half, from `floor` upwards if given."""
    low = -half if floor is None else floor
    box = ((-half, half), (-half, half), (low, low + 2*half))
    return dem.script_head(box, time_step(share, radius), SPHERE, SPHERE, restitution, 0.5*radius)


def field(every, words=""):
    return f"fix field all efield/him method pairwiseSum every {every} {words}\n"


def states(frames):
    """Frames as arrays: frames x spheres x STATE."""
    return np.array([[[row[key] for key in STATE] for _, row in sorted(frame.items())] for frame in frames])


# ---------------------------------------------------------------------- energy

def kinetic(state, radius=RADIUS):
    return 0.5*mass(radius)*(state[:, 3:6]**2).sum()


def springs(state, radius=RADIUS, floor=False, box=None):
    """Energy of Hertz contacts [J] between equal spheres, with a floor at z = 0, or with the six walls of a cube [0, box]."""
    modulus = dem.effective_modulus(SPHERE, SPHERE)
    first, second = np.triu_indices(len(state), 1)
    apart = np.sqrt(((state[first, :3] - state[second, :3])**2).sum(-1))
    energy = 8/15*modulus*math.sqrt(radius/2)*(np.clip(2*radius - apart, 0, None)**2.5).sum()
    gaps = [state[:, 2]] if floor else []
    if box:
        gaps += [side for axis in range(3) for side in (state[:, axis], box - state[:, axis])]
    return energy + sum(8/15*modulus*math.sqrt(radius)*(np.clip(radius - gap, 0, None)**2.5).sum() for gap in gaps)


def coulomb(state, floor=False):
    """Energy of all pairs [J], with a grounded floor at z = 0 also of all images."""
    x, q = state[:, :3], state[:, 6]
    first, second = np.triu_indices(len(state), 1)
    energy = (q[first]*q[second]/np.sqrt(((x[first] - x[second])**2).sum(-1))).sum()
    if floor:
        mirrored = x*np.array([1, 1, -1])
        apart = np.sqrt(((x[:, None] - mirrored[None])**2).sum(-1))
        energy -= 0.5*(q[:, None]*q[None]/apart).sum()
    return COULOMB*energy


def coulomb_in_cube(state, side, shells=3):
    """Energy in a grounded cube [J] by octets of images, which have neither charge nor dipole nor quadrupole and so fall off fast."""
    x, q = state[:, :3], state[:, 6]
    energy = 0.0
    for signs in np.ndindex(2, 2, 2):
        mirror = 1 - 2*np.array(signs)
        for cell in np.ndindex(*(2*shells + 1,)*3):
            shift = 2*side*(np.array(cell) - shells)
            if not any(signs) and not shift.any():
                continue
            apart = np.sqrt(((x[:, None] - (x*mirror + shift)[None])**2).sum(-1))
            energy += 0.5*mirror.prod()*(q[:, None]*q[None]/apart).sum()
    return coulomb(state) + COULOMB*energy


# ---------------------------------------------------------------------- scenes

def cloud(count, pitch, surface_field, seed=1, centre=(0.0, 0.0, 0.0)):
    """count^3 spheres at rest on a jittered lattice of that pitch in diameters, as many positive as negative."""
    dice = random.Random(seed)
    signs = [1, -1]*(count**3//2)
    dice.shuffle(signs)
    places = [(i, j, k) for i in range(count) for j in range(count) for k in range(count)]
    return [(*(c + 2*RADIUS*pitch*(a - (count - 1)/2) + dice.uniform(-0.3, 0.3)*(pitch - 1)*RADIUS for a, c in zip(place, centre)), 0.0, 0.0, 0.0,
             sign*charge(surface_field)) for place, sign in zip(places, signs)]


def mixed(box, seed=2):
    """(x, y, z, vx, vy, vz, q) and radii of spheres whose sizes span 1:10, without overlap, at 1 m/s in random directions."""
    dice = random.Random(seed)
    rows, radii = [], []
    for radius, number in ((1.0e-3, 12), (0.5e-3, 30), (0.2e-3, 80), (0.1e-3, 160)):
        while number:
            place = [dice.uniform(radius, box - radius) for _ in range(3)]
            if all(math.dist(place, other[:3]) > radius + r for other, r in zip(rows, radii)):
                direction = [dice.gauss(0, 1) for _ in range(3)]
                size = math.hypot(*direction)
                rows.append((*place, *(d/size for d in direction), charge(dice.uniform(-1e6, 1e6), radius)))
                radii.append(radius)
                number -= 1
    return rows, radii


def spheres_of_sizes(rows, radii):
    text = dem.spheres(rows, RADIUS, SPHERE["density"])
    sizes = "".join(f"set atom {tag} diameter {2*radius!r} density {SPHERE['density']}\n" for tag, radius in enumerate(radii, 1))
    return text.replace("fix motion", sizes + "fix motion")


def dodecahedron():
    """Twenty directions."""
    golden = (1 + math.sqrt(5))/2
    corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    for a in (-1/golden, 1/golden):
        for b in (-golden, golden):
            corners += [(0, a, b), (a, b, 0), (b, 0, a)]
    return [tuple(c/math.sqrt(3) for c in corner) for corner in corners]


def law_of_a_pair(state, kappa, radius, beyond_maximum):
    """Charge difference of two equal spheres, relative to the first frame, at every step: exp(-2 kappa dA/(4 pi r^2)) for every growth dA
    of the contact area, or for growth beyond the largest area so far. `state` has every step."""
    apart = np.sqrt(((state[:, 0, :3] - state[:, 1, :3])**2).sum(-1))
    area = math.pi*radius/2*np.clip(2*radius - apart, 0, None)
    area[0] = 0                         # the contact begins in the first step
    reached = np.maximum.accumulate(area) if beyond_maximum else area
    grown = np.cumsum(np.clip(np.diff(reached, prepend=0), 0, None))
    return np.exp(-2*kappa*grown/dem.surface(radius))
