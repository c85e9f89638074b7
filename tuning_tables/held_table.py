"""What a controller holds of a table, from its parts: the value that the programs of `tuning_tables.programs` take."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from tuning_tables.approach import Approach, entrance_stage
from tuning_tables.decisions import Decisions
from tuning_tables.estimator import Estimator
from tuning_tables.programs.line_table import LineTable

NO_LINES = np.zeros((0, 2, 1), dtype=np.float32)


def held_table(
    coefficients: npt.NDArray[np.float32],
    has_line: npt.NDArray[np.bool_],
    path_m: npt.NDArray[np.float32],
    slopes: npt.NDArray[np.float32],
    pressures: npt.NDArray[np.float32],
    *,
    target_speed_m_s: float,
    has_gauge: bool,
    decisions: Decisions,
    approach: Approach | None,
    estimator: Estimator | None,
) -> LineTable:
    """The table that these parts make; arrays have the shapes that `ControllerTable` tells, and become read-only.

    `path_m` (least, greatest). Category, axles and mass are 0: a single table does not choose between cuts.
    """
    stages = len(coefficients)
    with np.errstate(over="ignore"):  # a book refuses a target that float32 cannot hold
        target = np.float32(target_speed_m_s)
    highest = int(np.argmin(has_line[:, 1])) if stages else 0
    return LineTable(
        category=0,
        axles=0,
        stages=stages,
        powers=coefficients.shape[2],
        at_any_time=int(decisions is Decisions.AT_ANY_TIME),
        entrance_stage=entrance_stage(approach, stages),
        mass_t=np.float32(0.0),
        target_m_s=target,
        path_min_m=np.float32(path_m[0]),
        path_max_m=np.float32(path_m[1]),
        approach_m=np.float32(0.0 if approach is None else approach.length_m),
        touch_kpa=np.float32(0.0 if estimator is None else estimator.touch_pressure_kpa),
        has_line=read_only(has_line, np.bool_),
        coefficient=read_only(coefficients, np.float32),
        has_gauge=int(has_gauge),
        highest_kpa=np.float32(pressures[highest] if stages else 0.0),
        pressure_kpa=read_only(pressures, np.float32),
        slope=read_only(slopes, np.float32),
        **estimator_members(estimator),
    )


def lines_apart(estimator: Estimator | None) -> LineTable:
    """A table without stages: of a regulator that has its lines elsewhere, and this estimator."""
    return held_table(
        NO_LINES, np.zeros((0, 2), np.bool_), np.zeros(2, np.float32), np.zeros((0, 2), np.float32),
        np.zeros(0, np.float32), target_speed_m_s=0.0, has_gauge=False, decisions=Decisions.AT_REST, approach=None,
        estimator=estimator,
    )  # fmt: skip


def estimator_members(estimator: Estimator | None) -> dict[str, Any]:
    """The members of an estimator; 0 and empty for none."""
    numbers = {name: np.float32(0.0) for name in ESTIMATOR_NUMBERS}
    work = np.zeros((3, 0), dtype=np.float32)
    if estimator is not None:
        numbers = {name: np.float32(value) for name, value in estimator.numbers.items()}
        work = estimator.work
    rows = (read_only(row, np.float32) for row in work)
    return {"breaks": work.shape[1], **numbers, **dict(zip(("place_m", "drive", "brake"), rows, strict=True))}


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
