"""Whether the brake of a position is strong enough for the cuts of a trial."""

from __future__ import annotations

from typing import Final

from synth.hump.trains.outcomes import TrainOutcomes
from synth.hump.trains.shift_sums import shift_sums
from synth.hump.trains.train_figures import TrainFigure, share

MOST_SHORT: Final = 0.01
"""A position with a larger share of cuts that left too fast for want of brake is too weak for them: assumed."""


def weak(short: TrainFigure) -> bool:
    """Whether the share is for sure above the limit."""
    return short.low95 > MOST_SHORT


def strengths(found: TrainOutcomes) -> tuple[TrainFigure, ...]:
    """Of all positions, in order from the crest: the share of the passes that ended faster than commanded for want of
    brake; NaN where there was no pass."""
    sums = (
        [shift_sums(found, each[:, place]) for each in (found.short, found.passes)]
        for place in range(found.passes.shape[1])
    )
    return tuple(TrainFigure("short", "1", *share(short, passes)[:3], int(passes.sum())) for short, passes in sums)
