# SPDX-License-Identifier: GPL-3.0-or-later
"""Hard spheres of diameter 1 for the scenes: the same numbers for the same seed. Positions are (N, 3) arrays."""

import numpy as np

NEIGHBOURHOOD = [(i, j, k) for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1)]
HALF = [shift for shift in NEIGHBOURHOOD if shift > (0, 0, 0)]  # every pair of cells once


def close_pairs(position, distance):
    """Rows i, j of all pairs nearer than `distance`, each once."""
    cell = np.floor(position / distance).astype(np.int64)
    cell -= cell.min(axis=0) - 1
    size = cell.max(axis=0) + 2
    key = (cell[:, 0] * size[1] + cell[:, 1]) * size[2] + cell[:, 2]
    order = np.argsort(key, kind="stable")
    ordered = key[order]
    first, second = [], []
    for shift in [(0, 0, 0)] + HALF:
        offset = (shift[0] * size[1] + shift[1]) * size[2] + shift[2]
        begin = np.searchsorted(ordered, key + offset, side="left")
        count = np.searchsorted(ordered, key + offset, side="right") - begin
        i = np.repeat(np.arange(len(key)), count)
        within = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count, count)
        j = order[np.repeat(begin, count) + within]
        if shift == (0, 0, 0):
            i, j = i[i < j], j[i < j]
        near = ((position[i] - position[j]) ** 2).sum(axis=1) < distance**2
        first.append(i[near])
        second.append(j[near])
    return np.concatenate(first), np.concatenate(second)


def without_overlap(position, keep_inside, smallest=0.999, reach=1.03, rounds=4000):
    """Pushes spheres apart until no two centres are nearer than `smallest`; keep_inside(position) puts them back. Pairs nearer
    than `reach` push each other, and a little noise frees those that are pushed against a wall."""
    noise = np.random.default_rng(7)
    position = keep_inside(position)
    for _ in range(rounds):
        i, j = close_pairs(position, reach)
        apart = position[i] - position[j]
        distance = np.sqrt((apart**2).sum(axis=1))
        if len(i) == 0 or distance.min() > smallest:
            return position
        push = apart / np.maximum(distance, 1e-9)[:, None] * (0.5 * (reach - distance))[:, None]
        overlapping = np.unique(np.concatenate([i[distance < smallest], j[distance < smallest]]))
        moved = np.zeros_like(position)
        moved[overlapping] += noise.normal(0, 0.01, (len(overlapping), 3))
        for axis in range(3):
            moved[:, axis] += (np.bincount(i, push[:, axis], len(position)) - np.bincount(j, push[:, axis], len(position)))
        position = keep_inside(position + moved)
    raise RuntimeError("%d pairs of spheres still overlap" % (distance < smallest).sum())


def in_box(lower, upper):
    """Centres of spheres that lie in a box."""
    low, high = np.asarray(lower) + 0.5, np.asarray(upper) - 0.5
    return lambda position: np.clip(position, low, high)


def random_box(rng, count, lower, upper):
    low, high = np.asarray(lower, float), np.asarray(upper, float)
    return without_overlap(low + 0.5 + (high - low - 1) * rng.random((count, 3)), in_box(low, high))


def dilute(rng, size, fraction=0.01):
    """Spheres at random in a cube; `fraction` of its volume."""
    return random_box(rng, int(round(fraction * size**3 / (np.pi / 6))), (0, 0, 0), (size, size, size))


def bed(rng, size, fraction=0.55):
    """A dense bed in the lower half of a cube."""
    return random_box(rng, int(round(fraction * size**3 / 2 / (np.pi / 6))), (0, 0, 0), (size, size, size / 2))


def layer(rng, size, coverage=0.40):
    """Spheres that touch the walls of a cube, all six."""
    per_wall = int(coverage * size**2 / (np.pi / 4))
    wall = np.repeat(np.arange(6), per_wall)
    axis, place = wall % 3, np.where(wall < 3, 0.5, size - 0.5)

    def on_walls(position):
        position = np.clip(position, 0.5, size - 0.5)
        position[np.arange(len(wall)), axis] = place
        return position

    return without_overlap(size * rng.random((len(wall), 3)), on_walls)


def in_cylinder(rng, count, radius, height, at_wall):
    """Spheres in an upright cylinder around the z axis, `at_wall` of them touching its side."""
    def inside(position):
        across = np.hypot(position[:, 0], position[:, 1])
        limit = radius - 0.5
        scale = np.where(across > limit, limit / np.maximum(across, 1e-9), 1)
        scale[:at_wall] = limit / np.maximum(across[:at_wall], 1e-9)
        position[:, :2] *= scale[:, None]
        position[:, 2] = np.clip(position[:, 2], 0.5, height - 0.5)
        return position

    start = (rng.random((count, 3)) - (0.5, 0.5, 0)) * (1.4 * radius, 1.4 * radius, height)
    return without_overlap(start, inside)


def in_sphere(rng, count, radius, at_wall):
    """Spheres in a sphere, `at_wall` of them touching its wall."""
    def inside(position):
        distance = np.sqrt((position**2).sum(axis=1))
        limit = radius - 0.5
        scale = np.where(distance > limit, limit / distance, 1)
        scale[:at_wall] = limit / distance[:at_wall]
        return position * scale[:, None]

    return without_overlap((rng.random((count, 3)) - 0.5) * 1.1 * radius, inside)


def charges(rng, count, kind):
    """`like`: all +1. `mixed`: +1 or -1 at random."""
    return np.ones(count) if kind == "like" else rng.choice([-1.0, 1.0], count)


def snapshot(path, diameter, unit_charge):
    """A table of a run in SI units: positions in diameters, charges in units."""
    table = np.loadtxt(path, delimiter=",", skiprows=1)
    return table[:, :3] / diameter, table[:, 3] / unit_charge


def write_csv(path, position, charge, diameter, unit_charge):
    """Table for himField in SI units."""
    table = np.column_stack([position * diameter, charge * unit_charge])
    np.savetxt(path, table, delimiter=",", header="x,y,z,q", comments="", fmt="%.12g")


def crystal_bed(rng, count, fraction=0.55):
    """About `count` spheres at that density in a cube, shaken off a face-centred lattice without overlap; for large numbers.
    Returns positions and the size of the cube."""
    edge = (4 * np.pi / 6 / fraction) ** (1 / 3)
    cells = max(1, int(round((count / 4) ** (1 / 3))))
    corner = np.stack(np.meshgrid(*[np.arange(cells)] * 3, indexing="ij"), axis=-1).reshape(-1, 1, 3)
    base = np.array([(0.25, 0.25, 0.25), (0.75, 0.75, 0.25), (0.75, 0.25, 0.75), (0.25, 0.75, 0.75)])
    position = ((corner + base) * edge).reshape(-1, 3)
    gap = edge / np.sqrt(2) - 1
    return position + (rng.random(position.shape) - 0.5) * gap / np.sqrt(3), cells * edge
