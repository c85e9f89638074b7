"""One train of a trial, to look at."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from synth.hump.trains.chosen_trains import TYPICAL_AMONG
from synth.hump.trains.controlled_train import ControlledTrain, controlled_train
from synth.hump.trains.outcomes import TrainOutcomes
from synth.hump.trains.train_cuts import TrainCuts
from synth.hump.trains.train_memory import TrainMemory
from synth.hump.trains.train_passages import train_passages
from synth.hump.trains.train_plan import TrainPlan
from synth.hump.trains.train_trace import TrainTrace, train_trace
from synth.hump.trains.trial import HumpTrial


@dataclass(frozen=True)
class OneTrain:
    """The train `lane` of `trains` that `trial` humped by `plan`: what happened to it."""

    trial: HumpTrial
    trains: TrainCuts
    plan: TrainPlan
    memory: TrainMemory
    lane: int = 0

    @property
    def number(self) -> int:
        """From 0, as figures count trains."""
        return int(self.trains.numbers[self.lane])

    def traced(self) -> TrainTrace:
        """Its cuts on their ways."""
        hump = self.trial.hump_for(self.trial.rolls_of(self.trains))
        return train_trace(hump, self.trains, self.memory, self.lane, self.trial.couplings.allowed_m_s)

    def outcomes(self) -> TrainOutcomes:
        """What it and those that were humped with it came to, it in the row `lane`."""
        return self.trial.outcomes(self.trains, self.memory)

    def controlled(self) -> ControlledTrain:
        """What the hump control records of it."""
        return controlled_train(self.trial.routes, self.trains, self.memory, self.lane)

    def standing(self) -> int:
        """How many of its cuts come to no element: they stand between the crest and the first one."""
        return sum(not way for way in train_passages(self.trial.routes, self.trains, self.memory, self.lane).ways)


def one_train(trial: HumpTrial, number: int) -> OneTrain:
    """The train `number`, from 0, of `trial`: the same as in every batch."""
    turn = trial.turn(*trial.train(number))
    return OneTrain(trial, turn.trains, turn.plan, turn.memory)


def some_trains(trial: HumpTrial, numbers: Sequence[int]) -> tuple[OneTrain, ...]:
    """The trains `numbers`, from 0; where each has tracks of its own, those among the first few are humped together,
    which takes no longer than one."""
    most = TYPICAL_AMONG if trial.tracks.shift_trains == 1 else 0
    early = [number for number in numbers if number < most]
    together = trial.humped(0, max(early) + 1) if early else None
    return tuple(
        OneTrain(trial, *together, lane=number) if together and number < most else one_train(trial, number)
        for number in numbers
    )
