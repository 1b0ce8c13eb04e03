# SPDX-License-Identifier: GPL-3.0-or-later
"""A small ray caster for the shaker: shaded spheres in a glass cylinder that is cut by a plane of potential. Lengths in
metres, parallel projection, numpy only."""

import numpy as np
from matplotlib.tri import LinearTriInterpolator, Triangulation

from shaker import CONTAINER_HEIGHT, CONTAINER_RADIUS, RADIUS

AZIMUTH, ELEVATION = np.radians(-62.0), np.radians(17.0)    # of the camera
SLICE = np.radians(-62.0 + 90.0 - 27.0)                     # direction of the slice, through the axis
DISTANCE = 0.2                                              # of the image plane from the middle [m]
LIGHT = np.array([-0.45, -0.55, 0.70])/np.linalg.norm([-0.45, -0.55, 0.70])
PAPER = np.array([1.0, 1.0, 1.0])


class Camera:
    """Parallel projection onto the plane of `right` and `up`; rays run along `forward`."""

    def __init__(self, width, height, scale):
        c, s = np.cos(ELEVATION), np.sin(ELEVATION)
        self.forward = -np.array([c*np.cos(AZIMUTH), c*np.sin(AZIMUTH), s])
        self.right = np.cross(self.forward, [0, 0, 1.0])
        self.right /= np.linalg.norm(self.right)
        self.up = np.cross(self.right, self.forward)
        self.scale, self.width, self.height = scale, width, height      # scale: pixels per metre
        u = (np.arange(width) + 0.5 - width/2)/scale
        v = (height/2 - np.arange(height) - 0.5)/scale
        centre = np.array([0, 0, CONTAINER_HEIGHT/2]) - DISTANCE*self.forward
        self.origins = centre + u[None, :, None]*self.right + v[:, None, None]*self.up

    def pixel(self, point):
        """Column and row of a point, in pixels."""
        relative = np.asarray(point) - [0, 0, CONTAINER_HEIGHT/2]
        return self.width/2 + self.scale*(relative @ self.right), self.height/2 - self.scale*(relative @ self.up)

    def hidden(self, point, depth):
        """Whether a sphere, the floor or the slice stands in front of a point."""
        relative = np.asarray(point) - [0, 0, CONTAINER_HEIGHT/2]
        column, row = (np.clip(p.astype(int), 0, size - 1) for p, size in zip(self.pixel(point), (self.width, self.height)))
        return depth[row, column] < relative @ self.forward + DISTANCE - 2e-4


def slice_potential(centres, potential):
    """Potential [V] of (s, z) on the plane through the axis. The mesh is a stack of equal layers: interpolate linearly in
    each layer's triangulation, then in height; the walls are at 0 V."""
    layers = np.unique(np.round(centres[:, 2], 7))
    rim = CONTAINER_RADIUS*np.array([[np.cos(a), np.sin(a)] for a in np.radians(np.arange(0, 360, 3))])
    grid = np.linspace(-CONTAINER_RADIUS, CONTAINER_RADIUS, 241)
    heights = np.concatenate(([0.0], layers, [CONTAINER_HEIGHT]))
    table = np.zeros((len(heights), len(grid)))
    for row, z in enumerate(layers, start=1):
        here = np.abs(centres[:, 2] - z) < 1e-6
        flat = np.vstack((centres[here, :2], rim))
        values = np.concatenate((potential[here], np.zeros(len(rim))))
        found = LinearTriInterpolator(Triangulation(*flat.T), values)(grid*np.cos(SLICE), grid*np.sin(SLICE))
        table[row] = np.ma.filled(found, 0.0)

    def at(s, z):
        row = np.clip(np.searchsorted(heights, z) - 1, 0, len(heights) - 2)
        weight = (z - heights[row])/(heights[row + 1] - heights[row])
        column = np.clip((s - grid[0])/(grid[1] - grid[0]), 0, len(grid) - 1.001)
        left = column.astype(int)
        fraction = column - left
        along = lambda r: (1 - fraction)*table[r, left] + fraction*table[r, left + 1]
        return (1 - weight)*along(row) + weight*along(row + 1)

    return at, table


def blend(image, colour, alpha):
    return image*(1 - alpha[..., None]) + colour*alpha[..., None]


def occlusion(points, normals, centres):
    """Share of the sky that the spheres leave free at each point: the analytic ambient occlusion of a sphere."""
    free = np.ones(points.shape[:-1])
    for centre in centres:
        to = centre - points
        distance = np.linalg.norm(to, axis=-1)
        cosine = np.einsum("...i,...i", to, normals)/np.maximum(distance, 1e-9)
        ratio = np.minimum((RADIUS/np.maximum(distance, RADIUS))**2, 1.0)
        free *= 1 - np.where(distance > 1.02*RADIUS, np.clip(cosine, 0, 1)*ratio, 0)
    return free


def render(camera, positions, colours, plane, plane_colour, levels):
    """RGB image. `colours`: one per sphere; `plane`: function (s, z) -> potential; `plane_colour`: potential -> RGB;
    `levels`: potentials [V] of the contour lines."""
    origin, forward = camera.origins, camera.forward
    shape = origin.shape[:2]
    image = np.broadcast_to(PAPER, shape + (3,)).copy()
    depth = np.full(shape, np.inf)

    # cylinder: where the ray enters and leaves (no cap), for the floor and the glass
    a = forward[:2] @ forward[:2]
    b = origin[..., :2] @ forward[:2]
    c = np.einsum("...i,...i", origin[..., :2], origin[..., :2]) - CONTAINER_RADIUS**2
    inside = b*b - a*c
    root = np.sqrt(np.maximum(inside, 0))
    front, back = (-b - root)/a, (-b + root)/a

    # floor, with contact shadows
    t = -origin[..., 2]/forward[2]
    hit = origin + t[..., None]*forward
    floor = hit[..., 0]**2 + hit[..., 1]**2 <= CONTAINER_RADIUS**2
    normal = np.broadcast_to(np.array([0, 0, 1.0]), hit.shape)
    light = 0.45 + 0.55*occlusion(hit[floor], normal[floor], positions)
    image[floor] = np.array([0.86, 0.87, 0.89])*light[:, None]
    depth[floor] = t[floor]

    # inside of the back wall: a faint shade towards the edges
    z = origin[..., 2] + back*forward[2]
    wall = (inside > 0) & (z >= 0) & (z <= CONTAINER_HEIGHT) & ~floor
    grazing = 1 - np.sqrt(np.clip(inside, 0, None)/a)/CONTAINER_RADIUS
    image = np.where(wall[..., None], image*(1 - (0.06 + 0.22*np.clip(grazing, 0, 1)**2))[..., None], image)

    # spheres
    for centre, colour in zip(positions, colours):
        to = origin - centre
        half = to @ forward
        discriminant = half**2 - np.einsum("...i,...i", to, to) + RADIUS**2
        t = -half - np.sqrt(np.maximum(discriminant, 0))
        seen = (discriminant > 0) & (t < depth)
        point = origin[seen] + t[seen][:, None]*forward
        normal = (point - centre)/RADIUS
        others = [p for p in positions if p is not centre]
        sky = occlusion(point, normal, others)
        ground = 1 - 0.45*np.clip(-normal[:, 2], 0, 1)*np.exp(-point[:, 2]/RADIUS)
        diffuse = np.clip(normal @ LIGHT, 0, 1)
        halfway = (LIGHT - forward)/np.linalg.norm(LIGHT - forward)
        gloss = np.clip(normal @ halfway, 0, 1)**60
        rim = np.clip(1 + normal @ forward, 0, 1)**3
        shade = (0.46 + 0.60*diffuse)*(0.35 + 0.65*sky)*ground - 0.15*rim
        image[seen] = np.clip(colour*shade[:, None] + 0.38*gloss[:, None], 0, 1)
        depth[seen] = t[seen]

    # plane of potential through the axis, translucent, with contour lines
    along = np.array([np.cos(SLICE), np.sin(SLICE), 0])
    across = np.array([-np.sin(SLICE), np.cos(SLICE), 0])
    t = -(origin @ across)/(forward @ across)
    hit = origin + t[..., None]*forward
    s, z = hit @ along, hit[..., 2]
    on = (np.abs(s) <= CONTAINER_RADIUS) & (z >= 0) & (z <= CONTAINER_HEIGHT)
    value = np.where(on, plane(s, np.clip(z, 0, CONTAINER_HEIGHT)), 0.0)
    visible = on & (t < depth)
    image = blend(image, plane_colour(value), np.where(visible, 0.72, 0.0))
    band = np.digitize(value, np.sort(levels))
    line = np.zeros(shape, bool)
    for axis in (0, 1):
        for shift in (1, 2):
            line |= band != np.roll(band, shift, axis)
    image = blend(image, np.array([0.10, 0.13, 0.25]), np.where(line & visible, 0.45, 0.0))
    depth = np.where(visible, t, depth)
    edge = on & (np.minimum(np.minimum(CONTAINER_RADIUS - np.abs(s), z), CONTAINER_HEIGHT - z) < 1.3/camera.scale)
    image = blend(image, np.array([0.15, 0.17, 0.25]), np.where(edge & visible, 0.8, 0.0))

    # glass of the front: brighter sheen, darker at grazing angles
    z = origin[..., 2] + front*forward[2]
    glass = (inside > 0) & (z >= 0) & (z <= CONTAINER_HEIGHT)
    image = blend(image, np.array([0.45, 0.50, 0.56]), np.where(glass, 0.03 + 0.35*np.clip(grazing, 0, 1)**4, 0.0))
    return image, depth


def picture(positions, charges, centres, potential, charge_colour, potential_colour, levels, width=720, height=780, samples=3):
    """Antialiased RGB picture, depth [m] and camera, in final pixels."""
    scale = 9.4e3
    fine = Camera(width*samples, height*samples, scale*samples)
    plane, _ = slice_potential(centres, potential)
    image, depth = render(fine, positions, [charge_colour(q)[:3] for q in charges], plane,
                      lambda v: potential_colour(v)[..., :3], levels)
    image = image.reshape(height, samples, width, samples, 3).mean(axis=(1, 3))
    return image, depth[samples//2::samples, samples//2::samples], Camera(width, height, scale)
