"""What is found of one case: its table, and the best of the tuned rules on the same passes."""

from __future__ import annotations

from dataclasses import dataclass

from scripts.studies.every_cut.random_case import RandomCase
from synth.simulation.replicates import Interval

ALLOWED_LOSS = 1.02
"""A table is worse than a rule if its rms is more than so many times the rule's, and the interval leaves no doubt."""

HONEST = (0.90, 1.10)
"""Predicted rms / simulated rms."""


@dataclass(frozen=True)
class Beside:
    """A tuned rule on the passes of the table; `ratio`: rms of the table / its own, paired, with its 95 % interval."""

    rule: str
    rms_m_s: float
    switchings: float
    ratio: float
    ratio_ci95: Interval

    @property
    def beaten_by(self) -> bool:
        """Whether the rule is better than the table."""
        return self.ratio > ALLOWED_LOSS and self.ratio_ci95[0] > 1.0


@dataclass(frozen=True)
class BesideWithout:
    """The table beside that of the same tune without estimator: rms / its rms, paired, with the 95 % interval.

    `ratio`: on the plant of the tables; `weak_ratio`: where all friction is 0.8 of it.
    """

    ratio: float
    ratio_ci95: Interval
    weak_ratio: float
    weak_ratio_ci95: Interval

    @property
    def worse(self) -> bool:
        """Whether the table is worse on one of the plants."""
        pairs = (self.ratio, self.ratio_ci95), (self.weak_ratio, self.weak_ratio_ci95)
        return any(ratio > ALLOWED_LOSS and ci95[0] > 1.0 for ratio, ci95 in pairs)


@dataclass(frozen=True)
class CutFigures:
    """The table of a case, simulated; `length_m`: path of a pass, from where the regulator acts to the exit.

    `designed_again`: the grid of the first design was not believed.
    `feasible`: the position does not forbid the limit on the rms. `best`: of all rules. `without`: no estimator.
    """

    case: RandomCase
    length_m: float
    rms_m_s: float
    rms_ci95_m_s: Interval
    predicted_rms_m_s: float
    designed_again: bool
    switchings: float
    feasible: bool
    best: Beside
    without: BesideWithout

    @property
    def prediction_ratio(self) -> float:
        """Predicted / simulated rms."""
        return self.predicted_rms_m_s / self.rms_m_s

    @property
    def prediction_ratio_ci95(self) -> Interval:
        """Its 95 % interval."""
        low, high = self.rms_ci95_m_s
        return self.predicted_rms_m_s / high, self.predicted_rms_m_s / low

    @property
    def honest(self) -> bool:
        """Whether the passes leave it open that the prediction is as near as asked."""
        low, high = self.prediction_ratio_ci95
        return low <= HONEST[1] and high >= HONEST[0]


@dataclass(frozen=True)
class Untuned:
    """A case that no table could be made for, and why."""

    case: RandomCase
    reason: str


Outcome = CutFigures | Untuned
