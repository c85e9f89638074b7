"""The error at the exit that no regulator of a position avoids: a bound of every rms from below."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Floats
from synth.simulation.passes import ExitSample
from synth.simulation.replicates import Interval, rms_of


@dataclass(frozen=True)
class UnavoidableError:
    """Rms, over all cuts, of what they leave too fast by when slowest and too slow by when fastest; 95 % interval.

    `too_fast`: more of its mean square is from cuts that leave too fast than from those that leave too slow. No rms of
    the same passes is less, whatever regulator has them.
    """

    rms_m_s: float
    rms_ci95_m_s: Interval
    too_fast: bool

    @property
    def obstacle(self) -> str:
        """What stands in the way where it is too large, in three words."""
        return "brake saturated" if self.too_fast else "leaves too slow"

    def forbids(self, limit_m_s: float) -> bool:
        """No regulator keeps the rms `limit_m_s`: the whole interval is above it."""
        return self.rms_ci95_m_s[0] > limit_m_s

    def undecided(self, limit_m_s: float) -> bool:
        """The passes cannot tell whether it forbids `limit_m_s`: the interval holds that limit."""
        return self.rms_ci95_m_s[0] <= limit_m_s < self.rms_ci95_m_s[1]


def unavoidable_error(slowest: ExitSample, fastest: ExitSample, target_m_s: float) -> UnavoidableError:
    """The error that remains of passes that can leave no slower than in `slowest` and no faster than in `fastest`."""
    excess, lack = excess_and_lack_m_s(slowest, fastest, target_m_s)
    too_fast = float(slowest.weight @ excess**2) >= float(slowest.weight @ lack**2)
    return UnavoidableError(*rms_of(excess + lack, slowest.weight), too_fast)


def excess_and_lack_m_s(slowest: ExitSample, fastest: ExitSample, target_m_s: float) -> tuple[Floats, Floats]:
    """What each pass (n,) leaves too fast by at the least, and too slow by; of a pass one at most is above 0."""
    excess = np.maximum(slowest.exit_speed_m_s - target_m_s, 0.0)
    return excess, np.maximum(target_m_s - fastest.exit_speed_m_s, 0.0)
