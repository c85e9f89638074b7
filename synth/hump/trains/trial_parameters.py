"""Every number that a hump trial depends on, with unit, range and origin."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Final

from plant_models.library import SourcedValue, WeightCategories
from plant_models.library.car_mix_entry import CarMixEntry
from plant_models.library.hump_entry import HumpEntry
from plant_models.library.sourced_value import JUDGEMENT, SET_BY_USER
from synth.frame.settings.numbers import numbers_of
from synth.hump.configuration.settings import (
    CATEGORY_SHARES,
    EXIT_RANGE_M_S,
    ExitSpeedSettings,
    HumpTrialSettings,
)
from synth.hump.trains.position_choice import PositionChoice

OF_POPULATION: Final = ("cuts", "cars_mean", "most_cars")
"""What a sorting list tells in its place."""

CHANGES_NO_TRAIN: Final = ("trains.number", "acceptance.")
"""Keys, or their beginnings, that change no train, only how many are humped and how they are judged."""


def trial_numbers(
    settings: HumpTrialSettings, hump: HumpEntry, mix: CarMixEntry, categories: WeightCategories, designed: bool
) -> Iterator[SourcedValue]:
    """Those of hump, cars, weather and control; those of the aim where it is `designed` for the trial on any route."""
    yield from (replace(value, key=f"hump.{value.key}") for value in hump.provenance)
    of_list = settings.trains.list is not None
    for value in numbers_of(settings.trains, "trains"):
        if not (of_list and value.key.removeprefix("trains.") in OF_POPULATION):
            yield value
    yield from (replace(value, key=f"cars.{value.key.removeprefix('cars.')}") for value in mix.provenance)
    yield from category_values(settings, categories)
    yield from numbers_of(settings.weather, "weather")
    if settings.resistance.law == "hump-norm":
        yield from numbers_of(settings.resistance, "resistance")
    if settings.tracks.standing == "drawn":
        yield from numbers_of(settings.tracks, "tracks")
    yield from hump_speed_values(settings)
    yield from slow_down_values(settings)
    yield from numbers_of(settings.exit_speeds, "exit_speeds")
    if designed:
        yield from numbers_of(settings.aim, "aim")
    if "measured" in (settings.aim.knowledge, settings.exit_speeds.knowledge):
        yield from numbers_of(settings.sensors, "sensors")
    for key, limit in settings.acceptance.model_dump(exclude_none=True).items():
        yield SourcedValue(f"acceptance.{key}", limit, "1", (0.0, 1.0), SET_BY_USER, "")


def category_values(settings: HumpTrialSettings, categories: WeightCategories) -> Iterator[SourcedValue]:
    """Those of the weight categories."""
    law = () if settings.resistance.law == "hump-norm" else ("mean_n_per_kn", "std_n_per_kn")
    for member in categories.members:
        for value in member.provenance:
            if value.key.rpartition(".")[2] not in ("entrance_stage", *law):
                yield replace(value, key=f"{member.latin}.{value.key}")


def hump_speed_values(settings: HumpTrialSettings) -> Iterator[SourcedValue]:
    """Those of the hump speed: one speed, or what the program is made from."""
    constant = settings.hump_speed.constant_m_s
    if constant is None:
        yield from numbers_of(settings.hump_speed, "hump_speed")
    else:
        yield SourcedValue("hump_speed.constant_m_s", constant, "m/s", (0.3, 4.0), SET_BY_USER, "")


def slow_down_values(settings: HumpTrialSettings) -> Iterator[SourcedValue]:
    """When the train is slowed down, if ever."""
    if settings.hump_speed.slow_down_s is not None:
        yield SourcedValue(
            "hump_speed.slow_down_s", settings.hump_speed.slow_down_s, "s", (-5.0, 20.0), SET_BY_USER, ""
        )


def share_values(settings: HumpTrialSettings, categories: Mapping[str, float]) -> Iterator[SourcedValue]:
    """Shares of weight categories and, where given, of tracks."""
    origin = (f"{JUDGEMENT}: most cars are empty or full", "L")
    if settings.trains.category_shares is not None and categories != CATEGORY_SHARES:
        origin = (SET_BY_USER, "")
    for name, share in categories.items():
        yield SourcedValue(f"trains.category_shares.{name}", share, "1", None, *origin)
    for track, share in (settings.trains.track_shares or {}).items():
        yield SourcedValue(f"trains.track_shares.{track}", share, "1", None, SET_BY_USER, "")


def range_values(given: ExitSpeedSettings, ranges: Sequence[tuple[float, float, float]]) -> Iterator[SourcedValue]:
    """Exit speeds of the positions for intervals: (lowest, highest, most entry)."""
    usual = f"{JUDGEMENT}: {EXIT_RANGE_M_S[0]:g} to {EXIT_RANGE_M_S[1]:g} m/s are usual of bunch positions"
    for place, key in enumerate(("lowest_m_s", "highest_m_s")):
        numbers = tuple(each[place] for each in ranges)
        default = set(numbers) == {EXIT_RANGE_M_S[place]}
        yield SourcedValue(
            f"exit_speeds.{key}", numbers, "m/s", None, usual if default else SET_BY_USER, "L" if default else ""
        )
    if given.most_entry_m_s is not None:
        yield SourcedValue("exit_speeds.most_entry_m_s", given.most_entry_m_s, "m/s", None, SET_BY_USER, "")


def position_values(positions: Sequence[PositionChoice], hump: HumpEntry) -> Iterator[SourcedValue]:
    """How exactly the positions work, and what they can."""
    for each in positions:
        key = f"position.{each.number}"
        if each.exit_std_m_s is not None:
            origins = (v for v in hump.provenance if v.key.endswith("exit_std_m_s") and v.value == each.exit_std_m_s)
            found = None if each.std_set_by_user else next(origins, None)
            origin = (SET_BY_USER, "") if found is None else (found.source, found.confidence)
            yield SourcedValue(f"{key}.exit_std_m_s", each.exit_std_m_s, "m/s", (0.0, 1.0), *origin)
        if each.supply_share != 1.0:
            yield SourcedValue(f"{key}.supply_share", each.supply_share, "1", (0.05, 1.0), SET_BY_USER, "")
