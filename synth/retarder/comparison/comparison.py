"""What the table of a case is compared with, each closed loop by its role."""

from __future__ import annotations

import math
from dataclasses import dataclass

from synth.retarder.comparison.measured import UNKNOWN, Measured
from synth.simulation.replicates import Interval


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
