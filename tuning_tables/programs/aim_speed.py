"""What a controller holds of an aim table, which of several serves a cut, and which exit speed to command: the
rule of an aim table.

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

All arithmetic is float32, one rounding an operation. No answer is -1, and means: brake to the lowest speed, for no
speed is known to be safe. Every answer lies between the least and the largest speed of its nodes, so within the bounds
of the table.
"""

from __future__ import annotations

from typing import Annotated, Any, Final, NamedTuple

import numpy as np
import numpy.typing as npt

from tuning_tables.language.records import flag, reading, real, record_of, whole
from tuning_tables.programs.held import LARGEST_NUMBER, LEAST_NUMBER, MINUS_ONE, NOUGHT, Answer, f32

Floats = npt.NDArray[np.float32]
Whole = npt.NDArray[Any]


class AimGrid(NamedTuple):
    """The exit speeds of one aim table at the nodes of its axes. Closed.

    Python holds it with the axes of a table as they are; a controller with room for the largest table of its set.
    """

    category: Annotated[int, whole("number of the weight category")]
    is_measured: Annotated[
        int, whole("1: by measured resistance; 0: by category alone, the resistance is not looked at")
    ]
    listed: Annotated[int, whole("numbers of cars; 0: no table")]
    distances: Annotated[int, whole("free distances")]
    resistances: Annotated[int, whole("measured resistances; 1 by category alone")]
    p_overspeed: Annotated[np.float32, real("allowed probability of a coupling faster than coupling_m_s")]
    coupling_m_s: Annotated[np.float32, real("m/s")]
    lowest_m_s: Annotated[np.float32, real("no exit speed is less, m/s")]
    highest_m_s: Annotated[np.float32, real("none is greater, m/s")]
    cars: Annotated[Whole, whole("listed numbers of cars", "listed")]
    distance_m: Annotated[Floats, real("free distances, m", "distances")]
    resistance_n_per_kn: Annotated[Floats, real("resistances, N/kN; 0 by category alone", "resistances")]
    speed_m_s: Annotated[
        Floats,
        real("exit speeds by cars, distance and resistance, m/s; -1: no answer", "listed", "distances", "resistances"),
    ]


AIM_GRID: Final = record_of(AimGrid)


class Tables(NamedTuple):
    """What the choice looks at of every table of a set."""

    category: Annotated[Whole, whole("number of the weight category", "tables")]
    is_measured: Annotated[Whole, whole("1: by measured resistance", "tables")]


def select(
    tables: Tables,
    category: Annotated[int, whole("number of the weight category")],
    measured: Annotated[bool, flag("the table by measured resistance, else that by category alone")],
) -> Answer:
    """Once for a cut, the number of the table for its category, by measured resistance or not; -1: there is none."""
    wanted = 0
    if measured:
        wanted = 1
    table_no = -1
    number = 0
    while number < tables.category.shape[0]:
        if tables.category[number] == category and tables.is_measured[number] == wanted:
            table_no = number
        number = number + 1
    return table_no


def along(
    near: Annotated[Any, real("speed at the node below, m/s")],
    far: Annotated[Any, real("speed at the node above, m/s")],
    part: Annotated[Any, real("of the way from one to the other")],
) -> Answer:
    """The part of the way from one speed to the other, rounding not beyond it; no answer where one has none."""
    speed = MINUS_ONE
    if near >= NOUGHT and far >= NOUGHT:
        speed = near + part * (far - near)
        if near < far:
            speed = min(speed, far)
        if near >= far:
            speed = max(speed, far)
    return speed


def distance_place(
    table: AimGrid, distance: Annotated[Any, real("free distance, not nearer than the first, m")]
) -> Answer:
    """Where a distance is on its axis: the nodes below and above, the part of the way, and whether beyond the last."""
    below = 0
    node = 1
    while node < table.distances:
        if distance >= table.distance_m[node]:
            below = node
        node = node + 1
    above = below
    part = NOUGHT
    beyond = False
    if distance > table.distance_m[below]:
        if below < table.distances - 1:
            above = below + 1
            part = (distance - table.distance_m[below]) / (table.distance_m[above] - table.distance_m[below])
        else:
            # The node before the last has a say; -1: there is none.
            beyond = True
            below = below - 1
    return below, above, part, beyond


def resistance_place(table: AimGrid, resistance: Annotated[Any, real("as measured, N/kN")]) -> Answer:
    """Where a resistance is on its axis, into which it is clamped: the nodes below and above, the part of the way."""
    lower = 0
    node = 1
    while node < table.resistances:
        if resistance >= table.resistance_n_per_kn[node]:
            lower = node
        node = node + 1
    upper = lower
    share = NOUGHT
    if lower < table.resistances - 1 and resistance > table.resistance_n_per_kn[lower]:
        upper = lower + 1
        origin = table.resistance_n_per_kn[lower]
        share = (resistance - origin) / (table.resistance_n_per_kn[upper] - origin)
    return lower, upper, share


def over_distance(
    table: AimGrid,
    row: Annotated[int, whole("of the number of cars")],
    column: Annotated[int, whole("of the resistance")],
    below: Annotated[int, whole("node of the distance")],
    above: Annotated[int, whole("the next one")],
    part: Annotated[Any, real("of the way from one to the other")],
    beyond: Annotated[bool, flag("the last distance")],
) -> Answer:
    """Along the distance, for one number of cars and one resistance."""
    near = table.speed_m_s[row, below, column]
    far = table.speed_m_s[row, above, column]
    found = along(near, far, part)
    # Beyond the last node its speed, if the one before is not greater.
    if beyond:
        found = MINUS_ONE
        if NOUGHT <= near <= far:
            found = far
    return found


def car_rows(table: AimGrid, cars: Annotated[int, whole("of the cut")]) -> Answer:
    """The rows of the listed numbers of cars not above and not below that of a cut; -1 as the first: none."""
    first = -1
    row = 0
    while row < table.listed:
        if cars >= table.cars[row]:
            first = row
        row = row + 1
    last = first
    if first >= 0:
        if cars > table.cars[first]:
            last = first + 1
        if last >= table.listed:
            first = -1
    return first, last


def exit_speed(
    table: AimGrid,
    cars: Annotated[int, whole("of the cut")],
    free_distance_m: Annotated[
        Any, reading("what its head has still to roll to the standing cars when its last axle leaves the position, m")
    ],
    resistance_n_per_kn: Annotated[Any, reading("as measured, N/kN; a table by category alone does not look at it")],
) -> Answer:
    """The exit speed to command, m/s; -1 where the table has no answer: then brake to the lowest speed.

    Between two listed numbers of cars the lesser of both answers; the resistance is clamped. Beyond the last distance
    the speed of the last one, if the speed before is not greater.

    No answer: fewer or more cars than are listed, nearer than the first distance, what is not finite, or no speed at a
    node that is asked.
    """
    exit_speed_m_s = MINUS_ONE
    # The sizes are looked at, too, so that no index leaves a damaged table.
    answered = (
        1 <= table.listed <= table.speed_m_s.shape[0]
        and 1 <= table.distances <= table.speed_m_s.shape[1]
        and LEAST_NUMBER <= free_distance_m <= LARGEST_NUMBER
    )
    resistance = NOUGHT
    if table.is_measured == 1:
        answered = (
            answered
            and 1 <= table.resistances <= table.speed_m_s.shape[2]
            and LEAST_NUMBER <= resistance_n_per_kn <= LARGEST_NUMBER
        )
        if answered:
            resistance = f32(resistance_n_per_kn)
    if answered:
        distance = f32(free_distance_m)
        first, last = car_rows(table, cars)
        if first >= 0 and distance >= table.distance_m[0]:
            below, above, part, beyond = distance_place(table, distance)
            lower = 0
            upper = 0
            share = NOUGHT
            if table.is_measured == 1:
                lower, upper, share = resistance_place(table, resistance)
            least = MINUS_ONE
            row = first
            while row <= last and below >= 0:
                low = over_distance(table, row, lower, below, above, part, beyond)
                high = over_distance(table, row, upper, below, above, part, beyond)
                found = along(low, high, share)
                if row == first or found < least:
                    least = found
                row = row + 1
            # Only of a damaged table an answer is out of the bounds.
            if table.lowest_m_s <= least <= table.highest_m_s:
                exit_speed_m_s = least
    return exit_speed_m_s
