"""What a controller holds of a table, from its parts: the value that the programs of `tuning_tables.programs` take."""

from __future__ import annotations

from typing import Any, Protocol

import numpy as np
import numpy.typing as npt

from tuning_tables.decisions import Approach, Decisions, entrance_stage
from tuning_tables.estimator import Estimator
from tuning_tables.programs.held import LineTable


class TableParts(Protocol):
    """What a table is made of; arrays have the shapes that `ControllerTable` tells."""

    @property
    def coefficients(self) -> npt.NDArray[np.float32]:
        """Coefficients of the lines."""
        ...

    @property
    def has_line(self) -> npt.NDArray[np.bool_]:
        """Which stages have a line."""
        ...

    @property
    def valid_range(self) -> npt.NDArray[np.float32]:
        """The path of the lines, m."""
        ...

    @property
    def slopes(self) -> npt.NDArray[np.float32]:
        """Slopes of the lines with pressure."""
        ...

    @property
    def pressures(self) -> npt.NDArray[np.float32]:
        """Nominal pressures of the stages, kPa."""
        ...

    @property
    def target_speed_m_s(self) -> float | np.float32:
        """Target exit speed, m/s."""
        ...

    @property
    def has_gauge(self) -> bool:
        """Whether the controller measures the pressure."""
        ...

    @property
    def decisions(self) -> Decisions:
        """When the controller decides."""
        ...

    @property
    def approach(self) -> Approach | None:
        """The path before the retarder."""
        ...

    @property
    def estimator(self) -> Estimator | None:
        """The filter of speed."""
        ...


def held_table(table: TableParts) -> LineTable:
    """The table as the programs take it; its arrays are read-only.

    What rules do not look at is 0: category, axles, family, mass, and the clock.
    """
    stages = len(table.has_line)
    with np.errstate(over="ignore"):  # a book refuses a target that float32 cannot hold
        target = np.float32(table.target_speed_m_s)
    return NO_TABLE._replace(
        stages=stages,
        powers=table.coefficients.shape[2],
        at_any_time=int(table.decisions is Decisions.AT_ANY_TIME),
        entrance_stage=entrance_stage(table.approach, stages),
        target_m_s=target,
        path_min_m=table.valid_range[0],
        path_max_m=table.valid_range[1],
        approach_m=np.float32(0.0 if table.approach is None else table.approach.length_m),
        has_line=read_only(table.has_line, np.bool_),
        coefficient=read_only(table.coefficients, np.float32),
        has_gauge=int(table.has_gauge),
        highest_kpa=table.pressures[int(np.argmin(table.has_line[:, 1]))],
        pressure_kpa=read_only(table.pressures, np.float32),
        slope=read_only(table.slopes, np.float32),
        **estimator_members(table.estimator),
    )


def lines_apart(estimator: Estimator | None) -> LineTable:
    """A table without stages: of a regulator that has its lines elsewhere, and this estimator."""
    return NO_TABLE._replace(**estimator_members(estimator))


def estimator_members(estimator: Estimator | None) -> dict[str, Any]:
    """The members of an estimator, the touch pressure with them; 0 and empty for none."""
    numbers = {name: np.float32(0.0) for name in ESTIMATOR_NUMBERS}
    work = np.zeros((3, 0), dtype=np.float32)
    if estimator is not None:
        numbers = {name: np.float32(value) for name, value in estimator.numbers.items()}
        work = estimator.work
    rows = (read_only(row, np.float32) for row in work)
    touch_kpa = np.float32(0.0 if estimator is None else estimator.touch_pressure_kpa)
    return {
        "touch_kpa": touch_kpa,
        "breaks": work.shape[1],
        **numbers,
        **dict(zip(("place_m", "drive", "brake"), rows, strict=True)),
    }


def read_only(array: npt.NDArray[Any], dtype: type[np.generic]) -> npt.NDArray[Any]:
    """A contiguous read-only view or copy: the programs are compiled for exactly such arrays, once."""
    view = np.ascontiguousarray(array, dtype=dtype).view()
    view.setflags(write=False)
    return view


ESTIMATOR_NUMBERS = (
    "speed_variance", "factor_variance", "path_variance", "excess_variance", "leap_m_s", "frozen", "doubted",
    "lost_variance", "caution", "unlikely",
)  # fmt: skip
"""The members of `LineTable` that are numbers of an estimator, as `Estimator.numbers` has them."""

NO_TABLE = LineTable(
    category=0, axles=0, family_no=0, stages=0, powers=1, at_any_time=0, entrance_stage=0, mass_t=np.float32(0.0),
    target_m_s=np.float32(0.0), path_min_m=np.float32(0.0), path_max_m=np.float32(0.0), approach_m=np.float32(0.0),
    sample_period_s=np.float32(0.0), computing_delay_s=np.float32(0.0),
    has_line=read_only(np.zeros((0, 2)), np.bool_), coefficient=read_only(np.zeros((0, 2, 1)), np.float32),
    has_gauge=0, highest_kpa=np.float32(0.0), pressure_kpa=read_only(np.zeros(0), np.float32),
    slope=read_only(np.zeros((0, 2)), np.float32), **estimator_members(None),
)  # fmt: skip
"""Neither stages nor estimator."""
