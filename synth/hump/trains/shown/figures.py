"""The figures of many humped trains as tables: shares of cuts, and means over trains."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Final

from synth.frame.exhibits import Column, Exhibit, File, Row, Sentence, Table
from synth.frame.printed_numbers import three_figures
from synth.hump.configuration.coupling_limits import CouplingLimits
from synth.hump.trains.humped_trial import HumpedTrial
from synth.hump.trains.outcome_file import TRAINS, to_npz, trains_of
from synth.hump.trains.shift_sums import in_shifts
from synth.hump.trains.train_figures import TrainFigure

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
