"""Whether a sorting list fits a hump: routes to its tracks, cars of the mix for its cuts, room for the longest."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from plant_models.errors import PlantError
from plant_models.rolling.random_cuts import CutPopulation
from synth.frame.printed_numbers import ranges
from synth.hump.control.cut_record import CutRecord
from synth.hump.control.sorting_list import SortingList
from synth.hump.trains.hump_routes import HumpRoutes
from synth.hump.trains.list_trains import list_trains

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
