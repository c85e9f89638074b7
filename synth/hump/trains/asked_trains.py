"""Which trains a configuration asks for: a population of cuts, or a sorting list."""

from __future__ import annotations

from pathlib import Path

from plant_models.errors import PlantError, require
from plant_models.library import WeightCategories
from plant_models.library.car_mix_entry import CarMixEntry
from plant_models.library.weight_category import WeightCategory
from plant_models.rolling.random_cuts import CutPopulation
from plant_models.rolling.resistance_law import HumpNormLaw, ResistanceLaw, Tb10062Law
from plant_models.rolling.weather import Weather
from synth.frame.input_error import InputError
from synth.hump.configuration.settings import CATEGORY_SHARES, HumpTrialSettings, TrainSettings
from synth.hump.control.sorting_list import SortingList
from synth.hump.control.sorting_list_file import load_sorting_list
from synth.hump.control.train_population import TrainPopulation
from synth.hump.trains.fitting_list import fitting_list, too_long
from synth.hump.trains.hump_routes import HumpRoutes


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
