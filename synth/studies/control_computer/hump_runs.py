"""Hump trials of the same trains, with what became of them and how soon a cut stood in a position."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from synth.studies.control_computer.failure_costs_of_hump import cuts_before_stop
from synth.studies.humping.runs import Group, Planned
from synth.studies.study import Tell
from synth.sweep.local_workers import LocalWorkers
from synth.sweep.work import Answer, answered
from synth.yard.humping.outcomes import TrainOutcomes, joined, outcomes
from synth.yard.humping.train_plan import TrainPlan

BATCH = 50
"""Trains of an order; few, so that all workers end at nearly the same time."""


@frozen_arrays
@dataclass(frozen=True, eq=False)
class Humped:
    """What trains came to, and how many cuts of each were let go before one stood in a position, (trains,)."""

    outcomes: TrainOutcomes
    before_stop: NDArray[np.int64]


@dataclass(frozen=True)
class Order:
    """Some trains of a group."""

    key: str
    group: Group
    first: int
    count: int


def answer_order(order: Order) -> Answer:
    """Hump the trains of an order."""
    return answered(order, humped_order)


def humped_order(order: Order) -> tuple[Humped, ...]:
    """What they come to in every trial."""
    from synth.kernels.cache import guarded

    return guarded(humped, order)


def humped(order: Order) -> tuple[Humped, ...]:
    """The same; all trials of a group have one plan, which is made once."""
    found: list[Humped] = []
    plan: TrainPlan | None = None
    for trial in order.group.trials.values():
        now = trial if plan is None else replace(trial, program=Planned(plan))
        trains, plan, memory = now.humped(order.first, order.count)
        found.append(Humped(outcomes(trial.routes, trains, memory), cuts_before_stop(memory)))
    return tuple(found)


def measured(groups: Sequence[tuple[Group, int]], workers: int, tell: Tell) -> dict[str, Humped]:
    """Every trial by its name, each on the trains 0 … n − 1, where n stands beside its group."""
    orders = [
        Order(f"{place}:{first}", group, first, min(BATCH, trains - first))
        for place, (group, trains) in enumerate(groups)
        for first in range(0, trains, BATCH)
    ]
    found: dict[str, tuple[Humped, ...]] = {}
    for each in LocalWorkers(workers, answer_order).answers(orders, lambda _: None):
        if each.result is None:
            raise RuntimeError(f"control-computer study: {each.reason}")
        found[each.key] = each.result
        tell(f"{len(found)} of {len(orders)} batches of trains, {each.seconds:.0f} s")
    whole: dict[str, Humped] = {}
    for place, (group, trains) in enumerate(groups):
        parts = [found[f"{place}:{first}"] for first in range(0, trains, BATCH)]
        for k, name in enumerate(group.trials):
            mine = [part[k] for part in parts]
            whole[name] = Humped(
                joined([each.outcomes for each in mine]), np.concatenate([each.before_stop for each in mine])
            )
    return whole


def first_trains(found: TrainOutcomes, count: int) -> TrainOutcomes:
    """The outcomes of the first `count` trains."""
    return TrainOutcomes(*(getattr(found, field.name)[:count] for field in fields(TrainOutcomes)))
