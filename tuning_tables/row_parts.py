"""One row of a book's columns, in the parts that all tables have: origin, cut and figures."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt

from tuning_tables.figures import Predicted, Validated
from tuning_tables.provenance import CutId, Generator, RetarderId

Row = Mapping[str, Any]
"""Of every column of a book the entry of one table, by name."""


def generator_of(row: Row) -> Generator:
    """The generator; `InvalidTable` for values that make none, `UnicodeDecodeError` for no UTF-8, as the others."""
    return Generator(text_of(row["generator_name"]), text_of(row["generator_version"]), text_of(row["config_sha256"]))


def retarder_of(row: Row) -> RetarderId:
    """The retarder position."""
    zones = tuple((float(begin), float(end)) for begin, end in row["zones_m"] if not np.isnan(begin))
    return RetarderId(text_of(row["retarder"]), zones, float(row["exit_m"]), float(row["dead_band_kpa"]))


def cut_of(row: Row) -> CutId:
    """The class of cuts."""
    offsets = present(row["axle_offsets_m"])
    return CutId(text_of(row["category"]), float(row["mass_t"]), offsets, int(row.get("category_number", 0)) or None)


def predicted_of(row: Row) -> Predicted:
    """The figures of the solver."""
    p_stall = float(row["predicted_p_stall"])
    return Predicted(
        float(row["predicted_rms_m_s"]),
        float(row["predicted_bias_m_s"]),
        float(row["predicted_p_overspeed"]),
        float(row["predicted_switchings"]),
        None if np.isnan(p_stall) else p_stall,
        int(row.get("predicted_passes", 0)) or None,
    )


def validated_of(row: Row) -> Validated | None:
    """The figures of a closed loop, None where there was none."""
    passes = int(row["validated_passes"])
    if passes == 0:
        return None
    return Validated(passes, float(row["validated_rms_m_s"]), pair_of(row["validated_rms_ci95_m_s"]))


def present(values: npt.NDArray[np.float64]) -> tuple[float, ...]:
    """Those that are no filling."""
    return tuple(values[~np.isnan(values)].tolist())


def pair_of(values: npt.NDArray[np.float64]) -> tuple[float, float]:
    """Both ends of a range."""
    return float(values[0]), float(values[1])


def text_of(value: bytes) -> str:
    """The text of UTF-8 bytes."""
    return value.decode("utf-8")
