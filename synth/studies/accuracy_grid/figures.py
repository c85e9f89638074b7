"""Figures of one case of the grid, and the ratios that limits are stated for."""

from __future__ import annotations

from dataclasses import dataclass

from synth.simulation.replicates import Interval


@dataclass(frozen=True)
class Errors:
    """One controller on the common passes."""

    rms_m_s: float
    ci95_m_s: Interval
    switchings: float


@dataclass(frozen=True)
class Figures:
    """All controllers of a case that is served on the same passes; seconds to make a table, shared work in proportion.

    `told`, `told_estimated`: the references of the table and of the one with estimator; `ratio`: rms with estimator /
    without, paired; `finer`: the speed grid had to be halved, as `tune` advises.
    """

    table: Errors
    estimated: Errors
    baselines: dict[str, Errors]
    told: Errors
    told_estimated: Errors
    predicted_rms_m_s: float
    estimated_predicted_rms_m_s: float
    ratio: float
    ratio_ci95: Interval
    table_s: float
    estimated_s: float
    finer: bool = False

    @property
    def best_baseline(self) -> str:
        """The tuned classical law of least rms."""
        return min(self.baselines, key=lambda name: self.baselines[name].rms_m_s)

    @property
    def honesty(self) -> float:
        """Predicted / simulated rms of the table."""
        return self.predicted_rms_m_s / self.table.rms_m_s

    @property
    def honesty_estimated(self) -> float:
        """The same with the estimator."""
        return self.estimated_predicted_rms_m_s / self.estimated.rms_m_s

    @property
    def regret(self) -> float:
        """rms of the table / rms where the friction of every cut is told."""
        return self.table.rms_m_s / self.told.rms_m_s

    @property
    def regret_estimated(self) -> float:
        """The same with the estimator."""
        return self.estimated.rms_m_s / self.told_estimated.rms_m_s

    def gain(self, ours: Errors) -> float:
        """rms of the best baseline / rms."""
        return self.baselines[self.best_baseline].rms_m_s / ours.rms_m_s

    def more_switchings(self, ours: Errors) -> bool:
        """Whether there are more than by the best baseline."""
        return ours.switchings > self.baselines[self.best_baseline].switchings


@dataclass(frozen=True)
class GridCase:
    """One case of the grid; no figures where it is not `served`.

    `known_rms_m_s`: of the reference that is told the friction. A case is served if its interval reaches the limit.
    """

    case: str
    cv: float
    target_m_s: float
    served: bool
    known_rms_m_s: float
    figures: Figures | None
