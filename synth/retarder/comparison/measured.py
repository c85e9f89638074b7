"""What controllers are compared by; plain values, no kernel behind them."""

from __future__ import annotations

import math
from dataclasses import dataclass

from synth.simulation.exit_statistics import ExitStatistics
from synth.simulation.replicates import Interval

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
