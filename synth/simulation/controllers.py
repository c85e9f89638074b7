"""Regulators as the closed loop runs them: an exported table, or switching lines."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from synth.kernels.any_time.any_time_law import AnyTimeLaw
from synth.kernels.loop import regulator
from synth.solver.switching_lines import SwitchingLines, always_up
from tuning_tables.active_table import ActiveTable
from tuning_tables.decisions import Decisions
from tuning_tables.estimator import Estimator
from tuning_tables.held_table import lines_apart
from tuning_tables.stage import MOST_STAGES
from tuning_tables.table import ControllerTable

Scalar = TypeVar("Scalar", bound=np.generic)
Values = TypeVar("Values", bound=tuple[Any, ...])

Law = regulator.Rule | AnyTimeLaw


def fixed(array: NDArray[Any], dtype: type[Scalar]) -> NDArray[Scalar]:
    """Contiguous read-only view or copy: the kernel is compiled for exactly such arrays, once."""
    view: NDArray[Scalar] = np.ascontiguousarray(array, dtype=dtype).view()
    view.setflags(write=False)
    return view


def all_fixed(values: Values) -> Values:
    """A named tuple with every array `fixed`: one that was unpickled, or made by somebody else, is not."""
    held = (fixed(each, each.dtype.type) if isinstance(each, np.ndarray) else each for each in values)
    return type(values)(*held)


@dataclass(frozen=True)
class TableController:
    """A regulator that runs an exported table, or lines chosen from a book, with the tables' own rule.

    If the table has an estimator, the rule is asked with the estimated speed. The gauge of a table with slopes shows
    `gauge_factor` times the true pressure; NaN: it shows none.
    """

    table: ControllerTable | ActiveTable
    gauge_factor: float = 1.0

    @property
    def stages(self) -> int:
        """Number of stages K + 1."""
        return int(self.table.coefficients.shape[0])

    def law(self) -> Law:
        """The rule as the kernel takes it."""
        return self.rule if self.table.decisions is Decisions.AT_REST else AnyTimeLaw(self.rule, self.gauge_factor)

    @cached_property
    def rule(self) -> regulator.Rule:
        """What is asked at a decision, but for the pressure."""
        none, table = fixed(np.empty((0, 0)), np.float64), all_fixed(self.table.held)
        # Passes side by side look at the lines alone: what is no line must give no command.
        there = np.where(table.has_line[:, :, None], table.coefficient, np.float32(np.nan))
        table = table._replace(coefficient=fixed(there, np.float32))
        return regulator.Rule(table, none, none, 0.0, 1.0, 0, 0.0, 0.0)


@dataclass(frozen=True)
class LineController:
    """A regulator that compares speed with switching lines.

    The comparison is repeated at the stage reached before the command is sent, so that one command may go `farthest`
    stages. `lead_s` τ: compared is measured speed + τ·slope, the slope of the measured speed being filtered to first
    order over `slope_filter_s`. With an `estimator` the estimated speed is compared instead of the measured one.
    `decisions` at any time: the lines are asked at every sample, with the stage commanded last.
    """

    lines: SwitchingLines
    farthest: int = MOST_STAGES
    lead_s: float = 0.0
    slope_filter_s: float = 0.3
    estimator: Estimator | None = None
    decisions: Decisions = Decisions.AT_REST

    @property
    def stages(self) -> int:
        """Number of stages K + 1."""
        return self.lines.stages

    def law(self) -> Law:
        """The rule as the kernel takes it."""
        return self.rule if self.decisions is Decisions.AT_REST else AnyTimeLaw(self.rule, 1.0)

    @property
    def rule(self) -> regulator.Rule:
        """What is asked at a decision."""
        lines = self.lines
        return regulator.Rule(
            lines_apart(self.estimator),
            fixed(lines.lower_m_s, np.float64),
            fixed(lines.upper_m_s, np.float64),
            float(lines.nodes_m[0]),
            float(lines.nodes_m[-1] - lines.nodes_m[0]) / (lines.nodes_m.size - 1),
            self.farthest,
            self.lead_s,
            self.slope_filter_s,
        )


def full_brake(stages: int, start_m: float, exit_m: float) -> LineController:
    """A regulator of so many stages that raises at every decision, as far as there is a stage and it may."""
    return LineController(always_up(np.array([start_m, exit_m]), stages))


Controller = TableController | LineController


class Regulator(Protocol):
    """Whatever the closed loop can run."""

    @property
    def stages(self) -> int:
        """Number of stages K + 1."""

    def law(self) -> Law:
        """The rule as a kernel takes it, asked at rest or at any time."""
