"""One train of a trial, to look at."""

from __future__ import annotations

from synth.yard.humping.humping import Hump
from synth.yard.humping.route_rolling import rolling_on
from synth.yard.humping.train_trace import TrainTrace, train_trace
from synth.yard.humping.trial import HumpTrial


def traced_train(trial: HumpTrial, number: int) -> TrainTrace:
    """The train `number`, from 0, of `trial`: the same as in every batch."""
    trains, _, memory = trial.humped(number, 1)
    rolls = rolling_on(trial.ways, trains.population, trains.drawn, trial.threads)
    return train_trace(Hump(trial.routes, trial.positions, rolls), trains, memory, 0)
