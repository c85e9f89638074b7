"""Every number that aim tables depend on, with unit, range and origin."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Final

from plant_models.errors import require
from plant_models.library import SourcedValue, TrackEntry, WeightCategory
from plant_models.library.car_mix_entry import CarMixEntry
from plant_models.library.sourced_value import JUDGEMENT, SET_BY_USER
from synth.aim.configuration.settings import AimedSettings, AimFileSettings, CutsSettings
from synth.frame.settings.numbers import numbers_of
from synth.frame.settings.section import TOOL_DEFAULT

DEFAULT_EXIT_STD_M_S: Final = 0.1
"""Where neither an error of the exit speed nor tables are given."""


def aim_numbers(
    settings: AimFileSettings, track: TrackEntry, mix: CarMixEntry, members: tuple[WeightCategory, ...]
) -> Iterator[SourcedValue]:
    """Every number that the tables depend on, with its origin."""
    yield from track.provenance
    yield from numbers_of(settings.weather, "weather")
    by_category = settings.resistance.law == "hump-norm"
    if by_category:
        yield from numbers_of(settings.resistance, "resistance")
    yield from (replace(value, key=f"cuts.{value.key}") for value in mix.provenance)
    law = () if by_category else ("rolling_resistance.mean_n_per_kn", "rolling_resistance.std_n_per_kn")
    left_out = ("allowed_stage", "entrance_stage", *law)
    for member in members:
        yield from (replace(v, key=f"{member.latin}.{v.key}") for v in member.provenance if v.key not in left_out)
    yield from numbers_of(settings.aim, "aim")
    yield from exit_values(settings)
    yield from choice_values(settings)
    yield from (v for v in numbers_of(settings.simulation, "simulation") if v.key != "simulation.threads")
    yield from numbers_of(settings.acceptance, "acceptance")


def exit_values(settings: AimFileSettings) -> Iterator[SourcedValue]:
    """The error of the position, where no tables tell it."""
    std = exit_std_of(settings)
    if std is not None:
        source, confidence = f"{JUDGEMENT}: [hump-computer-1970s] asks for 0.15, tables of this tool have less", "L"
        if std != DEFAULT_EXIT_STD_M_S:
            source, confidence = SET_BY_USER, ""
        yield SourcedValue("aim.exit_std_m_s", std, "m/s", (0.0, 0.5), source, confidence)


def choice_values(settings: AimFileSettings) -> Iterator[SourcedValue]:
    """Where tables are asked for: choices, which claim nothing about the world."""
    cars, distances = settings.cuts.cars, settings.aim.free_distances_m
    chosen = {
        "cuts.cars": (tuple(float(count) for count in cars), CutsSettings().cars == cars, "1"),
        "aim.free_distances_m": (distances, AimedSettings().free_distances_m == distances, "m"),
    }
    for key, (value, default, unit) in chosen.items():
        yield SourcedValue(key, value, unit, None, TOOL_DEFAULT if default else SET_BY_USER, "")


def exit_std_of(settings: AimFileSettings) -> float | None:
    """The error of the position, None where its tables tell it; `PlantError` where both are given."""
    given = settings.aim.exit_std_m_s
    require(
        given is None or settings.aim.tables is None,
        f"aim.exit_std_m_s is {given} and aim.tables is {settings.aim.tables!r}; both say how exactly the position "
        "works: leave out one of the two",
    )
    require(
        settings.aim.tables is not None or settings.aim.tables_config is None,
        f"aim.tables_config is {settings.aim.tables_config!r}, but aim.tables names no book; add it",
    )
    if settings.aim.tables is not None:
        return None
    require(given is None or 0.0 <= given <= 2.0, f"aim.exit_std_m_s is {given!r}; it must be from 0 to 2")
    return DEFAULT_EXIT_STD_M_S if given is None else given
