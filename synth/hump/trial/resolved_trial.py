"""A hump trial configuration with every default filled in: hump, trains, positions, and the origin of each number."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

import numpy as np

from plant_models.errors import require
from plant_models.library import (
    CAR_MIXES,
    WEIGHT_CATEGORIES,
    Library,
    SourcedValue,
    WeightCategories,
    load_weight_categories,
)
from plant_models.library.car_entry import CarMixEntry, load_car_mix
from plant_models.library.data_file import keyed
from plant_models.library.hump_entry import HumpEntry
from plant_models.library.weight_category import WeightCategory
from plant_models.rolling.random_cuts import CutPopulation
from synth.frame.faults import InputError
from synth.frame.settings.numbers import range_warnings
from synth.hump.configuration.settings import OVERSPEEDS_PER_ASKED, HumpTrialSettings
from synth.hump.configuration.trial_file import TrialFile, read_trial_file
from synth.hump.control.cut_record import SortingList
from synth.hump.control.train_population import TrainPopulation
from synth.hump.planning.position_roles import Fixed, Roles
from synth.hump.railml.write import to_railml
from synth.hump.rolling.hump_routes import HumpRoutes, hump_routes
from synth.hump.trial.asked_roles import asked_roles, role_values, role_warnings, settings_of
from synth.hump.trial.asked_trains import cars_of_cuts, filled_trains, population_of, trains_of
from synth.hump.trial.needed_tables import NeededTables, needed_tables, unfitting_tables
from synth.hump.trial.position_choice import PositionChoice, position_choices
from synth.hump.trial.table_aim import AimChoice, aim_choices, aim_warnings, require_fitting
from synth.hump.trial.trial_parameters import (
    CHANGES_NO_TRAIN,
    book_warnings,
    car_warnings,
    list_warnings,
    position_values,
    require_falling,
    skates_warnings,
    trial_numbers,
    weather_warnings,
)
from synth.retarder.configuration.config_file import load_config
from synth.retarder.configuration.plant_fault import in_file, require_held
from tuning_tables.json_text import canonical_json

KEY_OF_PLANT_MESSAGE: Final = {
    "weather: ": "weather.",
    "resistance: ": "resistance.",
    "car mix: ": "cars.",
    "car mix: no car": "cars.mix: no car",
    "train: ": "trains.",
}
"""How the plant's messages begin, and the key path in a hump trial configuration that this means."""


@dataclass(frozen=True)
class ResolvedTrial:
    """Everything that humped trains depend on.

    `trains`: a population, or the humped cuts of a sorting list. `aims`: exported aim tables of positions that aim;
    where there are none, speeds are chosen for the trial. `needs`: what the tables of each position must be for.
    `library`: with the user's own types. `parameters`: every number with unit, range, source and whether it is assumed;
    `warnings`: sentences about values outside their sensible range; `place`: what messages call the file.
    """

    place: str
    title: str
    hump: HumpEntry
    routes: HumpRoutes
    people: CutPopulation
    trains: TrainPopulation | SortingList
    positions: tuple[PositionChoice, ...]
    roles: Roles
    needs: tuple[NeededTables, ...]
    aims: tuple[AimChoice, ...]
    settings: HumpTrialSettings
    library: Library
    parameters: tuple[SourcedValue, ...]
    warnings: tuple[str, ...]
    names: dict[str, Any]

    def __repr__(self) -> str:
        return f"ResolvedTrial({self.title}: {len(self.routes.tracks)} tracks, {len(self.positions)} positions)"

    @property
    def categories(self) -> WeightCategories:
        """The weight categories of the cuts."""
        return self.people.categories

    @property
    def kinds(self) -> dict[WeightCategory, set[int]]:
        """How many cars the cuts of each weight category can have."""
        return cars_of_cuts(self.trains, self.categories)

    @property
    def designed_rows(self) -> tuple[int, ...]:
        """The routes with a position whose aim is chosen for the trial."""
        return rows_without(self.aims, self.roles)

    @property
    def canonical_json(self) -> str:
        """What the figures depend on, in one form: the same for the same figures, whatever files are called."""
        return canonical_json(self._tree(())).decode("utf-8")

    @property
    def sha256(self) -> str:
        """SHA-256 of `canonical_json` in UTF-8, hexadecimal."""
        return hashlib.sha256(self.canonical_json.encode()).hexdigest()

    @property
    def trains_json(self) -> str:
        """The same of what each single train depends on: not how many there are, nor how they are judged."""
        return canonical_json(self._tree(CHANGES_NO_TRAIN)).decode("utf-8")

    @property
    def trains_sha256(self) -> str:
        """SHA-256 of `trains_json` in UTF-8, hexadecimal."""
        return hashlib.sha256(self.trains_json.encode()).hexdigest()

    def _tree(self, without: tuple[str, ...]) -> dict[str, Any]:
        numbers = {v.key: v.value for v in self.parameters if not v.key.startswith(("hump.", *without))}
        return {"format": "hump-trial", "version": 1, **self.names, "numbers": numbers}


def load_trial(source: Path | None) -> ResolvedTrial:
    """The configuration or hump `source`, or the built-in default; `InputError` on any fault."""
    return resolve_trial(read_trial_file(source))


def resolve_trial(file: TrialFile) -> ResolvedTrial:
    """Fill in the library's values; `InputError` names file, key and value of whatever does not fit."""
    place, library = file.place, file.library
    settings = file.settings
    require_held(f"{place}: cars.mix", CAR_MIXES, settings.cars.mix, library)
    require_held(f"{place}: weight_categories", WEIGHT_CATEGORIES, settings.weight_categories, library)
    with in_file(place, lambda sentence: keyed(sentence, KEY_OF_PLANT_MESSAGE)):
        routes = hump_routes(file.hump.graph, lead_of(file))
        mix = settings.cars.applied_to(load_car_mix(settings.cars.mix, library))
        categories = load_weight_categories(settings.weight_categories, library)
        positions = position_choices(routes.routes, settings.position, file.hump_source.parent, file.folder)
        settings, usual = (filled(each, mix, categories, routes) for each in (settings, HumpTrialSettings()))
        require_whole_shifts(settings)
        asked = settings_of(len(positions), settings.position)
        roles = asked_roles(asked, positions, routes, categories, settings.exit_speeds.choices)
        people = population_of(mix, categories, settings)
        trains = trains_of(settings.trains, file.folder, people, routes)
        require_falling(routes, settings)
        aims = aim_choices(routes, roles, settings.aim, file.hump_source.parent, file.folder)
        for each in aims:
            require_fitting(each, routes, cars_of_cuts(trains, categories), settings.aim.knowledge == "measured")
    needs = needed_tables(asked, roles, trains, people)
    lacking = tuple(unfitting_tables(place, positions, needs, trains, people))
    if lacking:
        raise InputError(*lacking)
    parameters = (
        *trial_numbers(settings, usual, file.hump, mix, categories, designed=len(rows_without(aims, roles)) > 0),
        *role_values(asked, roles, categories),
        *position_values(positions, file.hump),
    )
    return ResolvedTrial(
        place=place,
        title=settings.title or f"Trains over: {file.hump.title}",
        hump=file.hump,
        routes=routes,
        people=people,
        trains=trains,
        positions=positions,
        roles=roles,
        needs=needs,
        aims=aims,
        settings=settings,
        library=library,
        parameters=parameters,
        warnings=(
            *range_warnings(parameters),
            *aim_warnings(aims, routes, settings),
            *role_warnings(asked, roles, routes),
            *book_warnings(positions, roles, settings.aim),
            *car_warnings(file.hump.cars, cars_of_cuts(trains, categories)),
            *skates_warnings(settings, roles),
            *weather_warnings(settings),
            *list_warnings(trains.cuts if isinstance(trains, SortingList) else (), categories),
        ),
        names=names_of(file, routes.lead, mix, categories, trains, positions)
        | {"roles": role_names(roles)}
        | aim_names(aims),
    )


def filled(
    settings: HumpTrialSettings, mix: CarMixEntry, categories: WeightCategories, routes: HumpRoutes
) -> HumpTrialSettings:
    """`settings` with what follows from hump, mix and categories where the file leaves it out."""
    acceptance = settings.acceptance
    if acceptance.overspeed is None:
        most = min(OVERSPEEDS_PER_ASKED * settings.aim.p_overspeed, 1.0)
        acceptance = acceptance.model_copy(update={"overspeed": most})
    trains = filled_trains(settings.trains, mix, categories, routes)
    return settings.model_copy(update={"trains": trains, "acceptance": acceptance})


def require_whole_shifts(settings: HumpTrialSettings) -> None:
    """`PlantError` unless the trains are whole shifts."""
    number, of_shift = settings.trains.number, settings.tracks.shift_trains
    whole = number // of_shift * of_shift
    fewer = f"{whole} or " if whole > 0 else ""
    require(
        whole == number,
        f"trains.number is {number}, but a shift has {of_shift} trains (tracks.shift_trains), and only whole ones are "
        f"humped: take {fewer}{whole + of_shift} trains",
    )


def rows_without(aims: tuple[AimChoice, ...], roles: Roles) -> tuple[int, ...]:
    """The routes on which a position aims that has no aim tables."""
    told = {row for each in aims for row in each.rows}
    return tuple(row for row in roles.aimed_rows if row not in told)


def role_names(roles: Roles) -> list[Any]:
    """What trains depend on of roles besides speeds: on which routes each position aims, and what is fixed."""
    return [
        [isinstance(exits, Fixed), np.flatnonzero(aims).tolist()]
        for exits, aims in zip(roles.exits, roles.aims, strict=True)
    ]


def aim_names(aims: tuple[AimChoice, ...]) -> dict[str, Any]:
    """What trains depend on of aim tables: for which retarders, and their content."""
    return {"aim_tables": [[list(each.retarders), list(each.sha256)] for each in aims]} if aims else {}


def lead_of(file: TrialFile) -> int:
    """The crest that trains come over."""
    leads, asked = file.hump.graph.leads, file.settings.lead
    if asked is None:
        return leads[0]
    require(asked in leads, f"lead is {asked}; the signals at the crests of the hump are {', '.join(map(str, leads))}")
    return asked


def names_of(
    file: TrialFile, lead: int, mix: CarMixEntry, categories: WeightCategories, trains: object,
    positions: tuple[PositionChoice, ...],
) -> dict[str, Any]:  # fmt: skip
    """What trains depend on besides numbers; files by their content."""
    settings = file.settings
    return {
        "hump_sha256": hashlib.sha256(to_railml(file.hump)).hexdigest(),
        "lead": lead,
        "mix": [car.car.name for car in mix.mix.cars],
        "categories": [[member.number, member.name] for member in categories.members],
        "law": settings.resistance.law,
        "list": [cut_line(cut) for cut in trains.cuts] if isinstance(trains, SortingList) else None,
        "one_wind_a_train": settings.trains.one_wind_a_train,
        "standing": settings.tracks.standing,
        "closed_tracks": sorted(set(settings.trains.closed_tracks or ())),
        "method": settings.hump_speed.method,
        "worst_pair": settings.hump_speed.worst_pair,
        "feedback": settings.exit_speeds.feedback,
        "known": [settings.exit_speeds.knowledge, settings.aim.knowledge],
        "positions": [position_names(each) for each in positions],
    }


def cut_line(cut: Any) -> list[Any]:
    """What a train depends on of a cut of the list."""
    return [cut.cars, cut.axles, cut.mass_t, cut.category, cut.track, cut.length_m]


def position_names(choice: PositionChoice) -> dict[str, Any]:
    """What a position depends on besides numbers."""
    found: dict[str, Any] = {"site": choice.site, "out_of_service": choice.out_of_service}
    if choice.book is not None:
        found["book_sha256"] = hashlib.sha256(choice.book.read_bytes()).hexdigest()
        found["tuned_with_sha256"] = load_config(choice.tuned_with).sha256
    return found
