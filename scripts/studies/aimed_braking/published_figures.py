"""Kozachenko's figures anew: over-speed and gap over speed, one over the other, gap over distance."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plant_models.library.weight_category import WeightCategory
from scripts.studies.aiming.aimed_cuts import AimedCuts, rolled_cuts
from scripts.studies.aiming.places import FromCrest
from scripts.studies.aiming.trial import Cuts, Draws, Outcome, Value, tried, value_of
from synth.aim.knowledge import ByCategory, Knowledge
from synth.aim.position_models import NormalPosition
from synth.aim.scene import AimScene


@dataclass(frozen=True)
class AtSpeed:
    """All cuts are commanded `speed_m_s`: share above the limit, and gap a car, with 95 % intervals."""

    speed_m_s: float
    overspeed: Value
    gap_m: Value


@dataclass(frozen=True)
class OverSpeeds:
    """One category and place: a row a commanded speed."""

    category: str
    metres: float
    rows: tuple[AtSpeed, ...]


@dataclass(frozen=True)
class Line:
    """Outcomes over `metres`; None where no command keeps the share of over-speeds."""

    name: str
    metres: tuple[float, ...]
    outcomes: tuple[Outcome | None, ...]


def over_speeds(
    scene: AimScene,
    category: WeightCategory,
    metres: float,
    speeds_m_s: tuple[float, ...],
    exit_std_m_s: float,
    draws: Draws,
) -> OverSpeeds:
    """Figures 2 and 3: over-speed and gap of single cars for commanded speeds."""
    found = np.array(
        [
            at_speeds(rolled_cuts(report, FromCrest((metres,))).at(NormalPosition(exit_std_m_s, False)), speeds_m_s)
            for _, report in Cuts(scene, category).unrolled(draws)
        ]
    )
    rows = tuple(
        AtSpeed(speed, value_of(of_speed[:, 0]), value_of(of_speed[:, 1]))
        for speed, of_speed in zip(speeds_m_s, np.moveaxis(found, 1, 0), strict=True)
    )
    return OverSpeeds(category.latin, metres, rows)


def at_speeds(cuts: AimedCuts, speeds_m_s: tuple[float, ...]) -> list[tuple[float, float]]:
    """(over-speed, gap a car) for each commanded speed."""
    met = [cuts.couplings(np.full(len(cuts.cuts), speed), 0) for speed in speeds_m_s]
    return [(float((m.speed_m_s > m.limit_m_s).mean()), float(m.gap_m.mean()) / m.cars) for m in met]


def line(
    name: str, cuts: Cuts, metres: tuple[float, ...], exit_std_m_s: float, knowledge: Knowledge, p: float, draws: Draws
) -> Line:
    """Figures 4 and 5: the outcome over the distance from the crest."""
    position = NormalPosition(exit_std_m_s, only_brakes=False)
    return Line(name, metres, tried(cuts, FromCrest(metres), position, knowledge, p, draws))


def by_category(
    scene: AimScene, metres: tuple[float, ...], exit_std_m_s: float, p: float, draws: Draws
) -> tuple[Line, ...]:
    """A line a category, single cars."""
    members = scene.population.categories.members
    return tuple(line(c.latin, Cuts(scene, c), metres, exit_std_m_s, ByCategory(), p, draws) for c in members)
