"""What differs from cut to cut in coarse passes: how fast cuts enter, as the configuration of a summary has it,
drawn in other ways than by the simulation; and their friction, in strata, half of it low, with the weights that
make up for that.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import accumulate, pairwise
from random import Random
from statistics import NormalDist
from typing import Final

MOST_TRIES = 10_000
"""Draws of a normal number until one falls between the limits."""


@dataclass(frozen=True)
class Uniform:
    """Any speed between the two, m/s."""

    low_m_s: float
    high_m_s: float

    def draw(self, random: Random) -> float:
        """A speed."""
        return self.low_m_s + (self.high_m_s - self.low_m_s) * random.random()


@dataclass(frozen=True)
class Normal:
    """Normal numbers, of which those outside the limits are drawn again, m/s."""

    low_m_s: float
    high_m_s: float
    mean_m_s: float
    std_m_s: float

    def draw(self, random: Random) -> float:
        """A speed."""
        for _ in range(MOST_TRIES):
            v = random.gauss(self.mean_m_s, self.std_m_s)
            if self.low_m_s <= v <= self.high_m_s:
                return v
        return min(max(self.mean_m_s, self.low_m_s), self.high_m_s)


@dataclass(frozen=True)
class Histogram:
    """A bin by its share, then any speed in it, m/s; bins without a share are never drawn."""

    edges_m_s: tuple[float, ...]
    shares: tuple[float, ...]

    @property
    def low_m_s(self) -> float:
        """Of all bins."""
        return self.edges_m_s[0]

    @property
    def high_m_s(self) -> float:
        """Of all bins."""
        return self.edges_m_s[-1]

    def draw(self, random: Random) -> float:
        """A speed."""
        bins = list(pairwise(self.edges_m_s))
        ((low, high),) = random.choices(bins, cum_weights=list(accumulate(self.shares)))
        return random.uniform(low, high)


Entry = Uniform | Normal | Histogram

Number = Callable[[str, float, float], float]
Numbers = Callable[[str, float, float], tuple[float, ...]]


def entry_of(keys: set[str], number: Number, numbers: Numbers) -> Entry | None:
    """The law that the `keys` of a table stand for, its values read by the two functions; None for no law."""
    if keys == {"low_m_s", "high_m_s"}:
        return Uniform(number("low_m_s", 0.01, 50.0), number("high_m_s", 0.01, 50.0))
    if keys == {"low_m_s", "high_m_s", "mean_m_s", "std_m_s"}:
        low, high = number("low_m_s", 0.01, 50.0), number("high_m_s", 0.01, 50.0)
        return Normal(low, high, number("mean_m_s", 0.01, 50.0), number("std_m_s", 1e-6, 50.0))
    if keys == {"edges_m_s", "shares"}:
        edges, shares = numbers("edges_m_s", 0.01, 50.0), numbers("shares", 0.0, 1e15)
        rising = all(b > a for a, b in pairwise(edges))
        return Histogram(edges, shares) if rising and len(edges) == len(shares) + 1 and math.fsum(shares) > 0 else None
    return None


GROUP: Final = 20
"""Passes that share the strata; groups are independent, and alike."""

CUTS: Final = NormalDist()
LOW: Final = NormalDist(-2.0, 1.5)
"""Law of the cuts' standard normal number, and that of the passes with low friction."""


@dataclass(frozen=True)
class FrictionNumber:
    """`normal`: ξ_cut = max(floor, 1 + CV·normal); `weight`: how many cuts the pass stands for, at most 2."""

    normal: float
    weight: float
    as_it_comes: bool


def friction_numbers(count: int, random: Random) -> list[FrictionNumber]:
    """One for each of `count` passes. A last group that is cut short is a random part of a whole one."""
    numbers: list[FrictionNumber] = []
    while len(numbers) < count:
        numbers += group(random)
    return numbers[:count]


def group(random: Random) -> list[FrictionNumber]:
    """One number from each stratum of equal probability of either law, in random order."""
    half = GROUP // 2
    drawn = []
    for law in (CUTS, LOW):
        for stratum in range(half):
            share = (stratum + random.random()) / half
            z = law.inv_cdf(min(max(share, 1e-16), 1.0 - 1e-16))
            weight = CUTS.pdf(z) / (0.5 * CUTS.pdf(z) + 0.5 * LOW.pdf(z))
            drawn.append(FrictionNumber(z, weight, law is CUTS))
    random.shuffle(drawn)
    return drawn
