"""What goes wrong in a yard: wrong records, cuts braked by hand, passages that are missed."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.special import ndtri

from plant_models.frozen_arrays import Bools, Floats, frozen_arrays
from plant_models.rolling.random_numbers import Purpose
from synth.aim.knowledge import ByCategory, Commands, Knowledge, Requirement
from synth.aim.position_models import ExitSpeeds, PositionModel
from synth.aim.scene import SceneCuts

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
