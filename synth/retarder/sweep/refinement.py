"""Fewest tables for a stated loss: start with coarse targets, bisect where lines between two tables lose too much."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Generic, TypeVar

from synth.retarder.sweep.plan import Refinement

ROUNDING = 1e-9

Table = TypeVar("Table")


@dataclass(frozen=True)
class Gap:
    """Between two targets: rms at the middle with its own table and with the lines between, exactly predicted.

    `refined`: the loss was too large, and the table at the middle is kept.
    """

    low_m_s: float
    high_m_s: float
    own_rms_m_s: float
    between_rms_m_s: float
    refined: bool

    @property
    def middle_m_s(self) -> float:
        """Where it was measured: where lines between two are farthest from both."""
        return 0.5 * (self.low_m_s + self.high_m_s)

    @property
    def loss_m_s(self) -> float:
        """How much the lines between lose; below 0 where they are better than the table's own."""
        return self.between_rms_m_s - self.own_rms_m_s


@dataclass(frozen=True)
class Bench(Generic[Table]):
    """What refining needs: `tune` makes tables for targets, the rms of one at its target, of lines between two."""

    tune: Callable[[Sequence[float]], list[Table]]
    own_rms_m_s: Callable[[Table], float]
    between_rms_m_s: Callable[[Table, Table, float], float]


def refined(
    targets_m_s: Sequence[float], bench: Bench[Table], wanted: Refinement
) -> tuple[list[Table], tuple[Gap, ...]]:
    """Tables by rising target, and every gap that was measured, by rising middle.

    All `targets_m_s` are kept. A gap is split while its loss exceeds the one wanted and its halves are no shorter than
    the smallest step. Every gap left has been measured, so that the loss of the book is known where it is too large.
    """
    rising = sorted(targets_m_s)
    kept = dict(zip(rising, bench.tune(rising), strict=True))
    measured: list[Gap] = []
    open_gaps = list(pairwise(rising))
    while open_gaps:
        middles = [0.5 * (low + high) for low, high in open_gaps]
        found = [
            measured_gap(low, high, kept[low], own, kept[high], bench, wanted)
            for (low, high), own in zip(open_gaps, bench.tune(middles), strict=True)
        ]
        measured += [gap for gap, _ in found]
        kept |= {gap.middle_m_s: own for gap, own in found if gap.refined}
        open_gaps = [
            half
            for gap, _ in found
            if gap.refined
            for half in ((gap.low_m_s, gap.middle_m_s), (gap.middle_m_s, gap.high_m_s))
        ]
    ordered = tuple(sorted(measured, key=lambda gap: gap.middle_m_s))
    return [kept[target] for target in sorted(kept)], ordered


def measured_gap(
    low_m_s: float, high_m_s: float, slower: Table, own: Table, faster: Table, bench: Bench[Table], wanted: Refinement
) -> tuple[Gap, Table]:
    """One gap measured, with the table tuned for its middle."""
    middle, half = 0.5 * (low_m_s + high_m_s), 0.5 * (high_m_s - low_m_s)
    best, between = bench.own_rms_m_s(own), bench.between_rms_m_s(slower, faster, middle)
    too_much = between - best > wanted.loss_m_s
    return Gap(low_m_s, high_m_s, best, between, too_much and half >= wanted.smallest_step_m_s - ROUNDING), own
