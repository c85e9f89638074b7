"""One train of a trial, to look at."""

from __future__ import annotations

from dataclasses import dataclass

from synth.hump.trains.controlled_train import ControlledTrain, controlled_train
from synth.hump.trains.humping import Hump
from synth.hump.trains.route_rolling import rolling_on
from synth.hump.trains.train_cuts import TrainCuts
from synth.hump.trains.train_memory import TrainMemory
from synth.hump.trains.train_passages import train_passages
from synth.hump.trains.train_trace import TrainTrace, train_trace
from synth.hump.trains.trial import HumpTrial


@dataclass(frozen=True)
class OneTrain:
    """A train of `trial`, alone in `trains`, and what happened to it."""

    trial: HumpTrial
    trains: TrainCuts
    memory: TrainMemory

    def traced(self) -> TrainTrace:
        """Its cuts on their ways."""
        trial = self.trial
        rolls = rolling_on(trial.ways, self.trains.population, self.trains.drawn, trial.threads)
        return train_trace(
            Hump(trial.routes, trial.positions, rolls), self.trains, self.memory, 0, trial.couplings.allowed_m_s
        )

    def controlled(self) -> ControlledTrain:
        """What the hump control records of it."""
        return controlled_train(self.trial.routes, self.trains, self.memory, 0)

    def standing(self) -> int:
        """How many of its cuts come to no element: they stand between the crest and the first one."""
        return sum(not way for way in train_passages(self.trial.routes, self.trains, self.memory, 0).ways)


def one_train(trial: HumpTrial, number: int) -> OneTrain:
    """The train `number`, from 0, of `trial`: the same as in every batch."""
    trains, _, memory = trial.humped(number, 1)
    return OneTrain(trial, trains, memory)
