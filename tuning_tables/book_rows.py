"""From the columns of a book back to its tables, row by row."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from tuning_tables.approach import Approach
from tuning_tables.book_layout import Columns
from tuning_tables.decisions import Decisions
from tuning_tables.errors import InvalidTable
from tuning_tables.estimator import Estimator
from tuning_tables.figures import ValidRange
from tuning_tables.row_parts import (
    Row,
    cut_of,
    generator_of,
    pair_of,
    predicted_of,
    retarder_of,
    text_of,
    validated_of,
)
from tuning_tables.stage import Line, Stage
from tuning_tables.table import ControllerTable


def tables_of(columns: Columns) -> tuple[ControllerTable, ...]:
    """The tables in the arrays of a book, which must have the names, types and numbers of axes of a layout.

    Raises `InvalidTable` for values that make no table, `UnicodeDecodeError` for text that is no UTF-8.
    """
    return tuple(_table({name: column[row] for name, column in columns.items()}) for row in range(len(columns["id"])))


def _table(row: Row) -> ControllerTable:
    """The table in one row of every column."""
    return ControllerTable(
        id=text_of(row["id"]),
        created=text_of(row["created"]),
        generator=generator_of(row),
        retarder=retarder_of(row),
        cut=cut_of(row),
        target_speed_m_s=float(row["target_speed_m_s"]),
        degree=int(row["degree"]),
        stages=_stages(row),
        valid=ValidRange(pair_of(row["valid_s_m"]), pair_of(row["valid_v_m_s"])),
        predicted=predicted_of(row),
        validated=validated_of(row),
        estimator=_estimator(row),
        approach=_approach(row),
        decisions=Decisions.AT_ANY_TIME if row.get("at_any_time", 0) else Decisions.AT_REST,
    )


def _approach(row: Row) -> Approach | None:
    length_m = float(row.get("approach_length_m", np.nan))
    return None if np.isnan(length_m) else Approach(length_m, int(row["approach_entrance_stage"]))


def _estimator(row: Row) -> Estimator | None:
    breaks = int(row.get("estimator_breaks", 0))
    if breaks == 0:
        return None
    if not 0 < breaks <= len(row["estimator_s_m"]):
        raise InvalidTable(f"estimator_breaks is {breaks}, but the book has room for {len(row['estimator_s_m'])}.")
    work = (row[f"estimator_{name}"][:breaks].tolist() for name in ("s_m", "drive_m2_s2", "brake_m2_s2_per_kpa"))
    s_m, drive, brake = map(tuple, work)
    return Estimator(
        float(row["estimator_speed_noise_m_s"]),
        float(row["estimator_friction_cv"]),
        float(row["estimator_resistance_std_m_s2"]),
        float(row["estimator_path_std"]),
        float(row["estimator_correlation_length_m"]),
        int(row["estimator_frozen_readings"]),
        int(row["estimator_doubted_readings"]),
        float(row["estimator_lost_speed_std_m_s"]),
        float(row["estimator_unlikely_deviation"]),
        float(row["estimator_touch_pressure_kpa"]),
        s_m,
        drive,
        brake,
    )


def _stages(row: Row) -> tuple[Stage, ...]:
    n_stages, degree = int(row["n_stages"]), int(row["degree"])
    most_stages, _, most_powers = row["coefficients"].shape
    if not (2 <= n_stages <= most_stages and 0 <= degree < most_powers):
        raise InvalidTable(f"n_stages {n_stages} or degree {degree} exceeds the coefficients of the book.")
    coefficients = row["coefficients"][:, :, : degree + 1].astype(np.float64)
    lines: list[list[Line | None]] = [
        [tuple(coefficients[k, line].tolist()) if row["has_line"][k, line] else None for line in (0, 1)]
        for k in range(n_stages)
    ]
    pressures = row["pressure_kpa"].tolist()
    return tuple(
        Stage(k, pressures[k], lower, upper, *_slopes(row, k, (lower, upper))) for k, (lower, upper) in enumerate(lines)
    )


def _slopes(row: Row, stage: int, lines: Sequence[Line | None]) -> list[float | None]:
    """Those of the lines that there are; None for a table without gauge."""
    if not row.get("has_gauge", 0):
        return [None, None]
    return [None if line is None else float(row["slopes"][stage, side]) for side, line in enumerate(lines)]
