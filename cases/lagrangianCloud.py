# SPDX-License-Identifier: GPL-3.0-or-later
"""Reads particles that himFoam has written."""

import pathlib
import re

import numpy as np


def charges(time_folder):
    """Charges of the particles of a written time [C]; the cloud is binary."""
    data = (pathlib.Path(time_folder) / "electric/lagrangian/particles/charge").read_bytes()
    head = re.search(rb"\n(\d+)\s*\n?\(", data)
    return np.frombuffer(data, np.float64, int(head.group(1)), head.end())
