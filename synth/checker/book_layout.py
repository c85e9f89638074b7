"""How a book holds its tables, by docs/table-format.md: type, axes and unit of every dataset, and what fills gaps."""

from __future__ import annotations

import math
from collections.abc import Mapping, Set
from dataclasses import dataclass
from typing import Any, Final

from synth.checker.document_shape import ESTIMATOR_COUNTS, ESTIMATOR_NUMBERS, ESTIMATOR_ROWS, SLOPES
from synth.checker.finding import DamagedError, shown

CHECKSUM_BYTES: Final = 4
"""That fletcher32 adds to a chunk."""


@dataclass(frozen=True)
class Stored:
    """A dataset: its type in numpy's letters ("|S" for text of any length), its axes, its unit."""

    dtype: str
    axes: tuple[str, ...]
    unit: str


TABLE: Final = ("table",)
TEXT: Final = Stored("|S", TABLE, "1")
DATASETS: Final[Mapping[str, Stored]] = {
    **dict.fromkeys(("id", "created", "generator_name", "generator_version", "config_sha256"), TEXT),
    **dict.fromkeys(("retarder", "category"), TEXT),
    **dict.fromkeys(("degree", "n_stages"), Stored("<i4", TABLE, "1")),
    **dict.fromkeys(("target_speed_m_s", "predicted_rms_m_s", "predicted_bias_m_s"), Stored("<f8", TABLE, "m/s")),
    **dict.fromkeys(("predicted_p_overspeed", "predicted_switchings", "predicted_p_stall"), Stored("<f8", TABLE, "1")),
    "mass_t": Stored("<f8", TABLE, "t"),
    "exit_m": Stored("<f8", TABLE, "m"),
    "dead_band_kpa": Stored("<f8", TABLE, "kPa"),
    "zones_m": Stored("<f8", ("table", "zone", "end"), "m"),
    "axle_offsets_m": Stored("<f8", ("table", "axle"), "m"),
    "pressure_kpa": Stored("<f8", ("table", "stage"), "kPa"),
    "coefficients": Stored("<f4", ("table", "stage", "line", "power"), "m/s per m^power"),
    "has_line": Stored("|u1", ("table", "stage", "line"), "1"),
    "valid_s_m": Stored("<f8", ("table", "end"), "m"),
    "valid_v_m_s": Stored("<f8", ("table", "end"), "m/s"),
    "validated_passes": Stored("<i8", TABLE, "1"),
    "validated_rms_m_s": Stored("<f8", TABLE, "m/s"),
    "validated_rms_ci95_m_s": Stored("<f8", ("table", "end"), "m/s"),
}
WITH_ESTIMATORS: Final[Mapping[str, Stored]] = {
    **DATASETS,
    "predicted_passes": Stored("<i8", TABLE, "1"),
    "estimator_breaks": Stored("<i4", TABLE, "1"),
    **dict.fromkeys(("estimator_speed_noise_m_s", "estimator_lost_speed_std_m_s"), Stored("<f8", TABLE, "m/s")),
    **dict.fromkeys(("estimator_friction_cv", "estimator_path_std"), Stored("<f8", TABLE, "1")),
    "estimator_unlikely_deviation": Stored("<f8", TABLE, "1"),
    "estimator_resistance_std_m_s2": Stored("<f8", TABLE, "m/s2"),
    **dict.fromkeys(("estimator_frozen_readings", "estimator_doubted_readings"), Stored("<i4", TABLE, "1")),
    "estimator_correlation_length_m": Stored("<f8", TABLE, "m"),
    "estimator_touch_pressure_kpa": Stored("<f8", TABLE, "kPa"),
    "estimator_s_m": Stored("<f8", ("table", "break"), "m"),
    "estimator_drive_m2_s2": Stored("<f8", ("table", "break"), "m2/s2"),
    "estimator_brake_m2_s2_per_kpa": Stored("<f8", ("table", "break"), "m2/s2 per kPa"),
}
APPROACH: Final[Mapping[str, Stored]] = {
    "approach_length_m": Stored("<f8", TABLE, "m"),
    "approach_entrance_stage": Stored("<i4", TABLE, "1"),
}
AT_ANY_TIME: Final[Mapping[str, Stored]] = {
    **dict.fromkeys(("at_any_time", "has_gauge"), Stored("|u1", TABLE, "1")),
    "slopes": Stored("<f4", ("table", "stage", "line"), "m/s per kPa"),
}
BEYOND_FIRST: Final[Mapping[int, Mapping[str, Stored]]] = {
    1: {},
    2: {},
    3: APPROACH,
    5: {**APPROACH, **AT_ANY_TIME},
}
"""By schema version, what a book holds beside `DATASETS`: 2 has estimators, and from 3 on they may be there or not."""
FILLED_UP_WITH_0: Final = frozenset({"has_line", *(f"estimator_{name}" for name in ESTIMATOR_COUNTS)})
"""Of the arrays that can be shorter than those of the book; the others are filled up with NaN."""
NUMBER: Final = "category_number"
"""In books whose tables state it, of any version; 0: not stated."""


def datasets_of(version: int, names: Set[str]) -> Mapping[str, Stored]:
    """The datasets of a book of a schema version with datasets of these `names`; `DamagedError` for another version."""
    if version not in BEYOND_FIRST:
        raise DamagedError(f"its schema_version is {shown(version)}; this checker knows only the versions 1, 2, 3, 5")
    estimating = version == 2 or (version > 2 and "estimator_breaks" in names)
    datasets = {**(WITH_ESTIMATORS if estimating else DATASETS), **BEYOND_FIRST[version]}
    return {**datasets, NUMBER: Stored("<i4", TABLE, "1")} if NUMBER in names else datasets


def axes_of(datasets: Mapping[str, Stored]) -> frozenset[str]:
    """The names of all axes."""
    return frozenset(axis for stored in datasets.values() for axis in stored.axes)


def require_stored(name: str, dataset: Any, stored: Stored) -> None:
    """Raise `DamagedError` unless the type, axes, unit and place of `dataset` in the file are those of `stored`."""
    dtype = dataset.dtype.str
    if not (dtype == stored.dtype or (stored.dtype == "|S" and dtype.startswith("|S"))):
        raise DamagedError(f"{name} is of the type {shown(dtype)}, but must be of {stored.dtype}")
    if dataset.ndim != len(stored.axes):
        raise DamagedError(f"{name} has the shape {shown(dataset.shape)}, but its axes are {', '.join(stored.axes)}")
    if dataset.attrs.get("units") != stored.unit or not isinstance(dataset.attrs.get("meaning"), str):
        raise DamagedError(f"{name} has the units {shown(dataset.attrs.get('units'))}, but must have {stored.unit}")
    filters = dataset.fletcher32 and not (dataset.compression or dataset.shuffle or dataset.scaleoffset)
    whole = dataset.chunks == dataset.shape and dataset.id.get_storage_size() == dataset.nbytes + CHECKSUM_BYTES
    if not filters or not whole:
        raise DamagedError(f"{name} is not stored in one unpacked piece with the checksum fletcher32")


def require_axes(book: Any, values: Mapping[str, Any], datasets: Mapping[str, Stored]) -> None:
    """Raise `DamagedError` unless every axis has one length, numbered from 0, in all arrays `values`."""
    lengths: dict[str, int] = {}
    for name, stored in datasets.items():
        if stored == TEXT and values[name].dtype.itemsize > max(map(len, values[name].tolist()), default=0):
            raise DamagedError(f"{name} has room for longer texts than any of its own")
        for axis, length in zip(stored.axes, values[name].shape, strict=True):
            if lengths.setdefault(axis, length) != length or length == 0:
                raise DamagedError(f"{name} has {length} entries along {axis}, but the book {lengths[axis]}")
    for axis, length in lengths.items():
        scale = book[axis]
        plain = scale.dtype.str == "<i4" and scale.shape == (length,) and scale.chunks is None
        if not plain or scale.id.get_storage_size() != scale.nbytes or scale[()].tolist() != list(range(length)):
            raise DamagedError(f"{axis} does not number {length} entries from 0")


def require_filled_up(columns: Mapping[str, list[Any]], documents: list[dict[str, Any]]) -> None:
    """Raise `DamagedError` unless NaN or 0 alone stands wherever a table is shorter than the arrays of the book.

    Also where the arrays are longer than the longest table, or texts wider than the widest.
    """
    rows = [short_arrays(document) for document in documents]
    for name in rows[0].keys() & columns.keys():
        filler: float = 0 if name in FILLED_UP_WITH_0 else math.nan
        found = columns[name]
        # As text, in which two NaN are alike and the zeros are not.
        if any(repr(padded(row[name], cell, filler)) != repr(cell) for row, cell in zip(rows, found, strict=True)):
            raise DamagedError(f"{name} holds values beside those of the tables")
        if depth([row[name] for row in rows]) != depth(found):
            raise DamagedError(f"{name} is longer than its longest table")


def short_arrays(document: Mapping[str, Any]) -> dict[str, Any]:
    """The arrays of one table that can be shorter than those of the book, by dataset."""
    stages, validated, estimator = document["stages"], document["validated"], document.get("estimator", {})
    lines = [(stage["lower"], stage["upper"]) for stage in stages]
    return {
        "zones_m": document["retarder"]["zones_m"],
        "axle_offsets_m": document["cut"]["axle_offsets_m"],
        "pressure_kpa": [stage["pressure_kpa"] for stage in stages],
        "has_line": [[int(line is not None) for line in both] for both in lines],
        "coefficients": [[line or [] for line in both] for both in lines],
        "slopes": [[0.0 if stage.get(key) is None else stage[key] for key in SLOPES] for stage in stages],
        "approach_length_m": document.get("approach", {}).get("length_m"),
        "validated_rms_m_s": validated["rms_m_s"] if validated else None,
        "validated_rms_ci95_m_s": validated["rms_ci95_m_s"] if validated else [None, None],
        **{f"estimator_{name}": estimator.get(name) for name in (*ESTIMATOR_NUMBERS, *ESTIMATOR_COUNTS)},
        **{f"estimator_{name}": estimator.get(name, []) for name in ESTIMATOR_ROWS},
    }


def padded(values: Any, cell: Any, filler: float) -> Any:
    """`values` filled up with `filler` to the lengths of `cell`."""
    if not isinstance(cell, list):
        return filler if values is None else values
    below = [*(values or []), *[None] * (len(cell) - len(values or []))]
    return [padded(value, each, filler) for value, each in zip(below, cell, strict=False)]


def depth(values: Any) -> list[int]:
    """The greatest length of each axis below the first."""
    if not isinstance(values, list):
        return []
    below = [value for value in values if isinstance(value, list)]
    longest = [depth(value) for value in below]
    return [max((len(value) for value in below), default=0), *map(max, zip(*longest, strict=False))]
