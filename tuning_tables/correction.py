"""On-line correction of the commanded speed from the last exits: its numbers, checked.

The rules are `programs.correct`: `usable_exit` judges a pass, `learn_exit` takes its exit, `corrected_speed` is asked.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import sqrt
from typing import Final

import numpy as np
import numpy.typing as npt

from tuning_tables.programs.correct import CORRECTION, CorrectionSetting
from tuning_tables.requirement import require_between

CERTAINTY: Final = 2.0
"""Standard deviations of b that are not believed: t = 2 spread √K."""

CLIP: Final = 3.0
"""Spreads at which an innovation is clipped: 0.3 % of normal exits are."""

LEAST_LIMIT_M_S, LARGEST_LIMIT_M_S = 0.01, 0.5


@dataclass(frozen=True)
class Correction:
    """How far and how fast the correction may go.

    limit_m_s       c never leaves ±limit, 0.01 to 0.5 m/s
    spread_m_s      standard deviation of a usable exit around its mean, with that of its measurement, 0.005 to 0.5 m/s
    memory_passes   1/K: how many passes the mean is taken over, 10 to 10 000
    step_m_s        most that one pass may change c by, 0.0001 to 0.1 m/s

    Derived, for the rules: `setting`. Raises `InvalidTable`.
    """

    limit_m_s: float = 0.15
    spread_m_s: float = 0.06
    memory_passes: float = 100.0
    step_m_s: float = 0.005
    setting: CorrectionSetting = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        require_between(self.limit_m_s, "correction.limit_m_s", LEAST_LIMIT_M_S, LARGEST_LIMIT_M_S)
        require_between(self.spread_m_s, "correction.spread_m_s", 0.005, 0.5)
        require_between(self.memory_passes, "correction.memory_passes", 10.0, 1e4)
        require_between(self.step_m_s, "correction.step_m_s", 1e-4, 0.1)
        limit, t = self.limit_m_s, self.threshold_m_s
        reach = 0.5 * (limit + sqrt(limit * limit + 4.0 * t * t))
        numbers = (self.gain, t * t, limit, reach, CLIP * self.spread_m_s, self.step_m_s)
        object.__setattr__(self, "setting", CorrectionSetting(*map(np.float32, numbers)))

    @property
    def gain(self) -> float:
        """K of the filter."""
        return 1.0 / self.memory_passes

    @property
    def threshold_m_s(self) -> float:
        """t: a mean error up to it changes nothing."""
        return CERTAINTY * self.spread_m_s * sqrt(self.gain)


def begun_correction() -> npt.NDArray[np.float32]:
    """The state of a position before its first pass, float32 (3,): no correction."""
    return np.zeros(len(CORRECTION.members), dtype=np.float32)
