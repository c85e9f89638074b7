"""Every number that a hump trial depends on, with unit, range and origin; which exit speeds a position may aim with;
and what of a trial is refused or warned of beside the ranges: a track that rises, cars that the hump is not for.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np

from plant_models.cut import GRAVITY_M_S2
from plant_models.errors import require
from plant_models.library import SourcedValue
from plant_models.library.car_entry import CarMixEntry
from plant_models.library.hump_entry import HumpEntry
from plant_models.library.hump_forms import ForCars
from plant_models.library.weight_category import WeightCategories, WeightCategory
from synth.frame.settings.numbers import numbers_of, sourced
from synth.hump.configuration.sections import HumpPositionSettings
from synth.hump.configuration.settings import HumpSpeedSettings, HumpTrialSettings, TrialAimSettings
from synth.hump.control.cut_record import CutRecord
from synth.hump.planning.position_roles import Roles
from synth.hump.rolling.hump_routes import HumpRoutes
from synth.hump.trial.position_choice import PositionChoice

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


def aim_range_m_s(aim: TrialAimSettings, choice: PositionChoice) -> tuple[float, float]:
    """Lowest and highest exit speed. A closed loop takes commands beyond its targets for the nearest one, so none is
    chosen there; where [aim] and the book have no speed in common, it is the end of the book that is nearest."""
    if choice.held is None or choice.out_of_service:
        return aim.lowest_m_s, aim.highest_m_s
    low, high = (
        min(max(speed, choice.held.lowest_m_s), choice.held.highest_m_s) for speed in (aim.lowest_m_s, aim.highest_m_s)
    )
    return low, high


def book_warnings(choices: Sequence[PositionChoice], roles: Roles, aim: TrialAimSettings) -> Iterator[str]:
    """A sentence for each position whose book keeps it from aiming as slowly, or as fast, as [aim] asks for."""
    for place, choice in enumerate(choices):
        asked, found = (aim.lowest_m_s, aim.highest_m_s), aim_range_m_s(aim, choice)
        less = found[0] > asked[0] or ("highest_m_s" in aim.model_fields_set and found[1] < asked[1])
        if less and roles.aims[place].any():
            yield (
                f"position {choice.number} aims with {found[0]:g} to {found[1]:g} m/s, for which its book has tables; "
                f"[aim] allows {asked[0]:g} to {asked[1]:g} m/s"
            )


def car_warnings(asked: ForCars | None, kinds: Mapping[WeightCategory, Collection[int]]) -> Iterator[str]:
    """A sentence where trains have other cars than the hump is for; `kinds`: numbers of cars of the cuts of each weight
    category that trains can have."""
    if asked is None:
        return
    if asked.categories is not None:
        named = set(asked.categories)
        others = [each.label for each in kinds if not named & {each.name, each.latin}]
        if others:
            yield (
                f"the hump is for cars of the weight category {', '.join(asked.categories)}, and trains have "
                f"{', '.join(others)}, too: its brakes may be too weak for them; set trains.category_shares, "
                f"{{ {asked.categories[0]} = 1 }}"
            )
    longest = max(max(cars) for cars in kinds.values())
    if asked.most_cars is not None and longest > asked.most_cars:
        yield (
            f"the hump is for cuts of at most {asked.most_cars} car{'s' * (asked.most_cars > 1)}, and trains can have "
            f"cuts of {longest}: set trains.most_cars, and trains.cars_mean with it"
        )


def list_warnings(cuts: Sequence[CutRecord], categories: WeightCategories) -> Iterator[str]:
    """A sentence where cuts of a sorting list are of another weight category than their mass tells."""
    numbers = {each.number: each for each in categories.members}
    other = [(cut, categories.of(cut.mass_t, cut.axles)) for cut in cuts]
    other = [(cut, by_mass) for cut, by_mass in other if by_mass.number != cut.category]
    if other:
        cut, by_mass = other[0]
        more = f" (and {len(other) - 1} more)" if len(other) > 1 else ""
        yield (
            f"cut {cut.serial} of the sorting list{more} has {cut.mass_t:g} t on {cut.axles} axles, which is the "
            f"weight category {by_mass.label}, and the list says {numbers[cut.category].label}: it rolls and brakes as "
            "the list says; leave the column category out to have that of the mass"
        )


def skates_warnings(settings: HumpTrialSettings, roles: Roles) -> Iterator[str]:
    """A sentence where skates are asked for and no track has some."""
    share = settings.tracks.skates_share
    if share > 0.0 and roles.aims.any(axis=0).all():
        yield (
            f"tracks.skates_share is {share:g}, but a position aims at the standing cars of every track, and skates "
            "lie where none does: take it out, or give the last position another role"
        )


def weather_warnings(settings: HumpTrialSettings) -> Iterator[str]:
    """A sentence where a temperature is asked for that changes nothing that matters."""
    weather = settings.weather
    if "temperature_c" in weather.model_fields_set and settings.resistance.law == "hump-norm":
        yield (
            f"weather.temperature_c is {weather.temperature_c:g}; under resistance.law hump-norm it changes "
            "the density of the air alone, not the resistance of bearings: take tb-10062 for cold cars, and "
            "weather.snow_n_per_kn for snow"
        )


SPARE = 2.0
"""Cuts come up so many times what their speed is worth at most: wheels turn, long cuts are pushed on, wind helps."""


def require_falling(routes: HumpRoutes, settings: HumpTrialSettings) -> None:
    """`PlantError` where the track up to the last element of a route rises so far above the crest that a cut pushed at
    the highest hump speed of `settings` stands before it gets there."""
    speed = settings.hump_speed
    fastest_m_s = speed.constant_m_s or min(speed.highest_m_s, speed.uncoupling_m_s)
    comes_up_m = 0.5 * fastest_m_s**2 / GRAVITY_M_S2
    for route, ends_m in zip(routes.routes, routes.ends_m, strict=True):
        places = np.minimum(route.roll_track.breaks_m, ends_m)
        rises = -route.roll_track.fall_m(places)
        worst = int(np.argmax(rises))
        require(
            rises[worst] <= SPARE * comes_up_m,
            f"hump: on the way to track {routes.graph.track_called(route.track)}, {places[worst]:g} m behind the "
            f"crest, the track lies {rises[worst]:.2f} m above the crest; at {fastest_m_s:g} m/s cuts come up "
            f"{comes_up_m:.2f} m, so they stand before it; a grade is positive where the track falls: correct "
            "grade_permille",
        )
