"""The rule of aim tables in binary32 arithmetic, each operation stored and loaded."""

from __future__ import annotations

import math
from collections.abc import Sequence

from synth.checker.aim.reading import Aim
from synth.checker.float32 import rounded


def exit_speed(aim: Aim, cars: int, distance_m: float, resistance: float) -> float | None:
    """The exit speed in m/s that docs/aim-table.md gives for a cut; None for no answer."""
    d, w = rounded(distance_m), rounded(resistance)
    listed = [place for place, number in enumerate(aim.cars) if number <= cars]
    if not listed or not math.isfinite(d) or d < rounded(aim.distances_m[0]):
        return None
    if aim.is_measured and not math.isfinite(w):
        return None
    rows = aim.speeds[listed[-1]]
    near, far, way = between(aim.distances_m, d)
    lower, upper, share = between(aim.resistances, w) if aim.is_measured else (0, 0, 0.0)
    first = along(rows[near][lower], rows[far][lower], way)
    second = along(rows[near][upper], rows[far][upper], way)
    return along(first, second, share)


def between(axis: Sequence[float], x: float) -> tuple[int, int, float]:
    """Node below, node above, part of the way; clamped to the axis."""
    nodes = [rounded(node) for node in axis]
    if x <= nodes[0]:
        return 0, 0, 0.0
    below = max(place for place, node in enumerate(nodes) if node <= x)
    if x == nodes[below] or below == len(nodes) - 1:
        return below, below, 0.0
    part = rounded(rounded(x - nodes[below]) / rounded(nodes[below + 1] - nodes[below]))
    return below, below + 1, part


def along(begin: float | None, end: float | None, part: float) -> float | None:
    """begin + part * (end - begin), not above end; None where there is none."""
    if begin is None or end is None:
        return None
    a, b = rounded(begin), rounded(end)
    return min(rounded(a + rounded(part * rounded(b - a))), b)
