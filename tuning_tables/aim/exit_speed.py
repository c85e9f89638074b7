"""The rule of an aim table, stated once for controller, simulation and generated code: which exit speed to command.

1. Cars. The nodes of the greatest listed number not above the given one: a longer cut is more predictable, so what is
   right for fewer cars is on the safe side. Fewer than the first: no answer.
2. Free distance and resistance are rounded to float32. No finite number, or nearer than the first distance: no answer.
   Beyond the last distance that one counts, the safe side again: too slow, not too fast. The resistance is clamped
   into its axis; a table by category alone does not look at it.
3. On each axis the greatest node not above the number, and the next one, with the part of the way from one to the
   other, (x - x0) / (x1 - x0). At a node, and at the last one, both are that node, and the part is 0.
4. A speed missing at one of these (at most four) nodes: no answer.
5. Along the distance at the lower resistance, likewise at the higher one, then from the first result to the second:
   a + part * (b - a), but not above b.

All arithmetic is float32, one rounding an operation, no fused multiply-add. No answer is NaN here, None from
`aim_exit_speed`, -1 in controllers, and means: brake to the lowest speed, for no speed is known to be safe. Every
answer lies between the least and the largest speed of its nodes, so within the bounds of the table.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from tuning_tables.aim.aim_table import AimTable

Floats = npt.NDArray[np.float32]


def aim_exit_speed(
    table: AimTable, cars: int, free_distance_m: float, resistance_n_per_kn: float | None = None
) -> float | None:
    """The exit speed in m/s, a float32 number, for a cut of so many cars; None where the table has no answer.

    `resistance_n_per_kn`: as measured; a table by category alone does not look at it, one by measured resistance has no
    answer without. Raises `TypeError` where `cars` is no whole number.
    """
    resistance = np.nan if resistance_n_per_kn is None else resistance_n_per_kn
    speed = float(aim_exit_speeds(table, cars, free_distance_m, resistance))
    return None if np.isnan(speed) else speed


def aim_exit_speeds(
    table: AimTable, cars: npt.ArrayLike, free_distance_m: npt.ArrayLike, resistance_n_per_kn: npt.ArrayLike = np.nan
) -> Floats:
    """`aim_exit_speed` for whole arrays at once: float32 of the shape that they broadcast to, NaN for no answer."""
    numbers = np.asarray(cars)
    if numbers.dtype.kind not in "iu":
        raise TypeError(f"cars has dtype {numbers.dtype}, but a cut has a whole number of cars.")
    with np.errstate(over="ignore", invalid="ignore"):  # what overflows, or is a signalling NaN, gets no answer
        distance = np.asarray(np.asarray(free_distance_m, np.float64), np.float32)
        resistance = np.asarray(np.asarray(resistance_n_per_kn, np.float64), np.float32)
    if not table.is_measured:
        resistance = np.zeros_like(resistance)
    numbers, distance, resistance = np.broadcast_arrays(numbers, distance, resistance)
    answered = (numbers >= table.axes.cars[0]) & np.isfinite(resistance)
    answered &= np.isfinite(distance) & (distance >= table.distance_nodes[0])
    # What gets no answer is replaced by the first node, which is harmless to compute with.
    row = np.maximum(np.searchsorted(table.axes.cars, numbers, side="right") - 1, 0)
    near, far, way = _between(table.distance_nodes, np.where(answered, distance, table.distance_nodes[0]))
    lower, upper, share = _between(table.resistance_nodes, np.where(answered, resistance, table.resistance_nodes[0]))
    speeds = table.speed_nodes
    first = _along(speeds[row, near, lower], speeds[row, far, lower], way)
    second = _along(speeds[row, near, upper], speeds[row, far, upper], way)
    return np.where(answered, _along(first, second, share), np.float32(np.nan))


def _between(nodes: Floats, values: Floats) -> tuple[npt.NDArray[np.intp], npt.NDArray[np.intp], Floats]:
    """Rule 3: the node below, the node above, and the part of the way; `values` outside are clamped."""
    clamped = np.minimum(np.maximum(values, nodes[0]), nodes[-1])
    below = np.searchsorted(nodes, clamped, side="right") - 1
    above = np.where(clamped > nodes[below], below + 1, below)
    span = np.where(above > below, nodes[above] - nodes[below], np.float32(1.0))
    return below, above, (clamped - nodes[below]) / span


def _along(begin: Floats, end: Floats, part: Floats) -> Floats:
    """Rule 5; NaN where `begin` or `end` is."""
    rise = end - begin
    step = part * rise
    return np.minimum(begin + step, end)
