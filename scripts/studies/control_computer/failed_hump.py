"""A hump trial of which positions have failed without the control knowing it: same trains, same plan, same commands."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol

from plant_models.errors import require, require_between
from scripts.studies.control_computer.stuck_position import StuckPosition, StuckStage, released
from synth.hump.trains.hump_position import HumpPosition
from synth.hump.trains.normal_hump_position import LibraryBrake, NormalHumpPosition
from synth.hump.trains.trial import HumpTrial

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
