"""What an exit speed costs: the one place that the sweep, the exact evaluation and the polish take it from.

A cost is a vector over the speeds of the grid. The expected cost is linear in it, so the gradient by the switching
lines (`solver.evaluation.Evaluation.gradient`) is exact for each of them, and none has to be smooth for its sake.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from plant_models.errors import require_between
from plant_models.frozen_arrays import Floats


class TerminalCost(Protocol):
    """Cost of leaving the position with a speed."""

    def at_exit(self, speed_m_s: Floats, target_speed_m_s: float) -> Floats:
        """Cost in m²/s² of the grid's exit speeds (E,), which are even in v²/2 and begin at 0, a stall."""
        ...

    @property
    def sentence(self) -> str:
        """What is minimised, in words."""
        ...


@dataclass(frozen=True)
class SquaredError:
    """(V_exit − V_target)²."""

    def at_exit(self, speed_m_s: Floats, target_speed_m_s: float) -> Floats:
        """See `TerminalCost`."""
        square: Floats = (speed_m_s - target_speed_m_s) ** 2
        return square

    @property
    def sentence(self) -> str:
        """See `TerminalCost`."""
        return "mean squared exit-speed error"


@dataclass(frozen=True)
class AsymmetricSquare:
    """(V_exit − V_target)² below the target, `overspeed_factor` times as much above it; smooth once at the target."""

    overspeed_factor: float

    def __post_init__(self) -> None:
        require_between("criterion: overspeed_factor", self.overspeed_factor, 0.01, 1000.0)

    def at_exit(self, speed_m_s: Floats, target_speed_m_s: float) -> Floats:
        """See `TerminalCost`."""
        error = speed_m_s - target_speed_m_s
        return np.where(error > 0.0, self.overspeed_factor, 1.0) * error**2

    @property
    def sentence(self) -> str:
        """See `TerminalCost`."""
        return f"mean squared exit-speed error, over-speed weighing {self.overspeed_factor:g} times"


@dataclass(frozen=True)
class PenalisedOverspeed:
    """(V_exit − V_target)² + `price_m2_s2`·[V_exit > V_target + `margin_m_s`], the Lagrangian of a chance constraint.

    The step is a ramp over the one cell that holds the limit, so that the expected cost is mean square + price × the
    mean of the ramp, exactly.
    """

    price_m2_s2: float
    margin_m_s: float

    def at_exit(self, speed_m_s: Floats, target_speed_m_s: float) -> Floats:
        """See `TerminalCost`."""
        above = share_above(speed_m_s, target_speed_m_s + self.margin_m_s)
        return (speed_m_s - target_speed_m_s) ** 2 + self.price_m2_s2 * above

    @property
    def sentence(self) -> str:
        """See `TerminalCost`."""
        return (
            f"mean squared exit-speed error and {self.price_m2_s2:g} m2/s2 for an exit above target + "
            f"{self.margin_m_s:g} m/s"
        )


def share_above(speed_m_s: Floats, limit_m_s: float) -> Floats:
    """Share (E,) of the cell of every grid speed that lies above `limit_m_s`; the grid is even in v²/2."""
    energy = 0.5 * speed_m_s**2
    step = energy[1] - energy[0]
    above: Floats = np.clip((energy - 0.5 * limit_m_s**2) / step + 0.5, 0.0, 1.0)
    return above
