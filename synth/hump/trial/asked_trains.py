"""Which trains a configuration asks for: a population of cuts, or a sorting list; and whether a list fits a hump:
routes to its tracks, cars of the mix for its cuts, room for the longest.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from plant_models.errors import PlantError, require
from plant_models.library import WeightCategories
from plant_models.library.car_entry import CarMixEntry
from plant_models.library.weight_category import WeightCategory
from plant_models.rolling.random_cuts import CutPopulation
from plant_models.rolling.resistance_law import HumpNormLaw, ResistanceLaw, Tb10062Law
from plant_models.rolling.roll_track import Weather
from synth.frame.faults import InputError
from synth.frame.printed_numbers import ranges
from synth.hump.configuration.settings import CATEGORY_SHARES, HumpTrialSettings, TrainSettings
from synth.hump.control.cut_record import CutRecord, SortingList
from synth.hump.control.sorting_list_file import load_sorting_list
from synth.hump.control.train_population import TrainPopulation
from synth.hump.rolling.hump_routes import HumpRoutes
from synth.hump.rolling.list_trains import list_trains

FIRST_ROW = 2
"""Of the file, behind the row of the names."""

FEWEST_CUTS = 2


def fitting_list(cuts: SortingList, file: str, people: CutPopulation, routes: HumpRoutes) -> SortingList:
    """The cuts of `cuts` that go over the hump, as those of the only lead of `routes`.

    `PlantError` with a sentence for the first row of `file` that does not fit.
    """
    kept = []
    for row, cut in enumerate(cuts.cuts, start=FIRST_ROW):
        if cut.goes_over_the_hump:
            for fault in faults_of(cut, routes):
                raise PlantError(f"{file}: row {row}: cut {cut.serial} {fault}")
            kept.append((row, replace(cut, lead=0)))
    if len(kept) < FEWEST_CUTS:
        raise PlantError(f"{file}: cuts of it that go over the hump: {len(kept)}; a train must have two or more")
    found = SortingList(tuple(cut for _, cut in kept))
    try:
        list_trains(found, people, routes.routes, 0, 0, 1)
    except PlantError:
        for row, cut in kept:  # which of them it is
            require_cars(cut, f"{file}: row {row}", people, routes)
        raise
    return found


def faults_of(cut: CutRecord, routes: HumpRoutes) -> Iterator[str]:
    """Why a cut cannot go to its track."""
    leads = routes.graph.leads
    of_track = {route.track: row for row, route in enumerate(routes.routes)}
    if leads[cut.lead : cut.lead + 1] != (routes.lead,):
        yield (
            f"comes over lead {cut.lead}, and the trial has lead {leads.index(routes.lead)}, with signal "
            f"{routes.lead}; change the row, or lead in the configuration"
        )
    elif cut.track not in of_track:
        yield f"goes to track {cut.track}; signal {routes.lead} leads to tracks {ranges(sorted(of_track))}"
    else:
        row = of_track[cut.track]
        room, entrance = float(routes.length_m[row] - routes.release_m[row]), float(routes.entrance_m[row].min())
        if cut.length_m > room:
            track = routes.graph.track_called(cut.track)
            yield f"is {cut.length_m:g} m long; behind the last position of track {track} there are {room:g} m"
        elif 0.5 * cut.length_m > entrance:
            yield f"{too_long(cut.length_m, entrance)}: split it, or mark it do-not-hump"


def too_long(length_m: float, entrance_m: float) -> str:
    """Why a cut that is let go with its middle over the crest is too long."""
    return (
        f"is {length_m:g} m long; let go with its middle over the crest, its head would be behind the entrance of the "
        f"first position at {entrance_m:g} m"
    )


def require_cars(cut: CutRecord, place: str, people: CutPopulation, routes: HumpRoutes) -> None:
    """`PlantError`, beginning with `place`, where no cars of the mix can be this cut."""
    try:
        list_trains(SortingList((cut,)), people, routes.routes, 0, 0, 1)
    except PlantError as fault:
        raise PlantError(f"{place}: {str(fault).removeprefix('sorting list: ')}") from None


def filled_trains(
    trains: TrainSettings, mix: CarMixEntry, categories: WeightCategories, routes: HumpRoutes
) -> TrainSettings:
    """`trains` with what a file may leave out: shares, by second name of the category, and no longer cuts than the
    first position leaves room for, unless the file tells how long. `PlantError` for a category that is not there."""
    longest = max(each.car.length_m for each in mix.mix.cars)
    room = max(int(2.0 * float(routes.entrance_m.min()) / longest), 1)
    most = trains.most_cars if "most_cars" in trains.model_fields_set else min(trains.most_cars, room)
    shares = category_shares(trains.category_shares, categories)
    return trains.model_copy(update={"most_cars": most, "category_shares": shares})


def cars_of_cuts(trains: TrainPopulation | SortingList, categories: WeightCategories) -> dict[WeightCategory, set[int]]:
    """How many cars the cuts of each weight category can have; categories of which there are none are left out."""
    if isinstance(trains, SortingList):
        own = (
            (member, {cut.cars for cut in trains.cuts if cut.category == member.number})
            for member in categories.members
        )
        return {member: cars for member, cars in own if cars}
    used = (member for member in categories.members if trains.category_shares.get(member.number, 0.0) > 0.0)
    return {member: set(range(1, trains.most_cars + 1)) for member in used}


def population_of(mix: CarMixEntry, categories: WeightCategories, settings: HumpTrialSettings) -> CutPopulation:
    """Law and weather of the cuts."""
    law: ResistanceLaw = Tb10062Law()
    if settings.resistance.law == "hump-norm":
        law = HumpNormLaw(settings.resistance.erlang_order)
    return CutPopulation(mix.mix, categories, law, Weather(**settings.weather.model_dump()))


def category_shares(given: dict[str, float] | None, categories: WeightCategories) -> dict[str, float]:
    """Shares by second name of the category."""
    if given is None:
        known = {member.latin for member in categories.members}
        return {k: v for k, v in CATEGORY_SHARES.items() if k in known} or dict.fromkeys(sorted(known), 1.0)
    shares: dict[str, float] = {}
    for name, share in given.items():
        try:
            latin = categories.named(name).latin
        except PlantError as fault:
            raise PlantError(f"trains.category_shares: {fault}") from None
        require(latin not in shares, f"trains.category_shares: {name} is there twice; leave one out")
        shares[latin] = share
    return shares


def trains_of(
    trains: TrainSettings, folder: Path, people: CutPopulation, routes: HumpRoutes
) -> TrainPopulation | SortingList:
    """The trains that `trains` asks for, with nothing left out; the path of a list begins at `folder`."""
    categories, shares = people.categories, trains.category_shares or {}
    if trains.list is not None:
        path = folder / trains.list
        try:
            listed = fitting_list(load_sorting_list(path, categories), str(path), people, routes)
            for cut in listed.cuts:
                require(
                    cut.track not in (trains.closed_tracks or ()),
                    f"{path}: cut {cut.serial} goes to track {routes.graph.track_called(cut.track)}, which "
                    "trains.closed_tracks closes",
                )
            return listed
        except PlantError as fault:
            raise InputError(str(fault)) from None
    longest = trains.most_cars * max(each.car.length_m for each in people.mix.cars)
    entrance = float(routes.entrance_m.min())
    require(
        0.5 * longest <= entrance,
        f"trains.most_cars is {trains.most_cars}: such a cut {too_long(longest, entrance)}: set it to "
        f"{int(2.0 * entrance / longest * trains.most_cars)} or less",
    )
    return TrainPopulation(
        mix=people.mix,
        categories=categories,
        category_shares={categories.named(name).number: share for name, share in shares.items()},
        track_shares=open_shares(trains, routes),
        cars_mean=trains.cars_mean,
        most_cars=trains.most_cars,
    )


def open_shares(trains: TrainSettings, routes: HumpRoutes) -> dict[int, float]:
    """Shares by number of the track, 0 for those that are closed; `PlantError` where none is left."""
    shares, known = track_shares(trains.track_shares, routes), [int(track) for track in routes.tracks]
    closed = trains.closed_tracks or ()
    for number in closed:
        require(
            number in known,
            f"trains.closed_tracks names {number}; signal {routes.lead} leads to tracks {min(known)} to {max(known)}",
        )
    left = {number: 0.0 if number in closed else share for number, share in shares.items()}
    require(
        sum(left.values()) > 0.0,
        "trains.track_shares leaves no track to which cuts go: tracks that it does not name have the share 0; to close "
        "some and keep all others, name them in trains.closed_tracks alone",
    )
    return left


def track_shares(given: dict[str, float] | None, routes: HumpRoutes) -> dict[int, float]:
    """Shares by number of the track; without any, all tracks of the lead alike."""
    known = [int(track) for track in routes.tracks]
    if given is None:
        return dict.fromkeys(known, 1.0)
    shares: dict[int, float] = {}
    for name, share in given.items():
        number = int(name) if name.isascii() and name.isdigit() and len(name) < 4 else -1
        require(
            number in known,
            f"trains.track_shares names {name!r}; signal {routes.lead} leads to tracks {min(known)} to {max(known)}: "
            "give the number of one of them",
        )
        shares[number] = share
    return shares
