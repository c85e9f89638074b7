"""Whether the brake of a position is strong enough for the cuts of a trial."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from synth.frame.interval import Interval
from synth.hump.trains.outcomes import TrainOutcomes
from synth.hump.trains.shift_sums import shift_sums
from synth.hump.trains.train_figures import interval_of, share

MOST_SHORT: Final = 0.01
"""A position with a larger share of cuts that left too fast for want of brake is too weak for them: assumed."""


@dataclass(frozen=True)
class PositionStrength:
    """Share of the passes of position `number` that ended faster than commanded for want of brake, with its interval;
    NaN where there was no pass."""

    number: int
    share: float
    low95: float
    high95: float
    passes: int

    @property
    def weak(self) -> bool:
        """For sure above the limit."""
        return self.low95 > MOST_SHORT

    @property
    def told(self) -> Interval | float:
        """The share as it is shown."""
        return interval_of(self.share, self.low95, self.high95, self.passes)


def strengths(found: TrainOutcomes) -> Iterator[PositionStrength]:
    """Of all positions, in order from the crest."""
    for place in range(found.passes.shape[1]):
        short, passes = (shift_sums(found, each[:, place]) for each in (found.short, found.passes))
        value, low, high, _ = share(short, passes)
        yield PositionStrength(place + 1, value, low, high, int(passes.sum()))
