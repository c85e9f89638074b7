"""An aim configuration as a file: read with the user's own types, its values of track and cuts, every number with its
origin; and a commented one to start from, that of the built-in track and mix of cars.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

from plant_models import PlantError
from plant_models.errors import require
from plant_models.library import (
    Library,
    SourcedValue,
    TrackEntry,
    Value,
    WeightCategories,
    WeightCategory,
    load_track,
    load_weight_categories,
)
from plant_models.library.car_entry import CarMixEntry
from plant_models.rolling.roll_track import RollTrack
from synth.aim.configuration.settings import DEFAULT_TRACK, AimFileSettings
from synth.aim.configuration.shared_settings import usual_mix
from synth.frame.settings.numbers import Told, Usual, library_values, numbers_of, told_numbers
from synth.frame.settings.settings_file import changed, settings_in
from synth.frame.settings.template import template
from synth.frame.settings.toml_file import toml_tree
from synth.retarder.configuration.own_types import with_own_types


def track_with_settings(entry: TrackEntry, settings: AimFileSettings) -> TrackEntry:
    """`entry` with the values that the file sets; `PlantError` with their keys if they make no track."""
    elements, bends = settings.track.elements, settings.track.bends
    overrides: dict[str, Value] = {}
    if elements is not None:
        overrides["track.grade_permille"] = tuple((each.from_m, each.grade_permille) for each in elements)
        overrides["track.end_m"] = elements[-1].to_m
    if bends is not None and not bends:
        entry = entry.without_bends()
    elif bends is not None:
        overrides["bends.zones_m"] = tuple((bend.from_m, bend.to_m) for bend in bends)
        overrides["bends.switches"] = tuple(float(bend.switches) for bend in bends)
        overrides["bends.turn_deg"] = tuple(bend.turn_deg for bend in bends)
    overrides |= dict(library_values(settings.position, "position"))
    overrides |= dict(library_values(settings.stretch, "stretch"))
    return entry.with_values(overrides)


def elements_of(track: RollTrack) -> list[dict[str, Any]]:
    """The elements of a track as a file has them."""
    pieces = zip(track.breaks_m[:-1], track.breaks_m[1:], track.profile.grades_permille, strict=True)
    return [{"from_m": begins, "to_m": ends, "grade_permille": grade} for begins, ends, grade in pieces]


def bends_of(track: RollTrack) -> list[dict[str, Any]]:
    """The bends of a track as a file has them."""
    return [
        {"from_m": bend.from_m, "to_m": bend.to_m, "switches": bend.switches, "turn_deg": bend.turn_deg}
        for bend in track.bends
    ]


def members_of(categories: WeightCategories, settings: AimFileSettings) -> tuple[WeightCategory, ...]:
    """The categories that are asked for, all if none is; `PlantError` for unknown ones, and for one named twice."""
    if settings.cuts.categories is None:
        return categories.members
    members: list[WeightCategory] = []
    for place, name in enumerate(settings.cuts.categories):
        try:
            member = categories.named(name)
        except PlantError as fault:
            raise PlantError(f"cuts.categories[{place}]: {fault}") from None
        require(member not in members, f"cuts.categories[{place}] is {name!r}, which is there before; leave it out")
        members.append(member)
    return tuple(members)


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


@dataclass(frozen=True)
class AimFile:
    """What a file says: `settings`, the `library` with the user's own types; `place`: what messages call the file."""

    settings: AimFileSettings
    library: Library
    place: str

    def with_simulation(self, passes: int | None, seed: int | None) -> AimFile:
        """The same with other passes or another seed, as given on a command line; None keeps the file's.

        `PlantError` for one that is not allowed.
        """
        given = {key: value for key, value in (("passes", passes), ("seed", seed)) if value is not None}
        simulation = changed(self.settings.simulation, **given)
        return replace(self, settings=self.settings.model_copy(update={"simulation": simulation}))


def parse_aim_file(text: str, place: str) -> AimFile:
    """The file with this `text`; paths in it begin at the folder of `place`."""
    tree, library = with_own_types(toml_tree(text, place), place)
    return AimFile(settings_in(AimFileSettings, tree, place), library, place)


def default_aim_toml() -> str:
    """The defaults as TOML; it reads back to the same aim configuration."""
    notes = load_track(DEFAULT_TRACK).notes
    return template(AimFileSettings(), "Aim configuration", "aim", usual_aim(), notes)


def usual_aim() -> Usual:
    """What the built-in track, mix and weight categories have for keys that are left out."""
    entry = load_track(DEFAULT_TRACK)
    told = told_numbers(entry.provenance)
    return {
        **told,
        **usual_mix("cuts"),
        "track.elements": replace(told["track.grade_permille"], value=elements_of(entry.track)),
        "track.bends": replace(told["bends.turn_deg"], value=bends_of(entry.track)),
        "position.name": Told(entry.position),
        "cuts.categories": Told(tuple(member.name for member in load_weight_categories().members)),
    }
