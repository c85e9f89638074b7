"""Hump trials of the same trains, with what became of them and how soon a cut stood in a position."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields

import numpy as np

from plant_models.frozen_arrays import Ints, frozen_arrays
from scripts.studies.control_computer.failure_costs_of_hump import cuts_before_stop
from scripts.studies.humping.runs import Group, Kept, measured_each
from scripts.studies.study import Tell
from synth.hump.trains.outcomes import TrainOutcomes, joined, outcomes
from synth.hump.trains.train_cuts import TrainCuts
from synth.hump.trains.train_memory import TrainMemory
from synth.hump.trains.trial import HumpTrial

BATCH = 50
"""Trains of an order; few, so that all workers end at nearly the same time."""


@frozen_arrays
class Humped:
    """What trains came to, and how many cuts of each were let go before one stood in a position, (trains,)."""

    outcomes: TrainOutcomes
    before_stop: Ints


def humped_of(trial: HumpTrial, trains: TrainCuts, memory: TrainMemory) -> Humped:
    """Of one batch."""
    return Humped(outcomes(trial.routes, trains, memory), cuts_before_stop(memory))


def joined_humped(parts: list[Humped]) -> Humped:
    """Of all batches of a trial."""
    return Humped(joined([each.outcomes for each in parts]), np.concatenate([each.before_stop for each in parts]))


HUMPED = Kept(humped_of, joined_humped)


def measured(groups: Sequence[tuple[Group, int]], workers: int, tell: Tell) -> dict[str, Humped]:
    """Every trial by its name, each on the trains 0 … n − 1, where n stands beside its group."""
    return measured_each(groups, HUMPED, workers, tell, BATCH)


def first_trains(found: TrainOutcomes, count: int) -> TrainOutcomes:
    """The outcomes of the first `count` trains."""
    return TrainOutcomes(*(getattr(found, field.name)[:count] for field in fields(TrainOutcomes)))
