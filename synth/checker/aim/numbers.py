"""What controller code holds of aim tables: their numbers by member."""

from __future__ import annotations

from collections.abc import Sequence

from synth.checker.aim.reading import Aim
from synth.checker.code_export import Due
from synth.checker.code_records import Numbers


def due_of_aims(aims: Sequence[Aim]) -> Due:
    """What an export of these tables must hold, in their order."""
    categories = {aim.category_name: aim.category for aim in aims}
    return Due([aim.id for aim in aims], [held(aim, aims) for aim in aims], categories)


def held(aim: Aim, aims: Sequence[Aim]) -> Numbers:
    """What a controller holds of a table, with room for all of its set; what it has not is 0, no answer -1."""
    cars, distances = max(len(each.cars) for each in aims), max(len(each.distances_m) for each in aims)
    columns = max(max(1, len(each.resistances)) for each in aims)
    speeds = []
    for c in range(cars):
        for d in range(distances):
            inside = c < len(aim.cars) and d < len(aim.distances_m)
            speeds += padded([-1.0 if x is None else x for x in aim.speeds[c][d]] if inside else [], columns)
    return {
        "category": [aim.category],
        "ismeasured": [int(aim.is_measured)],
        "listed": [len(aim.cars)],
        "distances": [len(aim.distances_m)],
        "resistances": [max(1, len(aim.resistances))],
        "poverspeed": [aim.p_overspeed],
        "couplingms": [aim.coupling_m_s],
        "lowestms": [aim.bounds_m_s[0]],
        "highestms": [aim.bounds_m_s[1]],
        "cars": padded(aim.cars, cars),
        "distancem": padded(aim.distances_m, distances),
        "resistancenperkn": padded(aim.resistances, columns),
        "speedms": speeds,
    }


def padded(values: Sequence[float], length: int) -> list[float]:
    """`values` with zeros behind them."""
    return [*values, *[0.0] * (length - len(values))]
