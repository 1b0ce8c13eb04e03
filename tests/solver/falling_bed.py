# SPDX-License-Identifier: GPL-3.0-or-later
"""A few spheres that fall on an insulating wall, and what to read of the charge that they leave on it."""

import re

from insulating_walls_test import INTERFACE, slabs

# Four spheres of 1 mm about to hit the wall from above, one of them charged, and one that stays away from it.
FALLING = [
    ((0.0231, 0.0312, INTERFACE + 0.0006), (0.3, -0.1, -0.5), 0.),
    ((0.0742, 0.0263, INTERFACE + 0.0007), (-0.2, 0.2, -0.4), 0.),
    ((0.0317, 0.0728, INTERFACE + 0.0006), (0.1, 0.1, -0.6), 2e-11),
    ((0.0568, 0.0539, INTERFACE + 0.0008), (-0.1, 0.3, -0.5), 0.),
    ((0.0723, 0.0719, 0.0746), (0.2, -0.2, -0.1), 5e-11),
]


def bed(folder, method="him", target="middle", height=INTERFACE):
    case = slabs(folder, method, nx=5, lower=4, upper=6, particles=FALLING)
    case.replace("constant/couplingProperties", "floor bottom;", "floor %s;" % target)
    case.replace("DEM/in.cube", "zplane 0.0\n", "zplane %r\n" % height)
    return case


def faces_of(case, time="0.002"):
    """Centre [m] to charge per area [C/m2] of the quadrangles that keep charge, from the file for ParaView."""
    text = (case.path / "postProcessing/wallCharge" / (time + ".vtp")).read_text()
    numbers = {name: [float(word) for word in body.split()]
               for name, body in re.findall(r'Name="(\w+)"[^>]*>\n(.*?)</DataArray>', text, re.S)}
    found = {}
    for n, charge in enumerate(numbers["surfaceCharge"]):
        corners = [numbers["position"][3 * k:3 * k + 3] for k in range(4 * n, 4 * n + 4)]
        found[tuple(round(sum(c[axis] for c in corners) / 4, 9) for axis in range(3))] = charge
    return found
