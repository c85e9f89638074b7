"""Commands that keep the probability of over-speed over all cuts, whatever is known of them.

A kind of knowledge gives commands for a level of probability. Cuts that no command serves are commanded the lowest one,
and couple too fast more often than that level; so the level for all is lowered until the share over all cuts is kept.
Every kind of knowledge is compared at the same share of over-speeds so.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Floats, frozen_arrays
from scripts.studies.aiming.aimed_cuts import AimedCuts
from scripts.studies.aiming.recorded_cuts import NearestRecord
from synth.aim.knowledge import Commands, Knowledge, Requirement
from synth.aim.scene import SceneCuts

BOUNDS_M_S = (0.5, 7.0)
"""Commands that a park position is given."""

NOT_SERVED_M_S = 0.4
"""Stands for every threshold below the lowest command: no command serves such a cut, however far below it is."""

TRIES = 12
"""Levels tried at most; where cuts that nothing serves are many, the share jumps, and the best one below counts."""

NEAR = 0.001
"""A share that is so near below what is required is near enough."""


@frozen_arrays
class Commanded:
    """What n cuts are commanded, `speed_m_s` (n,), and the share `unserved` that is commanded the lowest speed because
    no command serves it."""

    speed_m_s: Floats
    unserved: float


@dataclass(frozen=True)
class LevelledCommands:
    """Commands for one place; a cut that they do not serve is commanded the lowest."""

    commands: Commands
    level: float

    def of(self, cuts: SceneCuts) -> Commanded:
        """For each of these cuts."""
        told = self.commands.of(cuts)[:, 0]
        served = told >= BOUNDS_M_S[0]  # false for NaN, too
        return Commanded(np.where(served, told, BOUNDS_M_S[0]), 1.0 - float(served.mean()))


def levelled(knowledge: Knowledge, design: AimedCuts, place: int, p_overspeed: float) -> LevelledCommands | None:
    """The commands for one place with which at most the share `p_overspeed` of `design` couples too fast; None where
    no level gives so few."""
    thresholds = np.maximum(design.thresholds_m_s[:, place : place + 1], NOT_SERVED_M_S)
    others = slice(knowledge.records if isinstance(knowledge, NearestRecord) else 0, None)  # a record finds itself

    def tried(level: float) -> tuple[LevelledCommands, float]:
        requirement = Requirement(level, (NOT_SERVED_M_S, BOUNDS_M_S[1]))
        commands = LevelledCommands(knowledge.commands(design.cuts, thresholds, requirement), level)
        over = commands.of(design.cuts).speed_m_s > thresholds[:, 0]
        return commands, float(over[others].mean())

    found, low, high, level = None, 0.0, 2.0 * p_overspeed, p_overspeed
    for _ in range(TRIES):
        commands, share = tried(level)
        if share <= p_overspeed:
            found, low = commands, level
            if share >= p_overspeed - NEAR:
                break
        else:
            high = level
        level += p_overspeed - 0.5 * NEAR - share  # the share follows the level nearly one to one
        if not low < level < high:
            level = 0.5 * (low + high)
    return found
