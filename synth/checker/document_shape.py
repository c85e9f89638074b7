"""What JSON documents of tables must look like, the comparison with it, and the numbers of weight categories, as
docs/reference/table-format.md fixes them.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, Final

from synth.checker.content import canonical_form, crc32, parse_json, without_checksum
from synth.checker.finding import DamagedError, shown

TEXT, NUMBER, COUNT = "a string", "a number", "a whole number"


@dataclass(frozen=True)
class OrNull:
    """`form`, or null."""

    form: Any


@dataclass(frozen=True)
class Row:
    """An array that is not empty of what `form` is, along an axis of books; `single`: of float32 numbers."""

    axis: str
    form: Any
    single: bool = False


@dataclass(frozen=True)
class Pair:
    """An array of two numbers, the first not above the second."""


@dataclass(frozen=True)
class OneOf:
    """One of these texts."""

    words: tuple[str, ...]


@dataclass(frozen=True)
class Nodes:
    """An array of numbers or null at the nodes of a table, as many as its axes say: looked at by who knows them."""


@dataclass(frozen=True)
class Single:
    """A number that books hold as float32."""


ORIGIN: Final[Mapping[str, Any]] = {
    "format": OneOf(("retarder-table",)),
    "version": COUNT,
    "kind": TEXT,
    "exported_by": TEXT,
    "id": TEXT,
    "created": TEXT,
    "generator": {"name": TEXT, "version": TEXT, "config_sha256": TEXT},
}
"""Of tables of all kinds. A mapping: exactly these members."""
PURPOSE: Final[Mapping[str, Any]] = {
    "retarder": {
        "name": TEXT,
        "zones_m": Row("zone", Pair()),
        "exit_m": NUMBER,
        "dead_band_kpa": NUMBER,
    },
    "cut": {
        "category": TEXT,
        "mass_t": NUMBER,
        "axle_offsets_m": Row("axle", NUMBER),
        "category_number": OrNull(COUNT),
    },
    "target_speed_m_s": NUMBER,
}
FIGURES: Final[Mapping[str, Any]] = {
    "predicted": {
        "rms_m_s": NUMBER,
        "bias_m_s": NUMBER,
        "p_overspeed": NUMBER,
        "switchings": NUMBER,
        "p_stall": OrNull(NUMBER),
        "passes": OrNull(COUNT),
    },
    "validated": OrNull({"passes": COUNT, "rms_m_s": NUMBER, "rms_ci95_m_s": Pair()}),
}
APPROACH: Final[Mapping[str, Any]] = {
    "length_m": NUMBER,
    "entrance_stage": COUNT,
    "interlock": OneOf(("position_clear",)),
}
CHECKSUM: Final[Mapping[str, Any]] = {"crc32": TEXT}

SLOPES: Final = ("lower_slope_m_s_per_kpa", "upper_slope_m_s_per_kpa")
"""Of the lower and of the upper line over the pressure."""
ESTIMATOR_NUMBERS: Final = (
    "speed_noise_m_s", "friction_cv", "resistance_std_m_s2", "path_std", "correlation_length_m", "lost_speed_std_m_s",
    "unlikely_deviation", "touch_pressure_kpa",
)  # fmt: skip
ESTIMATOR_COUNTS: Final = ("frozen_readings", "doubted_readings")
ESTIMATOR_ROWS: Final = ("s_m", "drive_m2_s2", "brake_m2_s2_per_kpa")
AT_REST, AT_ANY_TIME = "at_rest", "at_any_time"
LINES: Final = "lines"
LINES_SHAPE: Final[Mapping[str, Any]] = {
    **ORIGIN,
    **PURPOSE,
    "clock": {"sample_period_s": NUMBER, "computing_delay_s": NUMBER},
    "degree": COUNT,
    "stages": Row(
        "stage",
        {
            "k": COUNT,
            "pressure_kpa": NUMBER,
            **dict.fromkeys(("lower", "upper"), OrNull(Row("power", NUMBER, single=True))),
            **dict.fromkeys(SLOPES, OrNull(Single())),
        },
    ),
    "valid": {"s_m": Pair(), "v_m_s": Pair()},
    **FIGURES,
    "estimator": OrNull(
        {
            **dict.fromkeys(ESTIMATOR_NUMBERS, NUMBER),
            **dict.fromkeys(ESTIMATOR_COUNTS, COUNT),
            **dict.fromkeys(ESTIMATOR_ROWS, Row("break", NUMBER)),
        }
    ),
    "approach": OrNull(APPROACH),
    "decisions": OneOf((AT_REST, AT_ANY_TIME)),
    **CHECKSUM,
}
"""Of tables with lines."""


def checked_document(content: bytes, kind: str, shape: Mapping[str, Any]) -> dict[str, Any]:
    """The document in a JSON text, of this kind and shape, less its checksum, which was right; else `DamagedError`."""
    document = parse_json(content)
    if not isinstance(document, dict) or document.get("format") != "retarder-table":
        raise DamagedError('it is no controller table: its format is not "retarder-table"')
    version, found = document.get("version"), document.get("kind")
    if isinstance(version, bool) or not isinstance(version, int) or version != 1:
        raise DamagedError(f"its version is {shown(version)}, but this checker knows only version 1")
    if found != kind:
        raise DamagedError(f"its kind is {shown(found)}, but it must be {kind}")
    require_shape(document, shape, "")
    sum_found = f"{crc32(canonical_form(without_checksum(document)).encode('utf-8')):08x}"
    if document["crc32"] != sum_found:
        raise DamagedError(f"its crc32 is {shown(document['crc32'])}, but its content gives {sum_found}")
    return without_checksum(document)


def require_shape(value: Any, form: Any, path: str) -> None:
    """Raise `DamagedError` unless `value`, found at `path`, looks like `form`."""
    match form:
        case None:
            refuse_unless(value is None, value, path, "null")
        case OrNull():
            if value is not None:
                require_shape(value, form.form, path)
        case OneOf():
            known = " or ".join(f'"{word}"' for word in form.words)
            refuse_unless(isinstance(value, str) and value in form.words, value, path, known)
        case Pair():
            require_shape(value, Row("end", NUMBER), path)
            refuse_unless(len(value) == 2 and value[0] <= value[1], value, path, "two numbers, the smaller one first")
        case Mapping():
            refuse_unless(isinstance(value, dict), value, path, "an object")
            wrong = sorted(value.keys() ^ form.keys())
            refuse_unless(not wrong, wrong, path, "an object without missing or unknown keys such as these")
            for key, member in value.items():
                require_shape(member, form[key], f"{path}.{key}".lstrip("."))
        case Row():
            refuse_unless(isinstance(value, list) and len(value) > 0, value, path, "an array that is not empty")
            for index, item in enumerate(value):
                require_shape(item, form.form, f"{path}[{index}]")
        case Nodes():
            refuse_unless(isinstance(value, list), value, path, "an array")
        case Single():
            refuse_unless(is_a(NUMBER, value), value, path, NUMBER)
        case _:
            refuse_unless(is_a(form, value), value, path, form)


def is_a(form: str, value: Any) -> bool:
    """Whether `value` is of the simple kind `form`."""
    if form == TEXT:
        return isinstance(value, str) and value != "" and value.isprintable()
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    if isinstance(value, int):
        return abs(value) <= 2**53
    # The canonical form writes -0.0 as 0: no checksum would tell the two apart.
    return form == NUMBER and math.isfinite(value) and (value != 0.0 or math.copysign(1.0, value) > 0.0)


def refuse_unless(holds: bool, value: Any, path: str, wanted: str) -> None:
    """Raise `DamagedError` unless `holds`."""
    if not holds:
        raise DamagedError(f"{path or 'the document'} is {shown(value)}, but it must be {wanted}")


def origin_faults(document: Mapping[str, Any]) -> Iterator[str]:
    """Faults of what a table says of its making."""
    if re.fullmatch("[0-9a-f]{64}", document["generator"]["config_sha256"]) is None:
        yield f"its config_sha256, {document['generator']['config_sha256'][:70]!r}, is not one"
    if re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d{1,9})?Z", document["created"], re.ASCII) is None:
        yield f"its date {document['created'][:40]!r} is not one"


YARD: Final = {"Л": 1, "ЛС": 2, "С": 3, "СТ": 4, "Т": 5}
OWN: Final = range(16, 256)


def number_of(cut: dict[str, Any]) -> int | None:
    """The number of the category of a cut: stated, or that of the yard's own; None for neither.

    Raises `DamagedError` where another one is stated.
    """
    stated, known = cut.get("category_number"), YARD.get(cut["category"])
    if stated is None:
        return known
    right = stated == known if known is not None else stated in OWN
    wanted = str(known) if known is not None else "from 16 to 255"
    refuse_unless(right, stated, f"cut.category_number of {cut['category']}", wanted)
    return int(stated)
