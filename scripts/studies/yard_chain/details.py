"""How many records, how long a stretch, which error of the speeds; what goes wrong in a yard (wrong records, cuts
braked by hand, missed passages); and whether the approach tells enough.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from scipy.special import ndtri

from plant_models.frozen_arrays import Bools, Floats, frozen_arrays
from plant_models.rolling.random_numbers import Purpose
from scripts.studies.aiming.cuts import POINTS, FreeDistance
from scripts.studies.aiming.refinements import NearestRecord, ResistanceByRadar
from scripts.studies.aiming.trial import Cuts, Draws, Outcome, judged, outcomes, tried
from scripts.studies.yard_chain.chain import Kind
from synth.aim.knowledge import ByCategory, ByReading, Commands, Knowledge, Requirement, ResistanceByTwoSpeeds
from synth.aim.position_models import ExitSpeeds, NormalPosition, PositionModel
from synth.aim.scene import AimScene, SceneCuts

BY_HAND, HAND_SIZE = 1, 2
"""Columns of the numbers for exit errors: which cuts are braked by hand, and how far that misses."""


@frozen_arrays
class HandBrakedExits:
    """`exits`, but for the cuts `by_hand` (n,): they leave with the command and `error_m_s` (n,)."""

    exits: ExitSpeeds
    by_hand: Bools
    error_m_s: Floats

    def at(self, commanded_m_s: Floats) -> Floats:
        """Never less than 0."""
        return np.where(self.by_hand, np.maximum(commanded_m_s + self.error_m_s, 0.0), self.exits.at(commanded_m_s))

    def threshold(self, critical_m_s: Floats) -> Floats:
        """Critical speed less error where a hand brakes."""
        by_hand = np.where(critical_m_s > 0.0, critical_m_s - self.error_m_s, -np.inf)
        return np.where(self.by_hand, by_hand, self.exits.threshold(critical_m_s))


@dataclass(frozen=True)
class HandBraked:
    """A position of which a person brakes the share `share` of the cuts, with a normal exit error of `std_m_s`."""

    position: PositionModel
    share: float
    std_m_s: float

    def exits(self, cuts: SceneCuts) -> HandBrakedExits:
        """Those of the position, and of the person."""
        numbers = cuts.numbers(Purpose.EXIT_ERROR, 3)
        return HandBrakedExits(
            self.position.exits(cuts), numbers[:, BY_HAND] < self.share, self.std_m_s * ndtri(numbers[:, HAND_SIZE])
        )


@dataclass(frozen=True)
class CommandsWithMissing:
    """`known` for cuts whose passage was told, `unknown` for the share `missing`."""

    known: Commands
    unknown: Commands
    missing: float

    def of(self, cuts: SceneCuts) -> Floats:
        """For these cuts, (n, k)."""
        missed = cuts.numbers(Purpose.RECORDS, 2)[:, 1:] < self.missing
        return np.where(missed, self.unknown.of(cuts), self.known.of(cuts))


@dataclass(frozen=True)
class WithMissing:
    """A kind of knowledge that falls back to the category where a passage was missed."""

    knowledge: Knowledge
    missing: float

    def commands(self, cuts: SceneCuts, thresholds_m_s: Floats, requirement: Requirement) -> CommandsWithMissing:
        """Both kinds of commands, each for the same share of over-speeds."""
        known = self.knowledge.commands(cuts, thresholds_m_s, requirement)
        return CommandsWithMissing(known, ByCategory().commands(cuts, thresholds_m_s, requirement), self.missing)


EXIT_STD_M_S = 0.03
"""Of the exit speed where lengths and errors of sensors are compared: what our tables leave, nearly."""

WRONG, MISSED, BRAKED_BY_HAND = 0.1, 0.1, 0.1
"""Shares of records, passages and cuts at fault; assumed."""

HAND_STD_M_S = 0.5
"""Error of an exit speed by hand; assumed."""

APPROACH_M, APPROACH_STD_M_S = 4.0, 0.03
"""What the regulator's radar sees of the free roll before the position, and its error."""


@dataclass(frozen=True)
class Detail:
    """A variant with its outcome at one free distance; light single cars."""

    name: str
    outcome: Outcome | None


@dataclass(frozen=True)
class StretchRow:
    """Outcomes for one length of the stretch, one an error of the speeds."""

    length_m: float
    straight: bool
    outcomes: tuple[Outcome | None, ...]


@dataclass(frozen=True)
class Approach:
    """Mean standard deviation of the resistance that the approach tells, and the spread of that resistance, N/kN; and
    what it gives beside the category alone."""

    reading_std_n_per_kn: float
    spread_n_per_kn: float
    category: Outcome | None
    told: Outcome | None


def record_rows(
    cuts: Cuts, position: PositionModel, records: tuple[int, ...], metres: float, p: float, draws: Draws
) -> Iterator[Detail]:
    """By the number of recorded cuts."""
    for count in records:
        (found,) = tried(cuts, FreeDistance((metres,)), position, NearestRecord(POINTS, count), p, draws)
        yield Detail(str(count), found)


def stretch_rows(
    hump: AimScene, lengths_m: tuple[float, ...], stds_m_s: tuple[float, ...], metres: float, p: float, draws: Draws
) -> Iterator[StretchRow]:
    """By the length of the stretch before the position, with bends and straight."""
    for straight in (False, True):
        base = Kind("L", 1, straight).cuts(hump)
        for length in lengths_m:
            stretch = replace(base.scene.stretch, from_m=base.scene.stretch.to_m - length)
            cuts = replace(base, scene=replace(base.scene, stretch=stretch))
            found = [
                tried(cuts, FreeDistance((metres,)), NormalPosition(EXIT_STD_M_S),
                      ByReading(ResistanceByTwoSpeeds(std)), p, draws)[0]
                for std in stds_m_s
            ]  # fmt: skip
            yield StretchRow(length, straight, tuple(found))


def fault_rows(
    cuts: Cuts, position: PositionModel, records: int, metres: float, p: float, draws: Draws
) -> Iterator[Detail]:
    """What faults make of records and of measured resistance. Commands allow for none of them but the wrong records,
    which are in what the margin is chosen with, and missed passages, which the control knows of."""
    place = FreeDistance((metres,))
    two, nearest = ByReading(ResistanceByTwoSpeeds(0.03)), NearestRecord(POINTS, records)
    asked: tuple[tuple[str, Knowledge], ...] = (
        (f"nearest of {records} records", nearest),
        (f"{100 * WRONG:g} % of the records wrong", replace(nearest, wrong=WRONG)),
        ("two speeds, σ_v 0.03", two),
        (f"{100 * MISSED:g} % of the passages missed", WithMissing(two, MISSED)),
    )
    for name, knowledge in asked:
        yield Detail(name, tried(cuts, place, position, knowledge, p, draws)[0])
    by_hand = HandBraked(position, BRAKED_BY_HAND, HAND_STD_M_S)
    rows = []
    for design, report in cuts.drawn(draws, place):
        rows.append(judged(design.at(position), report.at(by_hand), two, p))
    yield Detail(
        f"{100 * BRAKED_BY_HAND:g} % of the cuts braked by hand, σ {HAND_STD_M_S:g}", outcomes(np.array(rows))[0]
    )


def approach_row(cuts: Cuts, position: PositionModel, metres: float, p: float, draws: Draws) -> Approach:
    """Whether the free roll before the position, which the regulator sees anyway, tells the resistance."""
    place, radar = FreeDistance((metres,)), ResistanceByRadar(APPROACH_STD_M_S, APPROACH_M)
    read = radar.of(cuts.scene.draw(cuts.category, cuts.cars, draws.seed, 0, draws.design))
    known = (ByCategory(), ByReading(radar))
    category, told = (tried(cuts, place, position, each, p, draws)[0] for each in known)
    return Approach(float(read.std.mean()), float(read.value.std()), category, told)
