"""Trials on the same trains, batch by batch in processes of their own."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, Generic, TypeVar

from scripts.studies.study import Tell
from synth.frame.workers.engine import Answer, answered
from synth.frame.workers.local_workers import LocalWorkers
from synth.hump.planning.known_cuts import KnownCuts
from synth.hump.planning.train_plan import Planner, TrainPlan
from synth.hump.rolling.outcomes import TrainOutcomes, joined, outcomes
from synth.hump.rolling.train_cuts import TrainCuts
from synth.hump.rolling.train_memory import TrainMemory
from synth.hump.trial.trial import BATCH, HumpTrial

T = TypeVar("T")

PLANNED_WITH = ("source", "routes", "ways", "planner", "aim", "usable_heads_m", "tracks")
"""What a program of hump speeds depends on."""


@dataclass(frozen=True, kw_only=True)
class Planned(Planner):
    """A planner that has `made` its plan before, of the same trains."""

    made: TrainPlan

    def plan(self, known: KnownCuts) -> TrainPlan:
        """That."""
        return self.made


@dataclass(frozen=True)
class Kept(Generic[T]):
    """What is kept of humped trains, by a function of a module, and how that of several batches is joined."""

    told: Callable[[HumpTrial, TrainCuts, TrainMemory], T]
    joined: Callable[[list[T]], T]


def outcomes_of(trial: HumpTrial, trains: TrainCuts, memory: TrainMemory) -> TrainOutcomes:
    """What trains came to."""
    return outcomes(trial.routes, trains, memory)


OUTCOMES = Kept(outcomes_of, joined)


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
            assert same, "trials of a group must share their program"

    def batch(self, first: int, count: int, kept: Kept[T]) -> tuple[T, ...]:
        """What is kept of the trains `first` … `first + count − 1` in each of them."""
        found: list[T] = []
        plan: TrainPlan | None = None
        for trial in self.trials.values():
            now = trial if plan is None else replace(trial, planner=Planned(**vars(trial.planner), made=plan))
            trains, plan, memory = now.humped(first, count)
            found.append(kept.told(trial, trains, memory))
        return tuple(found)


@dataclass(frozen=True)
class BatchOrder(Generic[T]):
    """Some trains of a group, and what is kept of them; `key` tells it from other orders."""

    key: str
    group: Group
    first: int
    count: int
    kept: Kept[T]


def answer_batch(order: BatchOrder[Any]) -> Answer:
    """Hump the trains of an order."""
    return answered(order, humped_batch)


def humped_batch(order: BatchOrder[T]) -> tuple[T, ...]:
    """What they come to in every trial."""
    from synth.kernels.cache import guarded

    return guarded(order.group.batch, order.first, order.count, order.kept)


def measured(groups: Sequence[Group], trains: int, workers: int, tell: Tell) -> dict[str, TrainOutcomes]:
    """The outcomes of every trial by its name, each on the trains 0 … `trains` − 1."""
    return measured_each([(group, trains) for group in groups], OUTCOMES, workers, tell)


def measured_each(
    groups: Sequence[tuple[Group, int]], kept: Kept[T], workers: int, tell: Tell, batch: int = BATCH
) -> dict[str, T]:
    """What is kept of every trial by its name, each on the trains 0 … n − 1, where n stands beside its group; `batch`
    trains at a time, which changes no result."""
    names = [name for group, _ in groups for name in group.trials]
    assert len(set(names)) == len(names), "each trial must have a name of its own"
    orders = [
        BatchOrder(f"{place}:{first}", group, first, min(batch, trains - first), kept)
        for place, (group, trains) in enumerate(groups)
        for first in range(0, trains, batch)
    ]
    found: dict[str, tuple[T, ...]] = {}
    for each in LocalWorkers(workers, answer_batch).answers(orders, lambda _: None):
        if each.result is None:
            raise RuntimeError(f"hump study: {each.reason}")
        found[each.key] = each.result
        tell(f"{len(found)} of {len(orders)} batches, {each.seconds:.0f} s")
    whole: dict[str, T] = {}
    for place, (group, trains) in enumerate(groups):
        parts = [found[f"{place}:{first}"] for first in range(0, trains, batch)]
        for k, name in enumerate(group.trials):
            whole[name] = kept.joined([part[k] for part in parts])
    return whole
