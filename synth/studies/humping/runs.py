"""Trials on the same trains, batch by batch in processes of their own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

from synth.studies.study import Tell
from synth.sweep.local_workers import LocalWorkers
from synth.sweep.work import Answer, answered
from synth.yard.humping.known_cuts import KnownCuts
from synth.yard.humping.outcomes import TrainOutcomes, joined, outcomes
from synth.yard.humping.train_plan import Planner, TrainPlan
from synth.yard.humping.trial import BATCH, HumpTrial

PLANNED_WITH = ("source", "routes", "ways", "planner", "program", "aim", "usable_heads_m", "free")
"""What a program of hump speeds depends on, besides whether positions brake early."""


@dataclass(frozen=True)
class Planned:
    """A program that was made before, of the same trains."""

    made: TrainPlan

    def plan(self, planner: Planner, known: KnownCuts) -> TrainPlan:
        """That."""
        return self.made


@dataclass(frozen=True)
class Group:
    """Trials by name that differ in what happens after the hump speeds were planned: they have one program.

    Trains, planner, what is known before the train, and aims must be those of the first.
    """

    trials: Mapping[str, HumpTrial]

    def __post_init__(self) -> None:
        first = next(iter(self.trials.values()))
        for trial in self.trials.values():
            same = all(getattr(trial, name) is getattr(first, name) for name in PLANNED_WITH)
            early = [[position.brakes_early for position in each.positions] for each in (trial, first)]
            assert same, "trials of a group must share their program"
            assert early[0] == early[1], "positions of a group must be of one kind"

    def batch(self, first: int, count: int) -> tuple[TrainOutcomes, ...]:
        """What the trains `first` … `first + count − 1` come to in each of them."""
        found: list[TrainOutcomes] = []
        plan: TrainPlan | None = None
        for trial in self.trials.values():
            now = trial if plan is None else replace(trial, program=Planned(plan))
            trains, plan, memory = now.humped(first, count)
            found.append(outcomes(trial.routes, trains, memory))
        return tuple(found)


@dataclass(frozen=True)
class BatchOrder:
    """Some trains of a group; `key` tells it from other orders."""

    key: str
    group: Group
    first: int
    count: int


def answer_batch(order: BatchOrder) -> Answer:
    """Hump the trains of an order."""
    return answered(order, humped_batch)


def humped_batch(order: BatchOrder) -> tuple[TrainOutcomes, ...]:
    """What they come to in every trial."""
    from synth.kernels.cache import guarded

    return guarded(order.group.batch, order.first, order.count)


def measured(groups: Sequence[Group], trains: int, workers: int, tell: Tell) -> dict[str, TrainOutcomes]:
    """The outcomes of every trial by its name, each on the trains 0 … `trains` − 1."""
    names = [name for group in groups for name in group.trials]
    assert len(set(names)) == len(names), "each trial must have a name of its own"
    starts = range(0, trains, BATCH)
    orders = [
        BatchOrder(f"{place}:{first}", group, first, min(BATCH, trains - first))
        for place, group in enumerate(groups)
        for first in starts
    ]
    found: dict[str, tuple[TrainOutcomes, ...]] = {}
    for each in LocalWorkers(workers, answer_batch).answers(orders, lambda _: None):
        if each.result is None:
            raise RuntimeError(f"hump study: {each.reason}")
        found[each.key] = each.result
        tell(f"{len(found)} of {len(orders)} batches, {each.seconds:.0f} s")
    whole: dict[str, TrainOutcomes] = {}
    for place, group in enumerate(groups):
        parts = [found[f"{place}:{first}"] for first in starts]
        for k, name in enumerate(group.trials):
            whole[name] = joined([part[k] for part in parts])
    return whole
