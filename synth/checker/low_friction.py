"""The friction of the cuts in coarse passes: in strata, half of it low, with the weights that make up for that."""

from __future__ import annotations

from dataclasses import dataclass
from random import Random
from statistics import NormalDist
from typing import Final

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
