"""Every position with every kind of knowledge, on common cuts; and what a yard manager asks: metres of gap and
damaging couplings, today's practice beside the chain.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from plant_models.frozen_arrays import Floats, frozen_arrays
from scripts.studies.aiming.cuts import POINTS, FreeDistance, rolled_cuts, weight_category, with_bends
from scripts.studies.aiming.refinements import ByRegression, LightnessByWeigher, NearestRecord, ResistanceByRadar
from scripts.studies.aiming.trial import Cuts, Draws, Value, judged, value_if_known
from scripts.studies.cases import side_by_side
from scripts.studies.yard_chain.park_book import ParkBook, park_book
from synth.aim.knowledge import ByCategory, ByReading, Knowledge, ResistanceByTwoSpeeds
from synth.aim.position_models import NormalPosition, PositionModel
from synth.aim.scene import AimScene, SceneCuts

BUNCH_SPEED_M_S = {"L": 4.5, "T": 3.5}
"""Out of the bunch position. From 4.5 m/s the park position cannot hold heavy cars; see `brake_saturated`."""

TARGETS_M_S = {"L": (1.0, 1.3, 1.6, 2.0, 2.6, 3.5), "T": (1.0, 1.2, 1.4, 1.7, 2.0, 2.6)}
"""Exit speeds that the books have tables for."""

TABLES, ESTIMATED = "our tables", "our tables, estimator"

CATEGORY, MEASURED, RADAR = "category", "two speeds, σ_v 0.03", "radar 0.05 on 50 m"


@dataclass(frozen=True)
class Kind:
    """Which cuts: category, cars, and whether the stretch before the position is straight."""

    category: str
    cars: int
    straight: bool = False

    @property
    def name(self) -> str:
        """'light, 3 cars, straight stretch'."""
        words = {"L": "light", "T": "heavy"}[self.category]
        return f"{words}, {self.cars} car{'s' * (self.cars > 1)}{', straight stretch' * self.straight}"

    def cuts(self, hump: AimScene) -> Cuts:
        """These cuts on the hump."""
        scene = with_bends(hump, ()) if self.straight else hump
        stretch = replace(scene.stretch, speed_mean_m_s=BUNCH_SPEED_M_S[self.category])
        return Cuts(replace(scene, stretch=stretch), weight_category(scene, self.category), self.cars)


@dataclass(frozen=True)
class BookSize:
    """Classes by mass, and tables of a class; whether they are tuned on a coarse grid."""

    classes: int
    tables: int
    coarse: bool = False

    def book(self, cuts: Cuts) -> ParkBook:
        """The book for such cuts: the lowest exit speeds and the highest."""
        targets = TARGETS_M_S[cuts.category.latin]
        return park_book(cuts, (*targets[: self.tables - 1], targets[-1]), self.classes, self.coarse)


def positions_of(cuts: Cuts, books: BookSize) -> dict[str, PositionModel]:
    """Every position by its name; the tables are tuned here."""
    book = books.book(cuts)
    return {
        "ideal": NormalPosition(0.0),
        "σ 0.1": NormalPosition(0.1),
        "σ 0.2": NormalPosition(0.2),
        "σ 0.4": NormalPosition(0.4),
        "energy rule": book.energy_rule(),
        TABLES: book.tables(estimator=False),
        ESTIMATED: book.tables(estimator=True),
    }


def knowledge_of(records: int) -> dict[str, Knowledge]:
    """Every kind of knowledge by its name."""
    return {
        CATEGORY: ByCategory(),
        "exact weight": ByRegression(LightnessByWeigher(1e-4)),
        f"three points, {records} records": NearestRecord(POINTS, records),
        "regression, σ_v 0.1": ByRegression(ResistanceByTwoSpeeds(0.1)),
        "regression, σ_v 0.03": ByRegression(ResistanceByTwoSpeeds(0.03)),
        "two speeds, σ_v 0.1": ByReading(ResistanceByTwoSpeeds(0.1)),
        MEASURED: ByReading(ResistanceByTwoSpeeds(0.03)),
        RADAR: ByReading(ResistanceByRadar(0.05, 50.0)),
    }


def chain_samples(
    cuts: Cuts,
    metres: tuple[float, ...],
    positions: Mapping[str, PositionModel],
    knowledge: Mapping[str, Knowledge],
    p_overspeed: float,
    draws: Draws,
) -> Floats:
    """Figures of every replicate, (replicates, knowledge, positions, places, FIGURES)."""
    places = FreeDistance(metres)

    def replicate(both: tuple[SceneCuts, SceneCuts]) -> Floats:
        design, report = (rolled_cuts(each, places) for each in both)
        sides = [(design.at(position), report.at(position)) for position in positions.values()]
        return np.array([[judged(*side, known, p_overspeed) for side in sides] for known in knowledge.values()])

    return np.array(side_by_side(replicate, cuts.unrolled(draws)))


def brake_saturated(hump: AimScene, bunch_m_s: float, books: BookSize, count: int, seed: int) -> float:
    """Share of heavy single cars that leave more than 0.3 m/s above the lowest target of our tables, where they leave
    the bunch position at `bunch_m_s`."""
    kind = Kind("T", 1)
    cuts = kind.cuts(hump)
    scene = replace(cuts.scene, stretch=replace(cuts.scene.stretch, speed_mean_m_s=bunch_m_s))
    fast = Cuts(scene, cuts.category)
    position, lowest = books.book(fast).tables(estimator=False), TARGETS_M_S["T"][0]
    exits = position.exits(scene.draw(cuts.category, 1, seed, 0, count)).at(np.full(count, lowest))
    return float((exits > lowest + 0.3).mean())


TODAY_EXIT = "σ 0.4"

LIGHT, HEAVY = Kind("L", 1), Kind("T", 1)
LIGHT_STRAIGHT, HEAVY_STRAIGHT = Kind("L", 1, True), Kind("T", 1, True)


@frozen_arrays
class Samples:
    """Figures of every replicate (replicates, knowledge, positions, places, FIGURES) with the names of two axes."""

    knowledge: tuple[str, ...]
    positions: tuple[str, ...]
    figures: Floats

    def of(self, knowledge: str, position: str) -> Floats:
        """(replicates, places, FIGURES) of one pair."""
        return np.asarray(self.figures[:, self.knowledge.index(knowledge), self.positions.index(position)])


@dataclass(frozen=True)
class Practice:
    """Single cars, light and heavy alike often, all free distances alike often: metres of gap a car, and couplings
    above the limit, 1.5 and 2 m/s in a thousand cars. None where some cuts have no commands for the share."""

    name: str
    gap_m: Value | None
    couplings: tuple[Value | None, Value | None, Value | None]


@dataclass(frozen=True)
class Saved:
    """Metres of gap a car that one practice leaves more than another, on the same cuts at one free distance."""

    cuts: str
    metres: float
    exit_alone_m: Value | None
    measuring_alone_m: Value | None
    both_m: Value | None


def practice(name: str, pairs: tuple[Floats, ...]) -> Practice:
    """The mean over kinds of cuts, each (replicates, places, FIGURES)."""
    mean = np.mean([each.mean(axis=1) for each in pairs], axis=0)
    gap, over, harder, hardest = (value_if_known(scale * mean[:, k]) for k, scale in enumerate((1.0, 1e3, 1e3, 1e3)))
    return Practice(name, gap, (over, harder, hardest))


def practices(
    all_cuts: Mapping[Kind, Samples], careful: Mapping[Kind, Samples], careful_share: float
) -> tuple[Practice, ...]:
    """Today's, each step alone, the chain, and that on a straight stretch; `careful`: at the share `careful_share`."""

    def both(
        samples: Mapping[Kind, Samples], light: Kind, heavy: Kind, known: str, position: str
    ) -> tuple[Floats, ...]:
        return samples[light].of(known, position), samples[heavy].of(known, position)

    bent, straight = (LIGHT, HEAVY), (LIGHT_STRAIGHT, HEAVY_STRAIGHT)
    return (
        practice("today: exit σ 0.4, category", both(all_cuts, *bent, CATEGORY, TODAY_EXIT)),
        practice("our tables, category", both(all_cuts, *bent, CATEGORY, ESTIMATED)),
        practice("exit σ 0.4, resistance measured", both(all_cuts, *bent, MEASURED, TODAY_EXIT)),
        practice("our tables, resistance measured", both(all_cuts, *bent, MEASURED, ESTIMATED)),
        practice("the same, straight stretch", both(all_cuts, *straight, MEASURED, ESTIMATED)),
        practice(f"the same, share {careful_share:g}", both(careful, *straight, MEASURED, ESTIMATED)),
    )


def saved(kind: Kind, samples: Samples, metres: tuple[float, ...]) -> tuple[Saved, ...]:
    """What our tables, measuring, and both save beside today's practice; a row a distance."""
    today = samples.of(CATEGORY, TODAY_EXIT)
    pairs = ((CATEGORY, ESTIMATED), (MEASURED, TODAY_EXIT), (MEASURED, ESTIMATED))
    steps = [today - samples.of(*pair) for pair in pairs]
    return tuple(
        Saved(kind.name, place, *(value_if_known(step[:, k, 0]) for step in steps)) for k, place in enumerate(metres)
    )
