"""What the simulated figures of one table say of the limits of [acceptance]: kept, missed, or not decidable."""

from __future__ import annotations

from dataclasses import dataclass

from synth.retarder.comparison.measured import prediction_ratio_of
from synth.retarder.configuration.settings import AcceptanceSettings
from synth.simulation.exit_statistics import ExitStatistics
from synth.simulation.replicates import Interval
from tuning_tables import Predicted


@dataclass(frozen=True)
class Judgement:
    """What the simulated passes of a table say of the limits, a phrase each; a limit in neither is kept.

    A limit is `missed` if the whole 95 % interval of the figure lies beyond it, and `undecided` if part of it does:
    these passes cannot tell.
    """

    missed: tuple[str, ...]
    undecided: tuple[str, ...]

    @property
    def word(self) -> str:
        """'accepted', 'missed' or 'not decidable'."""
        return "missed" if self.missed else "not decidable" if self.undecided else "accepted"

    @property
    def phrases(self) -> tuple[str, ...]:
        """What is missed, then what is undecided."""
        return self.missed + tuple(f"not decidable with these passes: {phrase}" for phrase in self.undecided)


def judgement(
    found: ExitStatistics, overspeed: tuple[float, Interval], predicted: Predicted, limits: AcceptanceSettings
) -> Judgement:
    """What the figures of a simulated table say of every limit; `overspeed`: share beyond target + margin."""
    honest, ratio_ci95 = prediction_ratio_of(predicted.rms_m_s, predicted.passes, found)
    low, high = limits.prediction_ratio_low, limits.prediction_ratio_high
    figures = (
        (found.rms_ci95_m_s, (0.0, limits.rms_m_s), f"{found.rms_text}, allowed {limits.rms_m_s:g}"),
        (overspeed[1], (0.0, limits.p_overspeed),
         f"over-speed in {share_text(overspeed)} of the cuts, allowed {limits.p_overspeed:.3%}"),
        (found.stalled_ci95, (0.0, limits.p_stall),
         f"stop in the position in {share_text((found.stalled, found.stalled_ci95))} of the cuts, "
         f"allowed {limits.p_stall:.3%}"),
        (found.time_ci95_s, (0.0, limits.time_s),
         f"{found.time_s:.2f} {interval_text(found.time_ci95_s, 2)} s in the position, allowed {limits.time_s:g}"),
        (found.switchings_ci95, (0.0, limits.switchings),
         f"{found.switchings:.2f} {interval_text(found.switchings_ci95, 2)} commands a cut, allowed "
         f"{limits.switchings:g}"),
        (ratio_ci95, (low, high),
         f"predicted / simulated rms {honest:.3f} {interval_text(ratio_ci95, 3)}, allowed {low:g} to {high:g}"),
    )  # fmt: skip
    missed, undecided = [], []
    for (least, most), (from_, to), phrase in figures:
        if not (least <= to and most >= from_):  # a figure that is no number misses
            missed.append(phrase)
        elif not (from_ <= least and most <= to):
            undecided.append(phrase)
    return Judgement(tuple(missed), tuple(undecided))


def interval_text(interval: Interval, digits: int = 4) -> str:
    """An interval in brackets."""
    return f"[{interval[0]:.{digits}f}, {interval[1]:.{digits}f}]"


def share_text(share: tuple[float, Interval]) -> str:
    """A share with its interval, in per cent."""
    value, (low, high) = share
    return f"{value:.3%} [{low:.3%}, {high:.3%}]"
