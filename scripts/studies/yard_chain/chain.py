"""Every position with every kind of knowledge, on common cuts."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from plant_models.frozen_arrays import Floats
from scripts.studies.aiming.aimed_cuts import rolled_cuts
from scripts.studies.aiming.hump import POINTS, weight_category, with_bends
from scripts.studies.aiming.places import FreeDistance
from scripts.studies.aiming.readings import LightnessByWeigher, ResistanceByRadar
from scripts.studies.aiming.recorded_cuts import NearestRecord
from scripts.studies.aiming.regression import ByRegression
from scripts.studies.aiming.trial import Cuts, Draws, judged
from scripts.studies.side_by_side import side_by_side
from scripts.studies.yard_chain.park_book import ParkBook, park_book
from synth.aim.knowledge import ByCategory, ByReading, Knowledge
from synth.aim.position_models import NormalPosition, PositionModel
from synth.aim.readings import ResistanceByTwoSpeeds
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
