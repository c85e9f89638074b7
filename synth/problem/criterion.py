"""What the lines are optimised for: the cost of a pass, and what the exported lines must keep besides."""

from __future__ import annotations

from dataclasses import dataclass, replace

from plant_models.errors import require, require_between
from plant_models.frozen_arrays import Floats
from synth.problem.requirement import Requirement
from synth.problem.terminal_cost import SquaredError, TerminalCost

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
