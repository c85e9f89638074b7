"""Every number that a hump trial depends on, with unit, range and origin."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Final

from plant_models.library import SourcedValue
from plant_models.library.car_mix_entry import CarMixEntry
from plant_models.library.hump_entry import HumpEntry
from plant_models.library.weight_category import WeightCategories
from synth.frame.settings.numbers import numbers_of, sourced
from synth.hump.configuration.position_settings import HumpPositionSettings
from synth.hump.configuration.settings import HumpSpeedSettings, HumpTrialSettings
from synth.hump.trains.position_choice import PositionChoice

OF_POPULATION: Final = ("cuts", "cars_mean", "most_cars", "category_shares", "track_shares")
"""Of [trains], what a sorting list tells in its place."""

OF_DRAWN_TRACKS: Final = {"tracks.free_low", "tracks.free_high"}
"""What the hump file tells in their place where cars stand as it tells."""

OF_SHIFTS: Final = {"tracks.pulled_from_share"}
"""What counts only where trains come to the same tracks."""

BESIDE_ONE_SPEED: Final = {"constant_m_s", "early_s"}
"""Of [hump_speed], what counts where there is one speed for all cuts; it stands in place of the rest."""

CHANGES_NO_TRAIN: Final = ("trains.number", "acceptance.")
"""Keys, or their beginnings, that change no train, only how many are humped and how they are judged."""


def trial_numbers(
    settings: HumpTrialSettings, usual: HumpTrialSettings, hump: HumpEntry, mix: CarMixEntry,
    categories: WeightCategories, designed: bool,
) -> Iterator[SourcedValue]:  # fmt: skip
    """Those of hump, cars, weather and control; those of the aim where it is `designed` for the trial on any route.

    `settings` and, with the values that the tool gives it, `usual` have nothing left out.
    """
    yield from (replace(value, key=f"hump.{value.key}") for value in hump.provenance)
    left_out = {f"trains.{key}" for key in OF_POPULATION if settings.trains.list is not None}
    if settings.hump_speed.constant_m_s is not None:
        left_out |= {f"hump_speed.{key}" for key in HumpSpeedSettings.model_fields.keys() - BESIDE_ONE_SPEED}
    if settings.tracks.shift_trains == 1:
        left_out |= OF_SHIFTS
    if settings.tracks.standing == "file":
        left_out |= OF_DRAWN_TRACKS
    yield from (replace(value, key=f"cars.{value.key.removeprefix('cars.')}") for value in mix.provenance)
    yield from category_values(settings, categories)
    for section in sections_in_force(settings, designed):
        for value in numbers_of(getattr(settings, section), section, getattr(usual, section)):
            if ".".join(value.key.split(".")[:2]) not in left_out:
                yield value


def sections_in_force(settings: HumpTrialSettings, designed: bool) -> Iterator[str]:
    """The sections whose numbers trains depend on, or by which they are judged."""
    measured = "measured" in (settings.aim.knowledge, settings.exit_speeds.knowledge)
    yield from ("trains", "weather")
    yield from ("resistance",) if settings.resistance.law == "hump-norm" else ()
    yield from ("tracks", "hump_speed", "exit_speeds")
    yield from ("aim",) if designed else ()
    yield "couplings"
    yield from ("sensors",) if measured else ()
    yield "acceptance"


def category_values(settings: HumpTrialSettings, categories: WeightCategories) -> Iterator[SourcedValue]:
    """Those of the weight categories."""
    law = () if settings.resistance.law == "hump-norm" else ("mean_n_per_kn", "std_n_per_kn")
    for member in categories.members:
        for value in member.provenance:
            if value.key.rpartition(".")[2] not in ("entrance_stage", *law):
                yield replace(value, key=f"{member.latin}.{value.key}")


def position_values(positions: Sequence[PositionChoice], hump: HumpEntry) -> Iterator[SourcedValue]:
    """How exactly the positions work, and what they can."""
    of_position = HumpPositionSettings.model_fields
    for each in positions:
        key = f"position.{each.number}"
        if each.exit_std_m_s is not None:
            origins = (v for v in hump.provenance if v.key.endswith("exit_std_m_s") and v.value == each.exit_std_m_s)
            found = None if each.std_set_by_user else next(origins, None)
            number = sourced(f"{key}.exit_std_m_s", each.exit_std_m_s, of_position["exit_std_m_s"])
            yield number if found is None else replace(number, source=found.source, confidence=found.confidence)
        if each.supply_share != 1.0:
            yield sourced(f"{key}.supply_share", each.supply_share, of_position["supply_share"])
