"""What controllers are compared by, and what their figures say of the limits of [acceptance]: kept, missed, or not
decidable. Plain values, no kernel behind them.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from synth.simulation.exit_statistics import ExitStatistics
from synth.simulation.replicates import Interval
from tuning_tables import Predicted

if TYPE_CHECKING:  # pydantic is nothing for a process that draws
    from synth.retarder.configuration.settings import AcceptanceSettings

UNKNOWN: Interval = (math.nan, math.nan)


@dataclass(frozen=True)
class Measured:
    """One controller's closed-loop result; `predicted_rms_m_s` where a prediction exists, else NaN.

    `predicted_passes`: simulated passes behind the prediction, None for an exact one. `table_ratio`: rms of the
    exported table / rms of this controller, with its 95 % interval; NaN where it was not asked for.
    """

    name: str
    statistics: ExitStatistics
    predicted_rms_m_s: float = math.nan
    predicted_passes: int | None = None
    table_ratio: float = math.nan
    table_ratio_ci95: Interval = UNKNOWN

    def __repr__(self) -> str:
        below, above = self.table_ratio_ci95
        ratio = (
            "" if math.isnan(self.table_ratio) else f", table/this {self.table_ratio:.3f} [{below:.3f}, {above:.3f}]"
        )
        return f"Measured({self.name}: {self.statistics.rms_text}{ratio})"

    @property
    def prediction_ratio(self) -> float:
        """Predicted rms / simulated rms; NaN where nothing was predicted."""
        return self._ratio_of_predicted[0]

    @property
    def prediction_ratio_ci95(self) -> Interval:
        """The 95 % interval of `prediction_ratio`."""
        return self._ratio_of_predicted[1]

    @property
    def _ratio_of_predicted(self) -> tuple[float, Interval]:
        return prediction_ratio_of(self.predicted_rms_m_s, self.predicted_passes, self.statistics)


def prediction_ratio_of(
    predicted_rms_m_s: float, predicted_passes: int | None, found: ExitStatistics
) -> tuple[float, Interval]:
    """Predicted / simulated rms, and its 95 % interval; NaN where no pass had an error.

    A prediction that was itself simulated is as uncertain as so many passes of the same design make it.
    """
    if not found.rms_ci95_m_s[0] > 0.0:
        return math.nan, UNKNOWN
    of_log = log_half_width(found)
    if predicted_passes is not None:
        of_log *= math.sqrt(1.0 + found.passes / predicted_passes)
    honest = predicted_rms_m_s / found.rms_m_s
    return honest, (honest * math.exp(-of_log), honest * math.exp(of_log))


def log_half_width(found: ExitStatistics) -> float:
    """Half the 95 % interval of log(rms)."""
    low, high = found.rms_ci95_m_s
    return 0.5 * math.log(high / low)


@dataclass(frozen=True)
class Comparison:
    """What our table is compared with, all on the passes that it had.

    `friction_known`: the same kind of regulator, told the friction of every cut; `baselines`: tuned classical laws;
    `baseline_ratio_ci95`: of rms of the friction-known regulator / rms of the best of them, paired, NaN without any;
    `at_rest`: where commands come at any time, the lines that the same tune makes for commands at rest.
    """

    friction_known: Measured
    baselines: tuple[Measured, ...]
    baseline_ratio_ci95: Interval = UNKNOWN
    at_rest: Measured | None = None

    @property
    def entries(self) -> tuple[Measured, ...]:
        """All of them: the baselines last but for lines at rest."""
        at_rest = () if self.at_rest is None else (self.at_rest,)
        return (self.friction_known, *self.baselines, *at_rest)

    @property
    def best_baseline(self) -> Measured | None:
        """The baseline of least rms, None if there is none."""
        return min(self.baselines, key=lambda entry: entry.statistics.rms_m_s, default=None)

    @property
    def has_reference(self) -> bool:
        """Nothing that is not told the friction beats the friction-known regulator beyond chance."""
        beaten_by_baseline = self.baseline_ratio_ci95[0] > 1.0
        beaten_by_table = self.friction_known.table_ratio_ci95[1] < 1.0
        return not (beaten_by_baseline or beaten_by_table)

    @property
    def regret(self) -> float:
        """rms of the table / rms of the friction-known regulator; NaN where that is no reference."""
        return self.friction_known.table_ratio if self.has_reference else math.nan

    @property
    def regret_ci95(self) -> Interval:
        """The 95 % interval of `regret`."""
        return self.friction_known.table_ratio_ci95 if self.has_reference else UNKNOWN


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
