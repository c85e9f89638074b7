"""The figures of many humped trains as tables: shares of cuts, and means over trains; how tracks fill in a shift, and
what that changes; where cuts were caught up, and how they ended, counts by element and pictures.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from functools import partial
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from plant_models.frozen_arrays import Ints
from synth.frame.exhibits import Chart, Column, Exhibit, File, Row, Sentence, Table
from synth.frame.printed_numbers import three_figures
from synth.hump.configuration.sections import CouplingLimits
from synth.hump.rolling.hump_routes import HumpRoutes
from synth.hump.rolling.outcomes import TrainOutcomes, some_of
from synth.hump.trains.humped_trial import HumpedTrial
from synth.hump.trains.outcome_file import TRAINS, to_npz, trains_of
from synth.hump.trains.train_figures import TrainFigure, figures_told, in_shifts, shifts_in

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TITLES: Final = {
    "hump_speed": "mean hump speed",
    "cars_per_hour": "cars an hour",
    "catch_ups": "catch-ups",
    "misrouted": "misrouted",
    "contacts": "in contact",
    "contacts_in_last_position": "in contact in the last position alone",
    "caught_on_track": "caught up on the track",
    "stopped_on_the_way": "stopped on the way",
    "unseparated_elements_per_cut": "elements where a cut was not separated",
    "no_room": "no room on the track",
    "gap_per_cut": "gap a cut",
    "occupied_share": "share of the tracks that is taken before a train",
    "pushed_up_per_train": "tracks pushed up before a train",
    "pulled_per_train": "tracks pulled before a train",
    "strokes_per_pass": "commands to valves a pass",
}
"""What figures are called, but for those of over-speeds."""

HOW_TO_READ: Final = (
    "Misrouted: the cut came to a switch before it could be thrown behind the cut ahead, and followed that one. In "
    "contact: it ran into the cut ahead. Catch-up: one of both, but not in the last position alone. No room: less of "
    "the track was free than the cut is long. Over-speed: of the cuts that reached a track undisturbed, those that "
    "couple faster than allowed. Gap: what such cuts leave free, 0 for those that couple. Taken: by cars, and by gaps "
    "between them. Brackets: 95 % intervals; a train is what is drawn, or a shift of trains on the same tracks, and "
    "what is in it is not independent. The last column of the shares tells how many cuts would give the share within "
    "0.5 % either way."
)


def in_hundred(share: float) -> str:
    """A share in per cent, which stands in the heading."""
    return three_figures(100.0 * share)


SHARES: Final = (
    Column("title", "of all cuts", words=True),
    Column("name", "name", words=True, code=True),
    Column("share", "share", "%", in_hundred),
    Column("n", "cuts", spare=1),
    Column("enough_n", "cuts for ±0.5 %", spare=2, form=lambda number: f"{math.ceil(number):,}"),
)
MEANS: Final = (
    Column("title", "of all trains", words=True),
    Column("name", "name", words=True, code=True),
    Column("mean", "mean"),
    Column("unit", "unit", words=True),
)


def figures(result: HumpedTrial) -> Iterator[Exhibit]:
    """How many trains, their figures, and what each of them came to as a file."""
    found, config = result.found, result.config
    cuts, cars = int(found.cuts.sum()), int(found.cars.sum())
    yield Sentence(
        f"{config.title}: trains: {len(found)}; cuts: {cuts}; cars: {cars}",
        {"trains": len(found), "cuts": cuts, "cars": cars, "trains_sha256": config.trains_sha256},
        brief=True,
    )
    titles = titles_of(result.trial.couplings)
    shares = [share_row(each, titles) for each in result.figures if each.is_share]
    means = [mean_row(each, titles) for each in result.figures if not each.is_share]
    counted = Column("n", "shifts" if in_shifts(found) else "trains", spare=1)
    yield Table("means", "Means over trains", (*MEANS, counted), means, brief=True)
    yield Table("shares", "Shares of cuts", SHARES, shares, brief=True)
    yield Sentence(HOW_TO_READ)
    yield File(TRAINS, to_npz(found, trains_of(config)))


def titles_of(limits: CouplingLimits) -> dict[str, str]:
    """What figures are called."""
    allowed, rough, harmful = (f"{each:.3g}" for each in limits.classes_m_s)
    return TITLES | {
        "overspeed": f"over-speed, above {allowed} m/s",
        "overspeed_slight": f"over-speed up to {rough} m/s",
        "overspeed_rough": f"over-speed above {rough}, up to {harmful} m/s",
        "overspeed_harmful": f"over-speed above {harmful} m/s",
    }


def share_row(figure: TrainFigure, titles: Mapping[str, str]) -> Row:
    """A share of cuts; without any cut there is none."""
    enough = figure.enough_n if figure.enough_n > 0.0 else None
    return {**names_of(figure, titles), "share": figure.told, "n": figure.n, "enough_n": enough}


def mean_row(figure: TrainFigure, titles: Mapping[str, str]) -> Row:
    """A mean over trains."""
    unit = None if figure.unit == "1" else figure.unit
    return {**names_of(figure, titles), "mean": figure.told, "unit": unit, "n": figure.n}


def names_of(figure: TrainFigure, titles: Mapping[str, str]) -> Row:
    """For people and for programs."""
    return {"title": titles[figure.name], "name": figure.name}


MOST_ROWS: Final = 12
"""Rows of the table; the trains of longer shifts are told together, as many in each row."""

COLUMNS: Final = (
    Column("trains", "trains of the shift", words=True),
    Column("occupied_share", "tracks taken before", "%", in_hundred),
    Column("pushed_up_per_train", "pushed up before"),
    Column("pulled_per_train", "pulled before"),
    Column("no_room", "cuts without room", "%", in_hundred),
    Column("stopped_on_the_way", "stopped on the way", "%", in_hundred),
    Column("contacts_in_last_position", "in contact in the last position", "%", in_hundred),
    Column("overspeed", "over-speeds", "%", in_hundred),
    Column("gap_per_cut", "gap a cut", "m"),
)


def shift(result: HumpedTrial) -> Iterator[Exhibit]:
    """The table, and by which rule tracks are pushed up and pulled."""
    found, share = result.found, result.trial.tracks.pulled_from_share
    yield Table("shift", "The trains of a shift", COLUMNS, list(rows(found)))
    yield Sentence(
        f"{shifts_in(found)} shifts are independent; their first trains find tracks as drawn. Between two trains a "
        f"track whose cars take {100.0 * share:.3g} % of its length is pulled, all its cars at once. One without room "
        "for the cars of the next train is pushed up, so that no gap is left between its cars; where that is not "
        "enough, it is pulled, too. Taken: by cars, and by gaps between them. Without room: less of the track was free "
        "than the cut is long. Brackets: 95 % intervals of whole shifts."
    )


def rows(found: TrainOutcomes) -> Iterator[Row]:
    """From the first train of a shift to the last."""
    begins = np.flatnonzero(np.diff(found.shift, prepend=found.shift[:1] - 1))
    place = np.arange(len(found)) - np.repeat(begins, np.diff(np.append(begins, len(found))))
    for places in np.array_split(np.arange(place.max() + 1), min(MOST_ROWS, place.max() + 1)):
        first, last = int(places[0]) + 1, int(places[-1]) + 1
        told: dict[str, Any] = {"trains": f"{first}" if first == last else f"{first} to {last}"}
        chosen = some_of(found, np.flatnonzero(np.isin(place, places)))
        shown = {column.key for column in COLUMNS}
        yield told | {each.name: each.figure(chosen).told for each in figures_told(found) if each.name in shown}


COUNTS: Final = (
    Column("misrouted", "misrouted"),
    Column("contact", "in contact"),
    Column("unseparated", "not separated"),
    Column("foul", "foul of the cut ahead"),
)
"""Fields of the outcomes by element."""

ELEMENTS: Final = (Column("number", "element"), Column("name", "name", words=True), *COUNTS)

MISROUTES: Final = (
    "Cuts that came to a switch before it could be thrown behind the cut ahead of them. They follow that cut, and each "
    "counts once, at the first such switch."
)
CONTACTS: Final = (
    "Cuts that ran into the cut ahead of them on an element that both use. Misrouted cuts may be among them."
)
COUPLINGS: Final = (
    "Cuts that reached a track undisturbed: the speed with which they met the standing cars, and what those that "
    "stopped before left free. Shares are of all these cuts."
)


def catch_ups(result: HumpedTrial) -> Iterator[Exhibit]:
    """The plan with misroutes and with contacts, and all counts."""
    hump, found = result.config.hump, result.found
    cuts = int(found.cuts.sum())

    def drawn(counts: Ints, what: str) -> Figure:
        from synth.hump.trains.pictures.outcomes import catch_ups as on_plan

        return on_plan(hump, by_element(result.config.routes, counts), cuts, what)

    yield Chart("hump-misroutes", "Misroutes by switch", MISROUTES, partial(drawn, found.misrouted, "misroutes"))
    yield Chart("hump-contacts", "Contacts by element", CONTACTS, partial(drawn, found.contact, "contacts"))
    rows = element_rows(result.config.routes, found)
    yield Table("elements", "Cuts by element, where there was one", ELEMENTS, rows)


def couplings(found: TrainOutcomes, limits: CouplingLimits) -> Iterator[Exhibit]:
    """How cuts ended."""

    def drawn() -> Figure:
        from synth.hump.trains.pictures.outcomes import couplings as histograms

        return histograms(found, limits)

    yield Chart("hump-couplings", "Coupling speeds and gaps", COUPLINGS, drawn)


def by_element(routes: HumpRoutes, counts: Ints) -> dict[int, int]:
    """`counts` (trains, numbers) of all trains, by the number of the element."""
    return {number: int(count) for number, count in zip(routes.numbers, counts.sum(axis=0), strict=True)}


def element_rows(routes: HumpRoutes, found: TrainOutcomes) -> list[Row]:
    """The counts at each element where there is one at all."""
    counts = {column.key: by_element(routes, getattr(found, column.key)) for column in COUNTS}
    names = routes.graph.names
    rows = (
        {"number": number, "name": names.get(number)} | {key: each[number] for key, each in counts.items()}
        for number in routes.numbers
    )
    return [row for row in rows if any(row[column.key] for column in COUNTS)]
