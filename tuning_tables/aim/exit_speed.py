"""The rule of an aim table, stated once for controller, simulation and generated code: which exit speed to command.

1. Free distance and resistance are rounded to float32. No finite number, or nearer than the first distance: no answer.
   The resistance is clamped into its axis; a table by category alone does not look at it.
2. On each axis the greatest node not above the number, and the next one, with the part of the way from one to the
   other, (x - x0) / (x1 - x0). At a node both are that node, and the part is 0.
3. A speed missing at one of these (at most four) nodes: no answer.
4. Along the distance at the lower resistance, likewise at the higher one, then from the first result to the second:
   a + part * (b - a), where rounding leads beyond b that is b.
5. Beyond the last distance, at each of the two resistances: the speed at the last node, if there is one at the node
   before and it is not greater; else no answer. Where speeds rise the last one is too slow there, and so safe.
6. Cars. A listed number: as above. Between two listed numbers: the lesser of the answers for both; none if one has
   none. Fewer than the first or more than the last: no answer.

All arithmetic is float32, one rounding an operation, no fused multiply-add. No answer is NaN here, None from
`aim_exit_speed`, -1 in controllers, and means: brake to the lowest speed, for no speed is known to be safe. Every
answer lies between the least and the largest speed of its nodes, so within the bounds of the table.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
import numpy.typing as npt

from tuning_tables.aim.axes import AimAxes

Floats = npt.NDArray[np.float32]
Indices = npt.NDArray[np.intp]
Place = tuple[Indices, Indices, Floats]
"""The node below, the node above, and the part of the way."""


class AimNodes(Protocol):
    """What the rule looks at; an `AimTable` has it, and so may speeds that were never written to a file."""

    @property
    def axes(self) -> AimAxes:
        """Cars, free distances, resistances."""

    @property
    def is_measured(self) -> bool:
        """Whether the measured resistance of a cut is asked for."""

    @property
    def distance_nodes(self) -> Floats:
        """Free distances, (D,)."""

    @property
    def resistance_nodes(self) -> Floats:
        """Resistances, (R,); one 0 by category alone."""

    @property
    def speed_nodes(self) -> Floats:
        """Exit speeds, (C, D, R), NaN for none."""


def aim_exit_speed(
    table: AimNodes, cars: int, free_distance_m: float, resistance_n_per_kn: float | None = None
) -> float | None:
    """The exit speed in m/s, a float32 number, for a cut of so many cars; None where the table has no answer.

    `resistance_n_per_kn`: as measured; a table by category alone does not look at it, one by measured resistance has no
    answer without. Raises `TypeError` where `cars` is no whole number.
    """
    resistance = np.nan if resistance_n_per_kn is None else resistance_n_per_kn
    speed = float(aim_exit_speeds(table, cars, free_distance_m, resistance))
    return None if np.isnan(speed) else speed


def aim_exit_speeds(
    table: AimNodes, cars: npt.ArrayLike, free_distance_m: npt.ArrayLike, resistance_n_per_kn: npt.ArrayLike = np.nan
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
    listed, nodes = table.axes.cars, table.distance_nodes
    answered = (numbers >= listed[0]) & (numbers <= listed[-1]) & np.isfinite(resistance)
    answered &= np.isfinite(distance) & (distance >= nodes[0])
    beyond = distance > nodes[-1]
    if len(nodes) == 1:
        answered &= ~beyond  # there is no node before the last
    # What gets no answer is replaced by the first node, which is harmless to compute with.
    way = _between(nodes, np.where(answered, distance, nodes[0]))
    share = _between(table.resistance_nodes, np.where(answered, resistance, table.resistance_nodes[0]))
    fewer = np.maximum(np.searchsorted(listed, numbers, side="right") - 1, 0)
    more = np.minimum(np.searchsorted(listed, numbers), len(listed) - 1)
    speeds = (_for_row(table, row, way, share, beyond & answered) for row in (fewer, more))
    return np.where(answered, np.minimum(*speeds), np.float32(np.nan))


def _between(nodes: Floats, values: Floats) -> Place:
    """Rule 2; `values` outside are clamped."""
    clamped = np.minimum(np.maximum(values, nodes[0]), nodes[-1])
    below = np.searchsorted(nodes, clamped, side="right") - 1
    above = np.where(clamped > nodes[below], below + 1, below)
    span = np.where(above > below, nodes[above] - nodes[below], np.float32(1.0))
    return below, above, (clamped - nodes[below]) / span


def _for_row(table: AimNodes, row: Indices, way: Place, share: Place, beyond: npt.NDArray[np.bool_]) -> Floats:
    """Rules 3 to 5 for one listed number of cars each."""
    near, far, part = way
    near = np.where(beyond, far - 1, near)
    first, second = (
        _along(table.speed_nodes[row, near, column], table.speed_nodes[row, far, column], part, beyond)
        for column in share[:2]
    )
    return _along(first, second, share[2], np.False_)


def _along(begin: Floats, end: Floats, part: Floats, beyond: npt.NDArray[np.bool_] | np.bool_) -> Floats:
    """Rule 4, and rule 5 where `beyond`; NaN where `begin` or `end` is."""
    rise = end - begin
    step = part * rise
    speed = begin + step
    within = np.where(rise > 0.0, np.minimum(speed, end), np.maximum(speed, end))
    return np.where(beyond, np.where(rise >= 0.0, end, np.float32(np.nan)), within)
