"""What a policy may have to keep besides its mean cost, and what it took to keep it; plain values, no kernel.

How it is found stands in `solver.kept_requirement`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from plant_models.errors import require, require_between
from plant_models.frozen_arrays import Floats


@dataclass(frozen=True)
class OverspeedLimit:
    """P(V_exit > V_target + `margin_m_s`) ≤ `highest_probability`, as predicted for the exported lines."""

    margin_m_s: float
    highest_probability: float

    def __post_init__(self) -> None:
        require_between("criterion: overspeed_margin_m_s", self.margin_m_s, 0.01, 5.0)
        require_between("criterion: p_overspeed", self.highest_probability, 1e-4, 1.0)

    @property
    def sentence(self) -> str:
        """What is minimised, in words."""
        return (
            "mean squared exit-speed error, with a probability of leaving faster than target + "
            f"{self.margin_m_s:g} m/s of at most {self.highest_probability:g}"
        )


@dataclass(frozen=True)
class FrictionRange:
    """The largest mean cost over every friction factor ξ_cut from `low` to `high` counts, not the mean over its law."""

    low: float
    high: float

    def __post_init__(self) -> None:
        require_between("criterion: worst_friction_low", self.low, 0.05, 5.0)
        require_between("criterion: worst_friction_high", self.high, 0.05, 5.0)
        require(
            self.low < self.high,
            f"criterion: worst_friction_low is {self.low!r}; it must be below worst_friction_high = {self.high:g}",
        )

    def factors(self, count: int) -> Floats:
        """`count` equally spaced friction factors, both ends included."""
        return np.linspace(self.low, self.high, count)

    @property
    def sentence(self) -> str:
        """What is minimised, in words."""
        return (
            "the largest mean squared exit-speed error over every friction factor of the cut from "
            f"{self.low:g} to {self.high:g}"
        )


Requirement = OverspeedLimit | FrictionRange
"""One of them, or none."""


CERTIFIED_GAP = 0.02
"""Relative gap in cost up to which the result is called optimal (1 % of the rms)."""


@dataclass(frozen=True)
class OverspeedLimitFound:
    """What keeping an over-speed limit took.

    `multiplier_m2_s2`: price of an over-speed exit, 0 if the limit is kept without one; `probability` and `rms_m_s`
    predicted for the lines, `…_without` for the lines of least mean square; `met`: the limit is kept. Where it is not,
    the lines are those of the least probability found.
    """

    limit: OverspeedLimit
    multiplier_m2_s2: float
    probability: float
    probability_without: float
    rms_m_s: float
    rms_without_m_s: float
    met: bool
    rounds: int

    @property
    def sentence(self) -> str:
        """What came of it."""
        event, limit = f"P(exit > target + {self.limit.margin_m_s:g} m/s)", self.limit.highest_probability
        if not self.met:
            return (
                f"{event} cannot be brought to {limit:g}: no multiplier up to {self.multiplier_m2_s2:.3g} m2/s2 "
                f"suffices, the least found is {self.probability:.4f} at rms {self.rms_m_s:.4f} m/s"
            )
        if self.multiplier_m2_s2 == 0.0:
            return f"{event} is {self.probability:.4f} without a price and keeps {limit:g}: the limit is not active"
        return (
            f"{event} goes from {self.probability_without:.4f} to {self.probability:.4f} (limit {limit:g}) at a "
            f"multiplier of {self.multiplier_m2_s2:.3g} m2/s2; predicted rms {self.rms_without_m_s:.4f} to "
            f"{self.rms_m_s:.4f} m/s"
        )


@dataclass(frozen=True)
class WorstCaseFound:
    """What guarding against the worst friction took; every rms is predicted on the check grid.

    `worst_rms_m_s`: the largest over equally spaced factors of the range, `worst_factor` where; `rms_m_s`: over the
    law of friction; `…_without`: the lines of least mean square. `factors`, `weights`: the scenarios optimised over and
    their dual weights; `gap`: (largest cost − lower bound)/largest cost; both NaN if nothing better was found.
    """

    friction: FrictionRange
    worst_rms_m_s: float
    worst_rms_without_m_s: float
    worst_factor: float
    rms_m_s: float
    rms_without_m_s: float
    factors: tuple[float, ...]
    weights: tuple[float, ...]
    gap: float

    @property
    def certified(self) -> bool:
        """Whether the gap is within `CERTIFIED_GAP`."""
        return self.gap <= CERTIFIED_GAP

    @property
    def sentence(self) -> str:
        """What came of it."""
        if math.isnan(self.gap):
            return (
                f"no lines found whose predicted rms at the worst friction factor from {self.friction.low:g} to "
                f"{self.friction.high:g} is below the {self.worst_rms_without_m_s:.4f} m/s of the least mean square"
            )
        end = "" if self.certified else f", more than {CERTIFIED_GAP:.0%}: better lines may exist"
        return (
            f"predicted rms at the worst friction factor from {self.friction.low:g} to {self.friction.high:g} goes "
            f"from {self.worst_rms_without_m_s:.4f} to {self.worst_rms_m_s:.4f} m/s (at {self.worst_factor:g}); over "
            f"the law of friction it goes from {self.rms_without_m_s:.4f} to {self.rms_m_s:.4f} m/s; duality gap "
            f"{self.gap:.1%} of the largest cost{end}"
        )


Finding = OverspeedLimitFound | WorstCaseFound
"""One of them."""
