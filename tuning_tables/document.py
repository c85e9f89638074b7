"""A controller table as a JSON document (dicts, lists, numbers, strings), and back, without the text around it."""

from __future__ import annotations

from typing import Final

from tuning_tables.approach import INTERLOCK, Approach
from tuning_tables.canonical import CHECKSUM_KEY, document_checksum
from tuning_tables.decisions import Decisions
from tuning_tables.document_head import require_checksum, require_format, require_version
from tuning_tables.errors import DamagedTable, InvalidTable, OtherDecisions
from tuning_tables.estimator import Estimator
from tuning_tables.excerpt import excerpt
from tuning_tables.figures import ValidRange
from tuning_tables.figures_document import predicted_document, read_predicted, read_validated, validated_document
from tuning_tables.provenance_document import (
    floats,
    provenance_document,
    read_cut,
    read_generator,
    read_retarder,
)
from tuning_tables.section import Section
from tuning_tables.stage import SIDES, Stage
from tuning_tables.table import ControllerTable

FORMAT: Final = "retarder-table"
VERSION: Final = 1
ESTIMATOR_VERSION: Final = 2
"""Of tables with an estimator, so that readers who do not know of it refuse them: their lines are for another speed."""
APPROACH_VERSION: Final = 3
"""Of tables with an approach, with or without estimator: an older reader neither acts before the entrance nor knows the
gate and the interlock there."""
PASSAGES_VERSION: Final = 4
"""Of tables that decide at sensor passages (see `tuning_tables.passages`): they have no lines."""
SURFACES_VERSION: Final = 5
"""Of tables that decide at any time, with or without slopes, estimator and approach: an older reader would ask them at
rest only."""
DECISIONS_KEY: Final = "decisions"
GAUGE: Final = {"gauge": True, "none": False}
"""What a table of version 5 says at "pressure": whether its lines depend on it."""
VARIABLE: Final = "s_m"
LONGEST_REASON: Final = 400

_KEYS: Final = (
    "format",
    "version",
    "id",
    "created",
    "generator",
    "retarder",
    "cut",
    "target_speed_m_s",
    "polynomial",
    "stages",
    "valid",
    "predicted",
    "validated",
    CHECKSUM_KEY,
)
_VERSION_KEYS: Final = {
    VERSION: ((), ()),
    ESTIMATOR_VERSION: (("estimator",), ()),
    APPROACH_VERSION: (("approach",), ("estimator",)),
    SURFACES_VERSION: ((DECISIONS_KEY, "pressure"), ("approach", "estimator")),
}
"""By version: the keys that it must have besides, and those that it may have."""
_STAGE_KEYS: Final = ("k", "pressure_kpa", *SIDES)
_SLOPE_KEYS: Final = tuple(f"{side}_slope_m_s_per_kpa" for side in SIDES)
_APPROACH_KEYS: Final = ("length_m", "entrance_stage", "interlock")
_ESTIMATOR_KEYS: Final = (
    "speed_noise_m_s",
    "friction_cv",
    "resistance_std_m_s2",
    "path_std",
    "correlation_length_m",
    "frozen_readings",
    "doubted_readings",
    "lost_speed_std_m_s",
    "unlikely_deviation",
    "touch_pressure_kpa",
    "s_m",
    "drive_m2_s2",
    "brake_m2_s2_per_kpa",
)


def to_document(table: ControllerTable) -> dict[str, object]:
    """The document of `table`, in the order in which it is to be read, its checksum last.

    Raises `InvalidTable` where a number is -0.0: RFC 8785 writes it as 0, so the checksum would not cover its sign.
    """
    document: dict[str, object] = {
        "format": FORMAT,
        "version": VERSION,
        "id": table.id,
        "created": table.created,
        **provenance_document(table.generator, table.retarder, table.cut),
        "target_speed_m_s": float(table.target_speed_m_s),
        "polynomial": {"variable": VARIABLE, "degree": table.degree},
        "stages": [_stage_document(stage, table.has_gauge) for stage in table.stages],
        "valid": {"s_m": floats(table.valid.s_m), "v_m_s": floats(table.valid.v_m_s)},
        "predicted": predicted_document(table.predicted),
        "validated": validated_document(table.validated),
    }
    if table.estimator is not None:
        document |= {"version": ESTIMATOR_VERSION, "estimator": _estimator_document(table.estimator)}
    if table.approach is not None:
        document |= {"version": APPROACH_VERSION, "approach": _approach_document(table.approach)}
    if table.decisions is Decisions.AT_ANY_TIME:
        said = next(word for word, gauge in GAUGE.items() if gauge is table.has_gauge)
        document |= {"version": SURFACES_VERSION, DECISIONS_KEY: table.decisions.value, "pressure": said}
    return {**document, CHECKSUM_KEY: document_checksum(document)}


def from_document(document: object, source: str) -> ControllerTable:
    """The table in `document`, as parsed from the file that `source` names in messages.

    Raises `UnknownFormat`, `NewerVersion`, `OlderVersion` for another format or version, `OtherDecisions` for a table
    without lines, and `DamagedTable` for a wrong checksum, a missing or unknown key, a wrong type, and values that make
    no table. Checked in this order.
    """
    members = require_format(document, source, FORMAT, "a controller table")
    version = require_version(members, source, VERSION, SURFACES_VERSION)
    if version == PASSAGES_VERSION:
        raise OtherDecisions(
            f"{source}: version is {version}, a table that decides at sensor passages and has no lines over the path, "
            f"which are needed here; give a table of version {VERSION} to {APPROACH_VERSION} or {SURFACES_VERSION}."
        )
    required, optional = _VERSION_KEYS[version]
    top = Section(members, source, "", _KEYS + required, optional)
    require_checksum(members, top.text(CHECKSUM_KEY), source)
    polynomial = top.section("polynomial", ("variable", "degree"))
    if polynomial.text("variable") != VARIABLE:
        found = polynomial.text("variable")
        raise DamagedTable(f'{source}: polynomial.variable is {found!r:.60}, but only "{VARIABLE}" is allowed.')
    any_time = version == SURFACES_VERSION
    gauge = any_time and _has_gauge(top, source)
    stages = top.sections("stages", _STAGE_KEYS + _SLOPE_KEYS * gauge)
    try:
        table = ControllerTable(
            id=top.text("id"),
            created=top.text("created"),
            generator=read_generator(top),
            retarder=read_retarder(top),
            cut=read_cut(top),
            target_speed_m_s=top.number("target_speed_m_s"),
            degree=polynomial.count("degree"),
            stages=tuple(_stage(section, gauge) for section in stages),
            valid=_valid_range(top.section("valid", ("s_m", "v_m_s"))),
            predicted=read_predicted(top, ("p_stall", "passes") if "estimator" in top else ("p_stall",)),
            validated=read_validated(top),
            estimator=_estimator(top.section("estimator", _ESTIMATOR_KEYS)) if "estimator" in top else None,
            approach=_approach(top.section("approach", _APPROACH_KEYS)) if "approach" in top else None,
            decisions=Decisions.AT_ANY_TIME if any_time else Decisions.AT_REST,
        )
        if table.has_gauge != gauge:
            raise InvalidTable('pressure is "gauge", but no line has a slope: a table without slopes says "none".')
        return table
    except InvalidTable as invalid:
        # The reason may quote a value, and a file may hold one of any length.
        raise DamagedTable(f"{source}: {excerpt(str(invalid), LONGEST_REASON)}") from invalid


def _stage_document(stage: Stage, gauge: bool) -> dict[str, object]:
    lines = {side: None if line is None else floats(line) for side, line in zip(SIDES, stage.lines, strict=True)}
    slopes = (None if slope is None else float(slope) for slope in stage.slopes)
    sloped = dict(zip(_SLOPE_KEYS, slopes, strict=True)) if gauge else {}
    return {"k": stage.k, "pressure_kpa": float(stage.pressure_kpa), **lines, **sloped}


def _has_gauge(top: Section, source: str) -> bool:
    """Whether a table of version 5 has slopes; the document must say when it decides and what of the pressure."""
    decisions, pressure = top.text(DECISIONS_KEY), top.text("pressure")
    if decisions != Decisions.AT_ANY_TIME.value:
        allowed = Decisions.AT_ANY_TIME.value
        raise DamagedTable(f'{source}: decisions is {decisions!r:.60}, but only "{allowed}" is allowed.')
    if pressure not in GAUGE:
        raise DamagedTable(f'{source}: pressure is {pressure!r:.60}, but only "gauge" and "none" are allowed.')
    return GAUGE[pressure]


def _estimator_document(estimator: Estimator) -> dict[str, object]:
    values = {key: getattr(estimator, key) for key in _ESTIMATOR_KEYS}
    return {key: _as_written(value) for key, value in values.items()}


def _as_written(value: float | int | tuple[float, ...]) -> object:
    """Rows and numbers with a decimal point, counts without."""
    if isinstance(value, tuple):
        return floats(value)
    return value if isinstance(value, int) else float(value)


def _approach_document(approach: Approach) -> dict[str, object]:
    return {
        "length_m": float(approach.length_m),
        "entrance_stage": approach.entrance_stage,
        "interlock": INTERLOCK,
    }


def _stage(section: Section, gauge: bool) -> Stage:
    lower, upper = (section.numbers_or_null(side) for side in SIDES)
    slopes = (section.number_or_null(key) for key in _SLOPE_KEYS) if gauge else ()
    return Stage(section.count("k"), section.number("pressure_kpa"), lower, upper, *slopes)


def _valid_range(section: Section) -> ValidRange:
    return ValidRange(section.pair("s_m"), section.pair("v_m_s"))


def _estimator(section: Section) -> Estimator:
    return Estimator(
        section.number("speed_noise_m_s"),
        section.number("friction_cv"),
        section.number("resistance_std_m_s2"),
        section.number("path_std"),
        section.number("correlation_length_m"),
        section.count("frozen_readings"),
        section.count("doubted_readings"),
        section.number("lost_speed_std_m_s"),
        section.number("unlikely_deviation"),
        section.number("touch_pressure_kpa"),
        section.numbers("s_m"),
        section.numbers("drive_m2_s2"),
        section.numbers("brake_m2_s2_per_kpa"),
    )


def _approach(section: Section) -> Approach:
    interlock = section.text("interlock")
    if interlock != INTERLOCK:
        raise InvalidTable(f'approach.interlock is {interlock!r}, but only "{INTERLOCK}" is allowed.')
    return Approach(section.number("length_m"), section.count("entrance_stage"))
