"""From the columns of a book back to its tables, row by row."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from tuning_tables.approach import Approach
from tuning_tables.book_columns import Columns
from tuning_tables.errors import InvalidTable
from tuning_tables.estimator import Estimator
from tuning_tables.figures import Predicted, Validated, ValidRange
from tuning_tables.provenance import CutId, Generator, RetarderId
from tuning_tables.stage import Stage
from tuning_tables.table import ControllerTable


def tables_of(columns: Columns) -> tuple[ControllerTable, ...]:
    """The tables in the arrays of a book, which must have the names, types and numbers of axes of a layout.

    Raises `InvalidTable` for values that make no table, `UnicodeDecodeError` for text that is no UTF-8.
    """
    return tuple(_table({name: column[row] for name, column in columns.items()}) for row in range(len(columns["id"])))


def _table(row: Mapping[str, Any]) -> ControllerTable:
    """The table in one row of every column."""
    p_stall = float(row["predicted_p_stall"])
    return ControllerTable(
        id=_text(row["id"]),
        created=_text(row["created"]),
        generator=Generator(_text(row["generator_name"]), _text(row["generator_version"]), _text(row["config_sha256"])),
        retarder=RetarderId(
            _text(row["retarder"]),
            tuple((float(begin), float(end)) for begin, end in row["zones_m"] if not np.isnan(begin)),
            float(row["exit_m"]),
            float(row["dead_band_kpa"]),
        ),
        cut=CutId(
            _text(row["category"]),
            float(row["mass_t"]),
            _present(row["axle_offsets_m"]),
            int(row.get("category_number", 0)) or None,
        ),
        target_speed_m_s=float(row["target_speed_m_s"]),
        degree=int(row["degree"]),
        stages=_stages(row),
        valid=ValidRange(_pair(row["valid_s_m"]), _pair(row["valid_v_m_s"])),
        predicted=Predicted(
            float(row["predicted_rms_m_s"]),
            float(row["predicted_bias_m_s"]),
            float(row["predicted_p_overspeed"]),
            float(row["predicted_switchings"]),
            None if np.isnan(p_stall) else p_stall,
            int(row.get("predicted_passes", 0)) or None,
        ),
        validated=_validated(row),
        estimator=_estimator(row),
        approach=_approach(row),
    )


def _approach(row: Mapping[str, Any]) -> Approach | None:
    length_m = float(row.get("approach_length_m", np.nan))
    return None if np.isnan(length_m) else Approach(length_m, int(row["approach_entrance_stage"]))


def _estimator(row: Mapping[str, Any]) -> Estimator | None:
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
        float(row["estimator_path_std"]),
        float(row["estimator_correlation_length_m"]),
        float(row["estimator_touch_pressure_kpa"]),
        s_m,
        drive,
        brake,
    )


def _stages(row: Mapping[str, Any]) -> tuple[Stage, ...]:
    n_stages, degree = int(row["n_stages"]), int(row["degree"])
    most_stages, _, most_powers = row["coefficients"].shape
    if not (2 <= n_stages <= most_stages and 0 <= degree < most_powers):
        raise InvalidTable(f"n_stages {n_stages} or degree {degree} exceeds the coefficients of the book.")
    coefficients = row["coefficients"][:, :, : degree + 1].astype(np.float64)
    lines = [
        [tuple(coefficients[k, line].tolist()) if row["has_line"][k, line] else None for line in (0, 1)]
        for k in range(n_stages)
    ]
    return tuple(Stage(k, float(row["pressure_kpa"][k]), lower, upper) for k, (lower, upper) in enumerate(lines))


def _validated(row: Mapping[str, Any]) -> Validated | None:
    passes = int(row["validated_passes"])
    if passes == 0:
        return None
    return Validated(passes, float(row["validated_rms_m_s"]), _pair(row["validated_rms_ci95_m_s"]))


def _present(values: npt.NDArray[np.float64]) -> tuple[float, ...]:
    return tuple(values[~np.isnan(values)].tolist())


def _pair(values: npt.NDArray[np.float64]) -> tuple[float, float]:
    return float(values[0]), float(values[1])


def _text(value: bytes) -> str:
    return value.decode("utf-8")
