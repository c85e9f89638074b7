"""What a policy may have to keep besides its mean cost; how it is found stands in `chance_constraint`, `worst_case`."""

from __future__ import annotations

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
