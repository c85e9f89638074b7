"""Pairs of tables for two targets of one class that differ in one thing: whether there is something between them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np

from tests.controller_code.sample_book import estimator_of, table_of, with_approach, with_slopes
from tuning_tables import ControllerTable, Decisions, ValidRange
from tuning_tables.table_book import TableBook

SLOWER_M_S, BETWEEN_M_S, FASTER_M_S = 2.0, 2.5, 3.0
LIGHT = 1
"""Number of the category Л."""

Change = Callable[[ControllerTable], ControllerTable]
TIMED = Decisions.AT_ANY_TIME


def at_rest(table: ControllerTable) -> ControllerTable:
    """The table without slopes that decides at rest."""
    stages = (replace(each, lower_slope_m_s_per_kpa=None, upper_slope_m_s_per_kpa=None) for each in table.stages)
    return replace(table, stages=tuple(stages), decisions=Decisions.AT_REST)


def last_bit(value: float) -> float:
    """The next float32 number above."""
    return float(np.nextafter(np.float32(value), np.float32(np.inf)))


def estimating(**changes: Any) -> Change:
    """The table with an estimator that differs from the usual one in this."""
    return lambda table: replace(table, estimator=replace(estimator_of(4, 37.45), **changes))


def in_last_bit(key: str, place: int | None = None) -> Change:
    """The usual estimator with the last bit of a number changed."""
    usual = getattr(estimator_of(4, 37.45), key)
    if place is None:
        return estimating(**{key: last_bit(usual)})
    return estimating(**{key: (*usual[:place], last_bit(usual[place]), *usual[place + 1 :])})


def pressed(kpa: float) -> Change:
    """The table with another pressure of its second stage."""

    def changed(table: ControllerTable) -> ControllerTable:
        first, second, *others = table.stages
        return replace(table, stages=(first, replace(second, pressure_kpa=kpa), *others))

    return changed


def valid(low: float, high: float) -> Change:
    """The table for another path."""
    return lambda table: replace(table, valid=ValidRange((low, high), table.valid.v_m_s))


def same(table: ControllerTable) -> ControllerTable:
    """The table itself."""
    return table


def unlined(table: ControllerTable) -> ControllerTable:
    """The table without the lower line of its second stage."""
    first, second, *others = table.stages
    return replace(table, stages=(first, replace(second, lower=None), *others))


def of_shape(stages: int, degree: int) -> Change:
    """A table of another shape for the same cut."""
    return lambda table: table_of(
        table.id, table.cut.category, table.cut.mass_t, table.cut.axle_offsets_m, table.target_speed_m_s, stages, degree
    )


def timed(table: ControllerTable) -> ControllerTable:
    """The table without a gauge that decides at any time."""
    return replace(table, decisions=TIMED)


def sloped(table: ControllerTable) -> ControllerTable:
    """The table with slopes."""
    return with_slopes(table, -0.001, -0.0012)


def approached(length_m: float, stage: int) -> Change:
    """The table with an approach."""
    return lambda table: with_approach(table, length_m, stage)


NEAR, USUAL = approached(4.0, 1), estimating()
LIKE: dict[str, tuple[Change, Change]] = {
    "equal": (same, same),
    "equal approaches": (NEAR, approached(4.0 + 1e-9, 1)),
    "equal estimators": (USUAL, estimating(touch_pressure_kpa=50.0 * (1.0 + 1e-9))),
    "the same 2 sigma^2 l": (USUAL, estimating(path_std=0.05, correlation_length_m=8.0)),
    "other slopes": (sloped, lambda table: with_slopes(table, -0.0015, -0.001)),
    "pressures less than a float32 apart": (sloped, lambda table: pressed(150.0 + 1e-7)(sloped(table))),
    "pressures that nobody looks at": (timed, lambda table: pressed(160.0)(timed(table))),
}
UNLIKE: dict[str, tuple[Change, Change]] = {
    "stages": (same, of_shape(4, 2)),
    "powers": (same, of_shape(5, 1)),
    "has_line": (same, unlined),
    "at_any_time": (same, timed),
    "at_any_time the other way": (timed, same),
    "path_min_m": (valid(-1.0, 37.45), valid(-1.0 - 2.0**-23, 37.45)),
    "path_min_m the other way": (valid(-1.0 - 2.0**-23, 37.45), valid(-1.0, 37.45)),
    "path_max_m": (valid(0.0, 37.45), valid(0.0, last_bit(37.45))),
    "entrance_stage": (NEAR, approached(4.0, 2)),
    "approach_m": (approached(4.0, 4), valid(-4.0, 37.45)),
    "breaks": (USUAL, lambda table: replace(table, estimator=estimator_of(5, 37.45))),
    "no estimator": (USUAL, same),
    "touch_kpa": (USUAL, in_last_bit("touch_pressure_kpa")),
    "speed_variance, leap_m_s": (USUAL, in_last_bit("speed_noise_m_s")),
    "factor_variance": (USUAL, in_last_bit("friction_cv")),
    "path_variance": (USUAL, in_last_bit("path_std")),
    "excess_variance": (USUAL, in_last_bit("resistance_std_m_s2")),
    "frozen": (USUAL, estimating(frozen_readings=7)),
    "doubted": (USUAL, estimating(doubted_readings=21)),
    "lost_variance, caution": (USUAL, in_last_bit("lost_speed_std_m_s")),
    "unlikely": (USUAL, in_last_bit("unlikely_deviation")),
    "place_m": (USUAL, in_last_bit("s_m", 1)),
    "drive": (USUAL, in_last_bit("drive_m2_s2", 3)),
    "brake": (USUAL, in_last_bit("brake_m2_s2_per_kpa", 3)),
    "has_gauge": (sloped, timed),
    "gauge and time": (sloped, same),
    "pressure_kpa": (sloped, lambda table: pressed(last_bit(150.0))(sloped(table))),
    "less pressure_kpa": (sloped, lambda table: pressed(140.0)(sloped(table))),
}
"""By the members of a table in which the two differ."""

CASES = {**LIKE, **UNLIKE}


def axles_of(case: str) -> int:
    """The number of axles that stands for `case`."""
    return 4 + list(CASES).index(case)


@cache
def pairs() -> TableBook:
    """A class of two targets for each case; the number of axles stands for the case."""
    tables = []
    for name, changes in CASES.items():
        offsets = tuple(1.5 * axle for axle in range(axles_of(name)))
        for target, changed in zip((SLOWER_M_S, FASTER_M_S), changes, strict=True):
            tables.append(changed(table_of(f"{name} {target}", "Л", 23.0, offsets, target, 5, 2)))
    return TableBook(tuple(tables))
