# SPDX-License-Identifier: GPL-3.0-or-later
"""Meshes of the scenes, in sphere diameters: dictionaries of blockMesh, and tetrahedra for polyDualMesh."""

import itertools
import math

import numpy as np

INNER = 0.48  # half width of the cube in the middle of a sphere

BOX = """
scale %(scale).12g;
vertices ((0 0 0) (1 0 0) (1 1 0) (0 1 0) (0 0 %(height).12g) (1 0 %(height).12g) (1 1 %(height).12g) (0 1 %(height).12g));
blocks (hex (0 1 2 3 4 5 6 7) (%(cells)d %(cells)d %(up)d) simpleGrading (1 1 1));
boundary ( walls { type wall; faces ((0 3 2 1) (4 5 6 7) (0 4 7 3) (1 2 6 5) (0 1 5 4) (3 7 6 2)); } );
"""


def box(size, cells, diameter, height=1, up=None):
    """A box of `size`, `height` times as high; `cells` across and `up` upwards."""
    return BOX % {"scale": size * diameter, "cells": cells, "height": height, "up": up or cells}


def cylinder(radius, height, cell, diameter):
    """O-grid: a core with bulged sides and four blocks around it."""
    wall, inner, bulge = radius / math.sqrt(2), 0.48 * radius, 0.57 * radius
    corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)]
    floor = [(x * inner, y * inner) for x, y in corners] + [(x * wall, y * wall) for x, y in corners]
    points = ["(%.10g %.10g %.10g)" % (x, y, z) for z in (0, height) for x, y in floor]
    core, ring, layers = round(1.08 * radius / cell), round(0.46 * radius / cell), round(height / cell)
    blocks = "hex (0 1 2 3 8 9 10 11) (%d %d %d) simpleGrading (1 1 1)\n" % (core, core, layers)
    for a, b in ((0, 1), (1, 2), (2, 3), (3, 0)):
        blocks += "hex (%d %d %d %d %d %d %d %d) (%d %d %d) simpleGrading (1 1 1)\n" % (
            a + 4, b + 4, b, a, a + 12, b + 12, b + 8, a + 8, core, ring, layers)
    edges = ""
    for z, first in ((0, 0), (height, 8)):
        for n, (x, y) in enumerate(((0, -1), (1, 0), (0, 1), (-1, 0))):
            pair = (first + n, first + (n + 1) % 4)
            edges += "arc %d %d (%.10g %.10g %.10g)\n" % (pair[0] + 4, pair[1] + 4, x * radius, y * radius, z)
            edges += "arc %d %d (%.10g %.10g %.10g)\n" % (*pair, x * bulge, y * bulge, z)
    return """scale %.12g;\nvertices (%s);\nblocks (%s);\nedges (%s);\nboundary (
    side { type wall; faces ((4 5 13 12) (5 6 14 13) (6 7 15 14) (7 4 12 15)); }
    ends { type wall; faces ((0 3 2 1) (4 5 1 0) (5 6 2 1) (6 7 3 2) (7 4 0 3)
                             (8 9 10 11) (12 13 9 8) (13 14 10 9) (14 15 11 10) (15 12 8 11)); }\n);\n""" % (
        diameter, "\n".join(points), blocks, edges)


def sphere(radius, cell, diameter):
    """A cube in the middle and six blocks from its faces to those of a larger cube, which `rounded` makes a sphere."""
    corner = list(itertools.product((-1, 1), repeat=3))
    corner = [corner[n] for n in (0, 4, 6, 2, 1, 5, 7, 3)]  # as in a hex
    points = ["(%.10g %.10g %.10g)" % tuple(c * s for c in p) for s in (INNER * radius, radius) for p in corner]
    faces = [(0, 3, 2, 1), (4, 5, 6, 7), (0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2)]
    core, ring = round(1.15 * radius / cell), round(0.46 * radius / cell)
    blocks = "hex (0 1 2 3 4 5 6 7) (%d %d %d) simpleGrading (1 1 1)\n" % (core, core, core)
    for a, b, c, d in faces:  # outward of the inner cube
        blocks += "hex (%d %d %d %d %d %d %d %d) (%d %d %d) simpleGrading (1 1 1)\n" % (
            a, b, c, d, a + 8, b + 8, c + 8, d + 8, core, core, ring)
    outer = " ".join("(%d %d %d %d)" % tuple(n + 8 for n in face) for face in faces)
    return "scale %.12g;\nvertices (%s);\nblocks (%s);\nboundary ( walls { type wall; faces (%s); } );\n" % (
        diameter, "\n".join(points), blocks, outer)


def rounded(points, radius):
    """Points of sphere()'s mesh, whose outer cube is as wide as the sphere, moved so that it becomes the sphere. Equal
    steps along a cube face become equal angles; the inner cube bulges a little, too."""
    inner = INNER * radius
    largest = np.abs(points).max(axis=1)
    on_face = points / np.maximum(largest, 1e-30)[:, None]  # of the cube of half width 1
    direction = np.tan(0.25 * np.pi * on_face)
    direction /= np.maximum(np.sqrt((direction**2).sum(axis=1)), 1e-30)[:, None]
    cube = 0.85 * on_face * inner + 0.15 * direction * 1.4 * inner
    outside = np.clip((largest - inner) / (radius - inner), 0, 1)[:, None]
    return np.where(outside > 0, cube * (1 - outside) + direction * radius * outside, cube * (largest / inner)[:, None])


def tetrahedra(size, cells, diameter, rng):
    """A gmsh file (version 2) of a cube: body-centred cubic tetrahedra, whose dual cells are truncated octahedra of about
    `size`/`cells`, with the inner points moved at random."""
    step = size / cells
    line = np.arange(cells + 1)
    corners = np.stack(np.meshgrid(line, line, line, indexing="ij"), -1).reshape(-1, 3) * step
    middle = np.arange(cells)
    centres = (np.stack(np.meshgrid(middle, middle, middle, indexing="ij"), -1).reshape(-1, 3) + 0.5) * step
    points = np.concatenate([corners, centres])
    inner = ((points > 1e-9) & (points < size - 1e-9)).all(axis=1)
    points[inner] += rng.uniform(-0.08, 0.08, (inner.sum(), 3)) * step

    def corner(i, j, k):
        return (i * (cells + 1) + j) * (cells + 1) + k

    def centre(i, j, k):
        return len(corners) + (i * cells + j) * cells + k

    tets, triangles = [], []
    for cell in itertools.product(range(cells), repeat=3):
        here = centre(*cell)
        for axis in range(3):
            for side in (0, 1):
                ring = []
                for u, v in ((0, 0), (1, 0), (1, 1), (0, 1)):
                    at = list(cell)
                    at[axis] += side
                    at[(axis + 1) % 3] += u
                    at[(axis + 2) % 3] += v
                    ring.append(corner(*at))
                beyond = cell[axis] + (1 if side else -1)
                if not 0 <= beyond < cells:
                    for n in ((0, 1, 2), (0, 2, 3)):
                        triangles.append([ring[m] for m in n])
                        tets.append([here] + triangles[-1])
                elif side:
                    there = list(cell)
                    there[axis] = beyond
                    for n in range(4):
                        tets.append([here, centre(*there), ring[n], ring[(n + 1) % 4]])
    tets, triangles = np.array(tets), np.array(triangles)
    edge = points[tets[:, 1:]] - points[tets[:, :1]]
    flipped = np.linalg.det(edge) < 0
    tets[flipped] = tets[flipped][:, [0, 1, 3, 2]]
    text = ["$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n2 1 \"walls\"\n3 2 \"gas\"\n$EndPhysicalNames\n$Nodes\n%d" % len(points)]
    text += ["%d %.12g %.12g %.12g" % (n, *point) for n, point in enumerate(points * diameter, 1)]
    text.append("$EndNodes\n$Elements\n%d" % (len(tets) + len(triangles)))
    text += ["%d 2 2 1 1 %d %d %d" % (n, *row) for n, row in enumerate(triangles + 1, 1)]
    text += ["%d 4 2 2 2 %d %d %d %d" % (n, *row) for n, row in enumerate(tets + 1, len(triangles) + 1)]
    return "\n".join(text + ["$EndElements\n"])
