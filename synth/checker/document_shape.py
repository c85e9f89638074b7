"""What JSON documents of controller tables must look like, of any version, and the comparison with it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from synth.checker.finding import DamagedError, shown

TEXT, NUMBER, COUNT = "a string", "a number", "a whole number"


@dataclass(frozen=True)
class OrNull:
    """`form`, or null."""

    form: Any


@dataclass(frozen=True)
class Pair:
    """An array of two numbers, the first not above the second."""


@dataclass(frozen=True)
class OneOf:
    """One of these texts."""

    words: tuple[str, ...]


@dataclass(frozen=True)
class Optional:
    """A member that may be missing."""

    form: Any


NUMBERS: Final = [NUMBER]
STAGE: Final[Mapping[str, Any]] = {
    "k": COUNT,
    "pressure_kpa": NUMBER,
    "lower": OrNull(NUMBERS),
    "upper": OrNull(NUMBERS),
}
PREDICTED: Final[Mapping[str, Any]] = {
    "rms_m_s": NUMBER,
    "bias_m_s": NUMBER,
    "p_overspeed": NUMBER,
    "switchings": NUMBER,
    "p_stall": Optional(NUMBER),
}
SHAPE: Final[Mapping[str, Any]] = {
    "format": TEXT,
    "version": COUNT,
    "id": TEXT,
    "created": TEXT,
    "generator": {"name": TEXT, "version": TEXT, "config_sha256": TEXT},
    "retarder": {"name": TEXT, "zones_m": [Pair()], "exit_m": NUMBER, "dead_band_kpa": NUMBER},
    "cut": {"category": TEXT, "category_number": Optional(COUNT), "mass_t": NUMBER, "axle_offsets_m": NUMBERS},
    "target_speed_m_s": NUMBER,
    "polynomial": {"variable": TEXT, "degree": COUNT},
    "stages": [STAGE],
    "valid": {"s_m": Pair(), "v_m_s": Pair()},
    "predicted": PREDICTED,
    "validated": OrNull({"passes": COUNT, "rms_m_s": NUMBER, "rms_ci95_m_s": Pair()}),
    "crc32": TEXT,
}
"""Version 1. A dict: exactly these members; a list: an array of what it holds."""

ESTIMATOR_NUMBERS: Final = (
    "speed_noise_m_s", "friction_cv", "resistance_std_m_s2", "path_std", "correlation_length_m", "lost_speed_std_m_s",
    "unlikely_deviation", "touch_pressure_kpa",
)  # fmt: skip
ESTIMATOR_COUNTS: Final = ("frozen_readings", "doubted_readings")
ESTIMATOR_ROWS: Final = ("s_m", "drive_m2_s2", "brake_m2_s2_per_kpa")
SHAPE_WITH_ESTIMATOR: Final[Mapping[str, Any]] = {
    **SHAPE,
    "predicted": {**PREDICTED, "passes": Optional(COUNT)},
    "estimator": {
        **dict.fromkeys(ESTIMATOR_NUMBERS, NUMBER),
        **dict.fromkeys(ESTIMATOR_COUNTS, COUNT),
        **dict.fromkeys(ESTIMATOR_ROWS, NUMBERS),
    },
}
"""Version 2: its lines are for the speed that the estimator gives."""

APPROACH: Final[Mapping[str, Any]] = {"length_m": NUMBER, "entrance_stage": COUNT, "interlock": TEXT}
"""Version 3: the regulator acts from before the entrance; with or without an estimator."""

SLOPES: Final = ("lower_slope_m_s_per_kpa", "upper_slope_m_s_per_kpa")
"""Of the lower and of the upper line over the pressure."""
GAUGE, NO_GAUGE = "gauge", "none"
AT_ANY_TIME: Final[Mapping[str, Any]] = {
    "decisions": OneOf(("at_any_time",)),
    "pressure": OneOf((GAUGE, NO_GAUGE)),
    "approach": Optional(APPROACH),
}
"""Version 5: it decides at every sample; with or without a gauge, an estimator and an approach."""

KNOWN_VERSIONS: Final = (1, 2, 3, 5)


def shape_of(document: Mapping[str, Any], version: int) -> Mapping[str, Any]:
    """What a document of a known version must look like: from version 3 on it may have an estimator or none."""
    estimating = version == 2 or (version > 2 and "estimator" in document)
    shape = SHAPE_WITH_ESTIMATOR if estimating else SHAPE
    if version == 3:
        return {**shape, "approach": APPROACH}
    if version == 5:
        sloped = document.get("pressure") == GAUGE
        stage = {**STAGE, **dict.fromkeys(SLOPES, OrNull(NUMBER))} if sloped else STAGE
        return {**shape, **AT_ANY_TIME, "stages": [stage]}
    return shape


def require_document(document: Mapping[str, Any]) -> None:
    """Raise `DamagedError` unless `document`, of a table with lines, is of a known version and looks as that must."""
    version = document.get("version")
    if isinstance(version, bool) or not isinstance(version, int) or version not in KNOWN_VERSIONS:
        raise DamagedError(
            f"its version is {shown(version)}, but tables with lines are of the versions 1, 2, 3 and 5 only"
        )
    require_shape(document, shape_of(document, version), "")


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
            require_shape(value, NUMBERS, path)
            refuse_unless(len(value) == 2 and value[0] <= value[1], value, path, "two numbers, the smaller one first")
        case Mapping():
            refuse_unless(isinstance(value, dict), value, path, "an object")
            needed = {key for key, member in form.items() if not isinstance(member, Optional)}
            wrong = sorted((value.keys() - form.keys()) | (needed - value.keys()))
            refuse_unless(not wrong, wrong, path, "an object without missing or unknown keys such as these")
            # Words first: they tell what the rest must look like.
            for key, member in sorted(value.items(), key=lambda each: not isinstance(form[each[0]], OneOf)):
                of = form[key]
                require_shape(member, of.form if isinstance(of, Optional) else of, f"{path}.{key}".lstrip("."))
        case [inner]:
            refuse_unless(isinstance(value, list) and len(value) > 0, value, path, "an array that is not empty")
            for index, item in enumerate(value):
                require_shape(item, inner, f"{path}[{index}]")
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
