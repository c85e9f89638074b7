"""A task that requests call up at random times, and the mix of tasks that one computer serves."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import groupby

from plant_models.errors import require
from synth.computer.sizing.service_law import ServiceLaw


@dataclass(frozen=True)
class Task:
    """Requests come as a Poisson stream of `rate_per_s`; each asks for a random number of `operations`.

    `priority`: 1 is the most urgent. `deadline_s`: how long after its request it should be done, None if nobody asks.
    """

    name: str
    rate_per_s: float
    operations: ServiceLaw
    priority: int = 1
    deadline_s: float | None = None

    @property
    def operations_per_s(self) -> float:
        """What it asks for in the mean."""
        return self.rate_per_s * self.operations.mean


@dataclass(frozen=True)
class Stream:
    """A task on a computer of known speed: Poisson requests of `rate_per_s`, and the law of their `service` in s."""

    name: str
    rate_per_s: float
    service: ServiceLaw
    priority: int

    @property
    def load(self) -> float:
        """ρ_i = λ_i E[S_i]: the share of the time that it takes."""
        return self.rate_per_s * self.service.mean

    @property
    def residual_s(self) -> float:
        """λ_i E[S_i²] / 2: the mean work that a request finds in a service of this stream, s."""
        return 0.5 * self.rate_per_s * self.service.second_moment


@dataclass(frozen=True)
class TaskMix:
    """The tasks of one computer; at least one. `PlantError` for a name that is given twice."""

    tasks: tuple[Task, ...]

    def __post_init__(self) -> None:
        names = [task.name for task in self.tasks]
        twice = sorted({name for name in names if names.count(name) > 1})
        require(not twice, f"task mix: {', '.join(twice)} is given twice; names must be unique")

    @property
    def operations_per_s(self) -> float:
        """Σ λ_i L_i: the speed at which the computer would have no time left."""
        return sum(task.operations_per_s for task in self.tasks)

    def streams(self, speed_op_s: float) -> tuple[Stream, ...]:
        """The tasks, in order, on a computer of `speed_op_s`."""
        return tuple(
            Stream(task.name, task.rate_per_s, task.operations.scaled(1.0 / speed_op_s), task.priority)
            for task in self.tasks
        )


def by_priority(streams: tuple[Stream, ...]) -> dict[int, tuple[Stream, ...]]:
    """The streams of each priority, the most urgent first: those of one priority are one class of the queue."""
    ordered = sorted(streams, key=lambda stream: stream.priority)
    return {priority: tuple(each) for priority, each in groupby(ordered, key=lambda stream: stream.priority)}


def total_load(streams: tuple[Stream, ...]) -> float:
    """ρ: the share of the time that the streams take together."""
    return math.fsum(stream.load for stream in streams)


def require_not_overloaded(streams: tuple[Stream, ...]) -> None:
    """Raise `PlantError`, which tells by how much, unless ρ < 1."""
    load = total_load(streams)
    require(
        load < 1.0,
        f"the computer is overloaded: its tasks take {load:.6g} of its time, {100.0 * (load - 1.0):.4g} % more than "
        "there is; it must be less than 1, or requests wait for ever",
    )
