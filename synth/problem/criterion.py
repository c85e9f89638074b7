"""What the lines are optimised for: what an exit speed and a pass cost, and what exported lines must keep besides.

A cost of exit speeds is a vector over the speeds of the grid, and this is the one place that the sweep, the exact
evaluation and the polish take it from. The expected cost is linear in it, so the gradient by the switching lines
(`solver.evaluation.Evaluation.gradient`) is exact for each of them, and none has to be smooth for its sake.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from plant_models.errors import require, require_between
from plant_models.frozen_arrays import Floats
from synth.problem.requirement import Requirement


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


SQUARED_ERROR = SquaredError()


@dataclass(frozen=True)
class Criterion:
    """What a pass costs, and what the exported lines must keep besides.

    Parameters
    ----------
    stall_cost_m2_s2
        Cost of a stall in the position, m²/s².
    switching_tolerance_m2_s2
        A change of stage must gain more than this, m²/s², else hold wins: commands whose costs differ by less count as
        equal, and of these the one with the fewest switchings is taken.
    time_price_m2_s3
        Cost of each second from where the regulator acts to the exit, m²/s³.
    terminal
        Cost of the exit speed.
    requirement
        What the exported lines must keep besides; only with the squared error.

    Raises
    ------
    PlantError
        A number out of range, or a requirement with another terminal cost.

    Examples
    --------
    >>> import synth
    >>> synth.Criterion(stall_cost_m2_s2=4.0).sentence
    'mean squared exit-speed error'
    """

    stall_cost_m2_s2: float = 1.0
    switching_tolerance_m2_s2: float = 3e-5
    time_price_m2_s3: float = 0.0
    terminal: TerminalCost = SQUARED_ERROR
    requirement: Requirement | None = None

    def __post_init__(self) -> None:
        require_between("criterion: stall_cost_m2_s2", self.stall_cost_m2_s2, 0.0, 1e4)
        require_between("criterion: switching_tolerance_m2_s2", self.switching_tolerance_m2_s2, 0.0, 1.0)
        require_between("criterion: time_price_m2_s3", self.time_price_m2_s3, 0.0, 1.0)
        require(
            self.requirement is None or self.terminal == SQUARED_ERROR,
            "criterion: a chance constraint or a worst case goes with the squared error only; leave out one of the two",
        )

    def exit_costs(self, speed_m_s: Floats, target_speed_m_s: float) -> tuple[Floats, float]:
        """What exits cost.

        Parameters
        ----------
        speed_m_s
            Exit speeds, m/s, (E,), the first one 0.
        target_speed_m_s
            The commanded exit speed, m/s.

        Returns
        -------
        tuple of ndarray and float
            Cost of leaving with each speed, m²/s², (E,); cost of a stall, that of exit speed 0 and the stall cost.
        """
        terminal = self.terminal.at_exit(speed_m_s, target_speed_m_s)
        return terminal, float(terminal[0]) + self.stall_cost_m2_s2

    def squared(self) -> Criterion:
        """The same prices with the squared error and no requirement: what references are measured by."""
        return replace(self, terminal=SQUARED_ERROR, requirement=None)

    @property
    def sentence(self) -> str:
        """What is minimised, in words."""
        return self.terminal.sentence if self.requirement is None else self.requirement.sentence


SQUARED_ERROR_CRITERION = Criterion()
"""The default."""
