# SPDX-License-Identifier: GPL-3.0-or-later
"""Field of point charges in the grounded cylinder, without a mesh: the reference for the field that himFoam hands to the
spheres. Method of fundamental solutions: charges on a larger cylinder outside are chosen so that the potential on the
wall vanishes. SI units."""

import math

import numpy as np

from shaker import CONTAINER_HEIGHT, CONTAINER_RADIUS, EPSILON0

COULOMB = 1/(4*math.pi*EPSILON0)


def cylinder_points(margin, around, up, across):
    """Points on the surface of the cylinder, grown by a margin [m]."""
    radius, low, high = CONTAINER_RADIUS + margin, -margin, CONTAINER_HEIGHT + margin
    turn = np.arange(around)*2*np.pi/around
    rings = [(radius, z, turn) for z in np.linspace(low, high, up)]
    for share in np.arange(across)/across:
        count = max(1, int(around*share))
        rings += [(share*radius, z, np.arange(count)*2*np.pi/count) for z in (low, high)]
    return np.vstack([np.column_stack((r*np.cos(t), r*np.sin(t), np.full_like(t, z))) for r, z, t in rings])


class GroundedCylinder:
    def __init__(self):
        self.wall = cylinder_points(0.0, 40, 26, 9)
        self.outside = cylinder_points(8e-3, 24, 18, 6)
        potential = COULOMB/np.linalg.norm(self.wall[:, None] - self.outside, axis=2)
        self.inverse = np.linalg.pinv(potential, rcond=1e-10)

    def field(self, position, charge):
        """Field [V/m] at every charge, of all other charges and of what all of them induce in the wall."""
        wall = COULOMB*(charge/np.linalg.norm(self.wall[:, None] - position, axis=2)).sum(axis=1)
        induced = -self.inverse @ wall
        apart = position[:, None] - np.vstack((position, self.outside))
        distance = np.linalg.norm(apart, axis=2)
        np.fill_diagonal(distance, np.inf)
        return COULOMB*np.einsum("k,ikc,ik->ic", np.concatenate((charge, induced)), apart, distance**-3)
