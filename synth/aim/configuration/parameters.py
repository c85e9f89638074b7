"""Every number that aim tables depend on, with unit, range and origin."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from plant_models.library import SourcedValue, TrackEntry, WeightCategory
from plant_models.library.car_mix_entry import CarMixEntry
from synth.aim.configuration.settings import AimFileSettings
from synth.frame.settings.numbers import numbers_of


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
    yield from numbers_of(settings.cuts, "cuts")
    told_by_tables = "aim.exit_std_m_s" if settings.aim.tables is not None else ""
    yield from (v for v in numbers_of(settings.aim, "aim") if v.key != told_by_tables)
    yield from (v for v in numbers_of(settings.simulation, "simulation") if v.key != "simulation.threads")
    yield from numbers_of(settings.acceptance, "acceptance")
