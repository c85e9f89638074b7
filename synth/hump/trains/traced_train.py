"""One train of a trial, to look at."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from synth.hump.trains.controlled_train import ControlledTrain, controlled_train
from synth.hump.trains.train_cuts import TrainCuts
from synth.hump.trains.train_memory import TrainMemory
from synth.hump.trains.train_passages import train_passages
from synth.hump.trains.train_plan import TrainPlan
from synth.hump.trains.train_trace import TrainTrace, train_trace
from synth.hump.trains.trial import HumpTrial


@dataclass(frozen=True)
class OneTrain:
    """A train of `trial`, alone in `trains`, its plan, and what happened to it."""

    trial: HumpTrial
    trains: TrainCuts
    plan: TrainPlan
    memory: TrainMemory

    def traced(self) -> TrainTrace:
        """Its cuts on their ways."""
        hump = self.trial.hump_for(self.trial.rolls_of(self.trains))
        return train_trace(hump, self.trains, self.memory, 0, self.trial.couplings.allowed_m_s)

    def controlled(self) -> ControlledTrain:
        """What the hump control records of it."""
        return controlled_train(self.trial.routes, self.trains, self.memory, 0)

    def standing(self) -> int:
        """How many of its cuts come to no element: they stand between the crest and the first one."""
        return sum(not way for way in train_passages(self.trial.routes, self.trains, self.memory, 0).ways)


def early_traces(trial: HumpTrial, numbers: Sequence[int]) -> tuple[TrainTrace, ...]:
    """The trains `numbers`, from 0, humped together: all trains up to the last of them are."""
    if not numbers:
        return ()
    trains, _, memory = trial.humped(0, max(numbers) + 1)
    hump = trial.hump_for(trial.rolls_of(trains))
    return tuple(train_trace(hump, trains, memory, number, trial.couplings.allowed_m_s) for number in numbers)


def one_train(trial: HumpTrial, number: int) -> OneTrain:
    """The train `number`, from 0, of `trial`: the same as in every batch."""
    trains, plan, memory = trial.humped(number, 1)
    return OneTrain(trial, trains, plan, memory)
