"""Where cuts were caught up, and how they ended: counts by element, and pictures."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING, Final

from plant_models.frozen_arrays import Ints
from synth.frame.exhibits import Chart, Column, Exhibit, Row, Table
from synth.hump.configuration.coupling_limits import CouplingLimits
from synth.hump.trains.hump_routes import HumpRoutes
from synth.hump.trains.humped_trial import HumpedTrial
from synth.hump.trains.outcomes import TrainOutcomes

if TYPE_CHECKING:
    from matplotlib.figure import Figure

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
        from synth.hump.trains.pictures.catch_ups import catch_ups as on_plan

        return on_plan(hump, by_element(result.config.routes, counts), cuts, what)

    yield Chart("hump-misroutes", "Misroutes by switch", MISROUTES, partial(drawn, found.misrouted, "misroutes"))
    yield Chart("hump-contacts", "Contacts by element", CONTACTS, partial(drawn, found.contact, "contacts"))
    rows = element_rows(result.config.routes, found)
    yield Table("elements", "Cuts by element, where there was one", ELEMENTS, rows)


def couplings(found: TrainOutcomes, limits: CouplingLimits) -> Iterator[Exhibit]:
    """How cuts ended."""

    def drawn() -> Figure:
        from synth.hump.trains.pictures.couplings import couplings as histograms

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
