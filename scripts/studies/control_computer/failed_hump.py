"""A hump trial of which positions have failed without the control knowing it (same trains, same plan, same
commands), as one whose brake stays as it is whatever is commanded.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from plant_models.errors import require, require_between
from plant_models.frozen_arrays import Floats
from synth.hump.rolling.hump_position import (
    Arrivals,
    HumpPosition,
    LibraryBrake,
    NormalHumpPosition,
    Passed,
    evenly_braked_s,
)
from synth.hump.trial.trial import HumpTrial


@dataclass(frozen=True)
class StuckPosition:
    """It takes `taken_head_m` from every cut, metres, evenly along the path, and obeys no command.

    A cut that has less energy stops. As all cuts that stop in a position (`humping`), it then stands at the exit. Held
    by the last position it counts as having reached its track, all of which it leaves free; those behind run into it.
    """

    taken_head_m: Callable[[Arrivals], Floats]

    def passed(self, arrivals: Arrivals) -> Passed:
        """See `HumpPosition`."""
        taken = 2.0 * arrivals.reduced_gravity_m_s2 * self.taken_head_m(arrivals)
        exit_m_s = np.sqrt(np.maximum(arrivals.unbraked_exit_m_s**2 - taken, 0.0))
        return Passed(exit_m_s, evenly_braked_s(arrivals, exit_m_s), np.zeros(len(arrivals), dtype=np.int64))


def released(arrivals: Arrivals) -> Floats:
    """What a brake takes that is stuck released: nothing."""
    return np.zeros(len(arrivals))


@dataclass(frozen=True)
class StuckStage:
    """What `brake` takes that is stuck at `stage`, whatever stages the cuts may be given, at mean friction."""

    brake: LibraryBrake
    stage: int

    def __post_init__(self) -> None:
        top = self.brake.position.top_stage
        require(1 <= self.stage <= top, f"stuck stage: {self.stage}; the position has the stages 1 to {top}")

    def __call__(self, arrivals: Arrivals) -> Floats:
        """Energy head, m."""
        stages = np.full(len(arrivals), self.stage)
        return np.asarray(self.brake.share * self.brake.full.head_m(arrivals.mass_t, arrivals.axles, stages))


BY_HAND_STD_M_S = 0.5
"""Error of exit speeds that an operator keeps by hand: engineering judgement, no figure was found in the sources."""


class Failure(Protocol):
    """How a position works when it has failed."""

    def model(self, brake: LibraryBrake) -> HumpPosition:
        """The position; `brake` is its full brake as long as it is sound."""


@dataclass(frozen=True)
class StuckReleased:
    """It brakes nothing."""

    def model(self, brake: LibraryBrake) -> HumpPosition:
        """See `Failure`."""
        return StuckPosition(released)


@dataclass(frozen=True)
class StuckAtStage:
    """It brakes every cut with one stage over the whole position."""

    stage: int

    def model(self, brake: LibraryBrake) -> HumpPosition:
        """See `Failure`."""
        return StuckPosition(StuckStage(brake, self.stage))


@dataclass(frozen=True)
class ByHand:
    """Its table is damaged and refused, so that it is braked by hand to the commanded speed, with this error."""

    exit_std_m_s: float = BY_HAND_STD_M_S

    def model(self, brake: LibraryBrake) -> HumpPosition:
        """See `Failure`."""
        return NormalHumpPosition(self.exit_std_m_s, brake)


@dataclass(frozen=True)
class WeakSupply:
    """It has only this `share` of its full brake, and keeps commands with `exit_std_m_s` where that is enough.

    A supply that is known to be weak stands in the configuration of the trial (`supply_share`), and the plan counts
    with it.
    """

    share: float
    exit_std_m_s: float

    def __post_init__(self) -> None:
        require_between("weak supply: share", self.share, 0.0, 1.0)

    def model(self, brake: LibraryBrake) -> HumpPosition:
        """See `Failure`."""
        return NormalHumpPosition(self.exit_std_m_s, replace(brake, share=self.share * brake.share))


@dataclass(frozen=True)
class FailedPosition:
    """The position `number`, 1 being the first behind the crest, and how it failed."""

    number: int
    failure: Failure


def failed_trial(trial: HumpTrial, brakes: Sequence[LibraryBrake], failed: Sequence[FailedPosition]) -> HumpTrial:
    """`trial` with the `failed` positions in the place of theirs; `brakes` of all positions (`made_trial.brake_of`).

    Only the positions change. Plan, aim and feedback are those of the sound hump; a feedback sees how cuts come to the
    next position, as it does on the sound hump. `PlantError` for a number that the hump does not have.
    """
    positions = list(trial.positions)
    for each in failed:
        require(
            1 <= each.number <= len(positions),
            f"failed position: number is {each.number}; the hump has the positions 1 to {len(positions)}",
        )
        positions[each.number - 1] = each.failure.model(brakes[each.number - 1])
    return replace(trial, positions=tuple(positions))
