"""Which speeds a configuration asks for, and whether its values go together."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from plant_models.errors import require, require_between
from synth.hump.configuration.settings import EXIT_RANGE_M_S, HumpTrialSettings
from synth.hump.trains.position_choice import PositionChoice

ExitRange = tuple[float, float, float]
"""Lowest and highest exit speed of a position for intervals, and fastest entry."""


def exit_ranges(settings: HumpTrialSettings, positions: Sequence[PositionChoice]) -> tuple[ExitRange, ...]:
    """Of `positions`, which are all but the last; `PlantError` unless each list has a number for each of them, and
    tables for them where there is a book. By default ranges end at the highest table."""
    given, lists, count = settings.exit_speeds, [], len(positions)
    for key, default in (
        ("lowest_m_s", EXIT_RANGE_M_S[0]),
        ("highest_m_s", EXIT_RANGE_M_S[1]),
        ("most_entry_m_s", 0.0),
    ):
        numbers = getattr(given, key)
        numbers = (default or np.inf,) * count if numbers is None else numbers
        require(
            len(numbers) == count,
            f"exit_speeds.{key} is {list(numbers)}; positions of the hump ahead of the last one: {count}; give a "
            "number for each of them",
        )
        for place, number in enumerate(numbers if default or getattr(given, key) is not None else ()):
            require_between(f"exit_speeds.{key}[{place}]", number, 0.3, 12.0)
        lists.append(numbers)
    tops = [np.inf if each.top_target_m_s is None else each.top_target_m_s for each in positions]
    if given.highest_m_s is None:
        lists[1] = tuple(min(pair) for pair in zip(lists[1], tops, strict=True))
    for place, (high, top) in enumerate(zip(lists[1], tops, strict=True)):
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


def require_speeds(settings: HumpTrialSettings) -> None:
    """`PlantError` for values that do not go together."""
    speed, tracks, aim = settings.hump_speed, settings.tracks, settings.aim
    if speed.constant_m_s is not None:
        require_between("hump_speed.constant_m_s", speed.constant_m_s, 0.3, 4.0)
    if speed.slow_down_s is not None:
        require_between("hump_speed.slow_down_s", speed.slow_down_s, -5.0, 20.0)
        require(
            settings.exit_speeds.feedback,
            f"hump_speed.slow_down_s is {speed.slow_down_s:g}, but exit_speeds.feedback is false, and without feedback "
            "nobody sees that a cut comes too close: take one of the two out",
        )
    require(
        speed.lowest_m_s <= min(speed.highest_m_s, speed.uncoupling_m_s),
        f"hump_speed.lowest_m_s is {speed.lowest_m_s:g}; it must not be above highest_m_s, {speed.highest_m_s:g}, nor "
        f"uncoupling_m_s, {speed.uncoupling_m_s:g}",
    )
    require(
        tracks.free_low <= tracks.free_high,
        f"tracks.free_low is {tracks.free_low:g}; it must not be above free_high, {tracks.free_high:g}",
    )
    require(
        aim.lowest_m_s < aim.highest_m_s,
        f"aim.lowest_m_s is {aim.lowest_m_s:g}; it must be less than highest_m_s, {aim.highest_m_s:g}",
    )
    for key, limit in settings.acceptance.model_dump(exclude_none=True).items():
        require_between(f"acceptance.{key}", limit, 0.0, 1.0)
