"""Which exit speeds a configuration asks for."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plant_models.errors import require
from synth.hump.configuration.settings import EXIT_RANGE_M_S, ExitSpeedSettings
from synth.hump.trains.position_choice import PositionChoice

ExitRange = tuple[float, float, float]
"""Lowest and highest exit speed of a position for intervals, and fastest entry."""


def filled_speeds(given: ExitSpeedSettings, positions: Sequence[PositionChoice]) -> ExitSpeedSettings:
    """`given` with the ranges that a file may leave out, of `positions`; where there is a book, up to its highest
    table."""
    low, high = EXIT_RANGE_M_S
    filled = {
        "lowest_m_s": (low,) * len(positions),
        "highest_m_s": tuple(min(high, top) for top in tops_m_s(positions)),
    }
    left_out = {key: numbers for key, numbers in filled.items() if getattr(given, key) is None}
    return given.model_copy(update=left_out)


def tops_m_s(positions: Sequence[PositionChoice]) -> list[float]:
    """Highest speed of the tables of each position; infinite where it has none."""
    return [np.inf if each.top_target_m_s is None else each.top_target_m_s for each in positions]


def exit_ranges(speeds: ExitSpeedSettings, positions: Sequence[PositionChoice]) -> tuple[ExitRange, ...]:
    """Of `positions`, which are all but the last, as `filled_speeds` has them; `PlantError` unless each list has a
    number for each of them, and tables for them where there is a book."""
    lists, count = [], len(positions)
    for key in ("lowest_m_s", "highest_m_s", "most_entry_m_s"):
        given = getattr(speeds, key)
        numbers = (np.inf,) * count if given is None else given
        require(
            len(numbers) == count,
            f"exit_speeds.{key} is {list(numbers)}; positions of the hump ahead of the last one: {count}; give a "
            "number for each of them",
        )
        lists.append(numbers)
    for place, (high, top) in enumerate(zip(lists[1], tops_m_s(positions), strict=True)):
        require(
            high <= top,
            f"exit_speeds.highest_m_s[{place}] is {high:g}; the book of position {place + 1} has tables for all its "
            f"classes up to {top:g}: lower it, or tune a book for faster cuts",
        )
    for place, (low, high, _) in enumerate(zip(*lists, strict=True)):
        require(
            low < high,
            f"exit_speeds.lowest_m_s[{place}] is {low:g}; it must be less than highest_m_s there, {high:g}",
        )
    return tuple(zip(*lists, strict=True))
