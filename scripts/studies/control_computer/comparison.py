"""A formula beside a simulation, and how far apart both may be where many such pairs are judged together."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, replace

CONFIDENCE = 0.95
FEWEST_EVENTS = 100
"""A share that was seen less often has no interval that is to be trusted; it is judged by no one."""


@dataclass(frozen=True)
class Comparison:
    """`formula` with its own `error`, and what was `simulated` with half the width of its 95 % interval.

    `freedom`: of Student's law of that interval, 0 for the normal law. `count`: what the simulation has counted.
    `told`: whether its interval is to be trusted. `limit`: the largest distance that is allowed, None until
    `judged` with the others.
    """

    what: str
    formula: float
    error: float
    simulated: float
    half_width: float
    freedom: int
    count: int
    told: bool = True
    limit: float | None = None

    @property
    def distance(self) -> float:
        """Of the formula from the simulation."""
        return abs(self.formula - self.simulated)

    @property
    def in_own_interval(self) -> bool:
        """Whether the 95 % interval of this pair alone holds the formula."""
        return self.distance <= self.half_width + self.error

    @property
    def outside(self) -> bool:
        """Whether they are further apart than the number of comparisons allows."""
        return self.told and self.limit is not None and self.distance > self.limit

    @property
    def sentence(self) -> str:
        """What is wrong."""
        return (
            f"{self.what}: the formula tells {self.formula:.6g}, the simulation {self.simulated:.6g}; they are "
            f"{self.distance:.2g} apart, and all comparisons together allow {self.limit or 0.0:.2g}"
        )


def joint_factor(freedom: int, comparisons: int) -> float:
    """How many half widths of 95 % make an interval that holds with 95 % for all `comparisons` at once (Bonferroni)."""
    from scipy.stats import norm, t

    law = t(freedom) if freedom else norm
    tail = 0.5 * (1.0 - CONFIDENCE)
    return float(law.isf(tail / comparisons) / law.isf(tail))


def judged(comparisons: Iterable[Comparison]) -> tuple[Comparison, ...]:
    """The same with their joint limits; those that are not `told` do not count."""
    found = tuple(comparisons)
    count = sum(each.told for each in found)
    return tuple(with_limit(each, count) for each in found)


def with_limit(each: Comparison, comparisons: int) -> Comparison:
    """`each` as one of so many."""
    if not each.told:
        return each
    return replace(each, limit=joint_factor(each.freedom, comparisons) * each.half_width + each.error)


def verdict(found: Iterable[Comparison]) -> tuple[int, int, int]:
    """How many are told, lie in their own interval, lie outside the joint limit."""
    told = [each for each in found if each.told]
    return len(told), sum(each.in_own_interval for each in told), sum(each.outside for each in told)
