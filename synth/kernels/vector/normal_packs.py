"""The normal law in packs: Φ and φ of eight numbers at once.

Both are expanded about the nearest node of a table. The error of Φ is that of its rounding, in the lower tail below
1e-11 of Φ itself; that of φ is below 1e-12 of φ.
"""

from __future__ import annotations

import math

import numpy as np

from synth.kernels.compiling import part_inline
from synth.kernels.sweep.commands import CERTAIN
from synth.kernels.vector.packs import choose, gather, greatest, least, magnitude, nearest, whole

PER_STD = 32
"""Nodes a standard deviation."""

FROM_MIDDLE = int(CERTAIN) * PER_STD

NODES = np.arange(-FROM_MIDDLE, FROM_MIDDLE + 1) / PER_STD
BELOW = np.array([0.5 * math.erfc(-z / math.sqrt(2.0)) for z in NODES])
DENSITY = np.exp(-0.5 * NODES**2) / math.sqrt(2.0 * math.pi)


@part_inline
def normal_cdf8(z):
    """Φ of a pack, exactly 0 or 1 beyond six standard deviations."""
    held = least(greatest(z, -CERTAIN), CERTAIN)
    node = nearest(held * PER_STD)
    at, x = whole(node) + FROM_MIDDLE, node * (1.0 / PER_STD)
    d, square = held - x, x * x
    third, fourth, fifth = square - 3.0, (square - 6.0) * square + 3.0, (square - 10.0) * square + 15.0
    terms = (fifth * x * d * (-1.0 / 720.0) + fourth * (1.0 / 120.0)) * d - third * x * (1.0 / 24.0)
    terms = ((terms * d + (square - 1.0) * (1.0 / 6.0)) * d - x * 0.5) * d + 1.0
    found = gather(BELOW, at) + gather(DENSITY, at) * terms * d
    return choose(z > CERTAIN, 1.0, choose(z < -CERTAIN, 0.0, found))


@part_inline
def normal_density8(z):
    """φ of a pack, zero beyond six standard deviations."""
    held = least(greatest(z, -CERTAIN), CERTAIN)
    node = nearest(held * PER_STD)
    x = node * (1.0 / PER_STD)
    d = held - x
    t = (x + d * 0.5) * d * -1.0  # exp(t) by its series: |t| is below 0.1
    series = ((t * (1.0 / 5040.0) + 1.0 / 720.0) * t + 1.0 / 120.0) * t + 1.0 / 24.0
    series = (((series * t + 1.0 / 6.0) * t + 0.5) * t + 1.0) * t + 1.0
    found = gather(DENSITY, whole(node) + FROM_MIDDLE) * series
    return choose(magnitude(z) > CERTAIN, 0.0, found)
