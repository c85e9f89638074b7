"""What a controller holds while a cut is in the retarder: the lines of one table, or those between two tables."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from tuning_tables.decisions import Approach, Decisions, entrance_stage, farthest, same_approach
from tuning_tables.estimator import Estimator
from tuning_tables.held_table import held_table
from tuning_tables.programs.held import LineTable
from tuning_tables.table import ControllerTable


@dataclass(frozen=True, eq=False)
class ActiveTable:
    """Lines ready for `decide_for`, chosen from a book; arrays are read-only.

    Attributes
    ----------
    target_speed_m_s
        float32, the exit speed that the lines aim at.
    coefficients, has_line, valid_range, slopes, pressures
        As of `ControllerTable`.
    estimator
        Of the speed that the lines are for; None: for the measured speed.
    approach
        On which the regulator already acts; None: it acts from the entrance on.
    decisions
        At rest or at any time.
    has_gauge
        Whether the lines depend on the pressure.
    held
        What the programs take.

    Examples
    --------
    With `table` from the example of `ControllerTable`:

    >>> from tuning_tables import TableBook, decide_for
    >>> lines = TableBook((table,)).choose("С", axles=4, commanded_m_s=3.0).table
    >>> lines
    ActiveTable(to 3 m/s, 2 stages)
    >>> decide_for(lines, stage=0, s_m=5.0, v_m_s=5.0)
    1
    """

    target_speed_m_s: np.float32
    coefficients: npt.NDArray[np.float32]
    has_line: npt.NDArray[np.bool_]
    valid_range: npt.NDArray[np.float32]
    slopes: npt.NDArray[np.float32]
    pressures: npt.NDArray[np.float32]
    estimator: Estimator | None = None
    approach: Approach | None = None
    decisions: Decisions = Decisions.AT_REST
    has_gauge: bool = False
    held: LineTable = field(init=False, repr=False)

    def __post_init__(self) -> None:
        for array in (self.coefficients, self.has_line, self.valid_range, self.slopes, self.pressures):
            array.setflags(write=False)
        object.__setattr__(self, "held", held_table(self))

    def __repr__(self) -> str:
        return f"ActiveTable(to {self.target_speed_m_s:g} m/s, {len(self.coefficients)} stages)"

    @property
    def highest_raised(self) -> int:
        """The highest stage that the lines ever ask for."""
        return int(np.argmin(self.has_line[:, 1]))

    @property
    def entrance_stage(self) -> int:
        """The highest stage that may be commanded at s < 0; stage K without approach."""
        return entrance_stage(self.approach, len(self.coefficients))

    @property
    def farthest(self) -> int:
        """By how many stages one command may go."""
        return farthest(self.decisions, len(self.coefficients))


def active(table: ControllerTable) -> ActiveTable:
    """`table` as it stands."""
    return ActiveTable(
        np.float32(table.target_speed_m_s),
        table.coefficients.view(),
        table.has_line.view(),
        table.valid_range.view(),
        table.slopes.view(),
        table.pressures.view(),
        table.estimator,
        table.approach,
        table.decisions,
        table.has_gauge,
    )


def interpolable(slower: ControllerTable, faster: ControllerTable) -> bool:
    """Whether lines between have a meaning: they differ in nothing but their coefficients and slopes.

    Stages, degree, lines, path range, estimator, approach and times of decision are the same, with slopes also the
    pressures.
    """
    return (
        slower.coefficients.shape == faster.coefficients.shape
        and np.array_equal(slower.has_line, faster.has_line)
        and np.array_equal(slower.valid_range[:2], faster.valid_range[:2])
        and same_estimator(slower.estimator, faster.estimator)
        and same_approach(slower.approach, faster.approach)
        and slower.decisions is faster.decisions
        and slower.has_gauge == faster.has_gauge
        and (not slower.has_gauge or np.array_equal(slower.pressures, faster.pressures))
    )


def same_estimator(one: Estimator | None, other: Estimator | None) -> bool:
    """Whether all numbers that a controller holds of them are equal, as float32, the touch pressure among them.

    So both compute the same from the same pressure gauge. Of σ_η and ℓ a controller holds 2 σ_η² ℓ only.
    """
    if one is None or other is None:
        return one is other
    return (
        all(np.float32(number) == np.float32(other.numbers[name]) for name, number in one.numbers.items())
        and np.array_equal(one.work, other.work)
        and np.float32(one.touch_pressure_kpa) == np.float32(other.touch_pressure_kpa)
    )


def between(slower: ControllerTable, faster: ControllerTable, target_speed_m_s: np.float32) -> ActiveTable:
    """The lines for a target between those of two `interpolable` tables, all in float32, one rounding an operation.

    w = (T - T0) / (T1 - T0), and every coefficient, slopes too, is c0 + w * (c1 - c0). As 0 <= w <= 1, each line lies
    between its neighbours, at the exit as at every other place, and lower(s) < upper(s) is inherited from both.
    """
    below, above = np.float32(slower.target_speed_m_s), np.float32(faster.target_speed_m_s)
    weight = (target_speed_m_s - below) / (above - below)
    coefficients = slower.coefficients + weight * (faster.coefficients - slower.coefficients)
    slopes = slower.slopes + weight * (faster.slopes - slower.slopes)
    return ActiveTable(
        target_speed_m_s,
        coefficients,
        slower.has_line.view(),
        slower.valid_range.view(),
        slopes,
        slower.pressures.view(),
        slower.estimator,
        slower.approach,
        slower.decisions,
        slower.has_gauge,
    )
