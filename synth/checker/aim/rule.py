"""The rule of aim tables in binary32 arithmetic, each operation stored and loaded."""

from __future__ import annotations

import math
from collections.abc import Sequence

from synth.checker.aim.reading import Aim
from synth.checker.float32 import rounded


def exit_speed(aim: Aim, cars: int, distance_m: float, resistance: float) -> float | None:
    """The exit speed in m/s that docs/reference/aim-table.md gives for a cut; None for no answer."""
    d, w = rounded(distance_m), rounded(resistance)
    if not aim.cars[0] <= cars <= aim.cars[-1] or not math.isfinite(d) or d < rounded(aim.distances_m[0]):
        return None
    if aim.is_measured and not math.isfinite(w):
        return None
    lower, upper, share = between(aim.resistances, w) if aim.is_measured else (0, 0, 0.0)
    # The listed numbers of cars between which the cut is; one where it is a listed number itself.
    around = {
        max(number for number in aim.cars if number <= cars),
        min(number for number in aim.cars if number >= cars),
    }
    found: list[float] = []
    for number in around:
        rows = aim.speeds[aim.cars.index(number)]
        first, second = (over_distance([row[column] for row in rows], aim.distances_m, d) for column in (lower, upper))
        speed = along(first, second, share)
        if speed is None:
            return None
        found.append(speed)
    return min(found)


def over_distance(speeds: Sequence[float | None], distances_m: Sequence[float], d: float) -> float | None:
    """The speed at distance `d` among those at the nodes; beyond the last its own, if it does not fall there."""
    if d > rounded(distances_m[-1]):
        before, last = speeds[-2:] if len(speeds) > 1 else (None, None)
        return rounded(last) if before is not None and last is not None and rounded(before) <= rounded(last) else None
    near, far, way = between(distances_m, d)
    return along(speeds[near], speeds[far], way)


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
    """begin + part * (end - begin), not beyond end; None where there is none."""
    if begin is None or end is None:
        return None
    a, b = rounded(begin), rounded(end)
    speed = rounded(a + rounded(part * rounded(b - a)))
    return min(speed, b) if a < b else max(speed, b)
