"""Tasks that requests call up at random times, the laws of the amount of service that each needs, in operations or
in seconds, and the mix of tasks that one computer serves.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import groupby
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from plant_models.errors import require
from plant_models.frozen_arrays import Floats

Complexes = NDArray[np.complex128]


class ServiceLaw(Protocol):
    """The law of an amount X > 0: its mean E[X], its second moment E[X²], its transform E[e^(−sX)], and draws."""

    @property
    def mean(self) -> float:
        """E[X]."""

    @property
    def second_moment(self) -> float:
        """E[X²]."""

    def transform(self, s: Complexes) -> Complexes:
        """E[e^(−sX)] for each s with Re s ≥ 0, in the same shape; s has the inverse unit of X."""

    def draw(self, rng: np.random.Generator, count: int) -> Floats:
        """`count` independent amounts, (count,)."""

    def scaled(self, factor: float) -> ServiceLaw:
        """The law of `factor` · X: with 1 / (operations a second) operations become seconds."""


@dataclass(frozen=True)
class Constant:
    """Always `mean`."""

    mean: float

    @property
    def second_moment(self) -> float:
        """mean²."""
        return self.mean**2

    def transform(self, s: Complexes) -> Complexes:
        """e^(−s·mean)."""
        return np.exp(-s * self.mean)

    def draw(self, rng: np.random.Generator, count: int) -> Floats:
        """`mean`, `count` times; nothing is drawn from `rng`."""
        return np.full(count, self.mean)

    def scaled(self, factor: float) -> Constant:
        """Always `factor` · `mean`."""
        return Constant(factor * self.mean)


@dataclass(frozen=True)
class Erlang:
    """The sum of `stages` independent exponential parts of equal mean: squared coefficient of variation 1 / stages."""

    mean: float
    stages: int

    @property
    def second_moment(self) -> float:
        """mean² · (1 + 1 / stages)."""
        return self.mean**2 * (1.0 + 1.0 / self.stages)

    def transform(self, s: Complexes) -> Complexes:
        """(1 + s·mean / stages)^(−stages)."""
        return (1.0 + s * (self.mean / self.stages)) ** -self.stages

    def draw(self, rng: np.random.Generator, count: int) -> Floats:
        """Gamma variates of shape `stages`."""
        return rng.gamma(self.stages, self.mean / self.stages, count)

    def scaled(self, factor: float) -> Erlang:
        """The same number of stages, each `factor` times as long."""
        return Erlang(factor * self.mean, self.stages)


@dataclass(frozen=True)
class Exponential:
    """Exponential, of this mean: squared coefficient of variation 1."""

    mean: float

    @property
    def second_moment(self) -> float:
        """2 · mean²."""
        return 2.0 * self.mean**2

    def transform(self, s: Complexes) -> Complexes:
        """1 / (1 + s·mean)."""
        return 1.0 / (1.0 + s * self.mean)

    def draw(self, rng: np.random.Generator, count: int) -> Floats:
        """Exponential variates."""
        return rng.exponential(self.mean, count)

    def scaled(self, factor: float) -> Exponential:
        """Exponential of `factor` · `mean`."""
        return Exponential(factor * self.mean)


@dataclass(frozen=True)
class Hyperexponential:
    """One of two exponentials, short or long, with `mean` and `squared_cv` above 1 in all.

    Two moments leave one number of the law open. It is fixed by balanced means: the short and the long ones bring
    half of the mean each, p₁ m₁ = p₂ m₂ = mean / 2, so p₁ = (1 + √((c² − 1)/(c² + 1))) / 2 (Tijms, A First Course in
    Stochastic Models, 2003, appendix B).
    """

    mean: float
    squared_cv: float

    def __post_init__(self) -> None:
        require(
            math.isfinite(self.squared_cv) and self.squared_cv > 1.0,
            f"service law: squared_cv is {self.squared_cv!r}; a hyperexponential law needs a finite number above 1",
        )

    @property
    def short_share(self) -> float:
        """p₁: how often it is the short one."""
        return 0.5 * (1.0 + math.sqrt((self.squared_cv - 1.0) / (self.squared_cv + 1.0)))

    @property
    def part_means(self) -> tuple[float, float]:
        """(m₁, m₂): of the short ones, of the long ones."""
        return self.mean / (2.0 * self.short_share), self.mean / (2.0 * (1.0 - self.short_share))

    @property
    def second_moment(self) -> float:
        """mean² · (1 + squared_cv), which is 2 p₁ m₁² + 2 p₂ m₂²."""
        return self.mean**2 * (1.0 + self.squared_cv)

    def transform(self, s: Complexes) -> Complexes:
        """p₁ / (1 + s m₁) + p₂ / (1 + s m₂)."""
        short, long = self.part_means
        return self.short_share / (1.0 + s * short) + (1.0 - self.short_share) / (1.0 + s * long)

    def draw(self, rng: np.random.Generator, count: int) -> Floats:
        """An exponential variate times the mean of the part that a uniform one picks."""
        short, long = self.part_means
        return rng.exponential(1.0, count) * np.where(rng.random(count) < self.short_share, short, long)

    def scaled(self, factor: float) -> Hyperexponential:
        """The same `squared_cv`, `factor` times the mean."""
        return Hyperexponential(factor * self.mean, self.squared_cv)


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
