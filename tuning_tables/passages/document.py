"""A table for point sensors as a JSON document (dicts, lists, numbers, strings), and back, without the text around."""

from __future__ import annotations

from typing import Final

from tuning_tables.approach import INTERLOCK, Approach
from tuning_tables.canonical import CHECKSUM_KEY, document_checksum
from tuning_tables.document import FORMAT, LONGEST_REASON, PASSAGES_VERSION, SURFACES_VERSION, VERSION
from tuning_tables.document_head import require_checksum, require_format, require_version
from tuning_tables.errors import DamagedTable, InvalidTable, OtherDecisions
from tuning_tables.excerpt import excerpt
from tuning_tables.figures_document import predicted_document, read_predicted, read_validated, validated_document
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.passages_document import (
    passages_document,
    plausible_document,
    read_passages,
    read_plausible,
    read_sensors,
    sensors_document,
)
from tuning_tables.provenance_document import (
    floats,
    provenance_document,
    read_cut,
    read_generator,
    read_retarder,
)
from tuning_tables.section import Section

DECISIONS: Final = "at_sensor_passages"

_KEYS: Final = (
    "format",
    "version",
    "decisions",
    "id",
    "created",
    "generator",
    "retarder",
    "cut",
    "target_speed_m_s",
    "stages",
    "sensors",
    "approach",
    "passages",
    "plausible",
    "valid",
    "predicted",
    "validated",
    CHECKSUM_KEY,
)
_APPROACH_KEYS: Final = ("length_m", "entrance_stage", "initial_stage", "interlock")


def to_passage_document(table: PassageTable) -> dict[str, object]:
    """The document of `table`, in the order in which it is to be read, its checksum last."""
    document: dict[str, object] = {
        "format": FORMAT,
        "version": PASSAGES_VERSION,
        "decisions": DECISIONS,
        "id": table.id,
        "created": table.created,
        **provenance_document(table.generator, table.retarder, table.cut),
        "target_speed_m_s": float(table.target_speed_m_s),
        "stages": [{"k": k, "pressure_kpa": float(pressure)} for k, pressure in enumerate(table.pressure_kpa)],
        "sensors": sensors_document(table.sensors),
        "approach": {
            "length_m": float(table.approach.length_m),
            "entrance_stage": table.approach.entrance_stage,
            "initial_stage": table.initial_stage,
            "interlock": INTERLOCK,
        },
        "passages": passages_document(table.passages),
        "plausible": plausible_document(table.plausible),
        "valid": {"v_m_s": floats(table.valid_v_m_s)},
        "predicted": predicted_document(table.predicted),
        "validated": validated_document(table.validated),
    }
    return {**document, CHECKSUM_KEY: document_checksum(document)}


def from_passage_document(document: object, source: str) -> PassageTable:
    """The table in `document`, as parsed from the file that `source` names in messages.

    Raises `UnknownFormat`, `NewerVersion`, `OlderVersion` for another format or version, `OtherDecisions` for a table
    with lines, and `DamagedTable` for a wrong checksum, a missing or unknown key, a wrong type, and values that make no
    table. Checked in this order.
    """
    members = require_format(document, source, FORMAT, "a controller table")
    version = require_version(members, source, VERSION, SURFACES_VERSION)
    if version != PASSAGES_VERSION:
        raise OtherDecisions(
            f"{source}: version is {version}, a table with lines over the path, but here one is needed that decides at "
            f"sensor passages; give a table of version {PASSAGES_VERSION}."
        )
    top = Section(members, source, "", _KEYS)
    require_checksum(members, top.text(CHECKSUM_KEY), source)
    if top.text("decisions") != DECISIONS:
        raise DamagedTable(f'{source}: decisions is {top.text("decisions")!r:.60}, but only "{DECISIONS}" is allowed.')
    try:
        approach, initial_stage = _approach(top.section("approach", _APPROACH_KEYS))
        return PassageTable(
            id=top.text("id"),
            created=top.text("created"),
            generator=read_generator(top),
            retarder=read_retarder(top),
            cut=read_cut(top),
            target_speed_m_s=top.number("target_speed_m_s"),
            pressure_kpa=_pressures(top.sections("stages", ("k", "pressure_kpa"))),
            sensors=read_sensors(top),
            approach=approach,
            initial_stage=initial_stage,
            passages=read_passages(top),
            plausible=read_plausible(top),
            valid_v_m_s=top.section("valid", ("v_m_s",)).pair("v_m_s"),
            predicted=read_predicted(top, ("p_stall",)),
            validated=read_validated(top),
        )
    except InvalidTable as invalid:
        # The reason may quote a value, and a file may hold one of any length.
        raise DamagedTable(f"{source}: {excerpt(str(invalid), LONGEST_REASON)}") from invalid


def _pressures(stages: list[Section]) -> tuple[float, ...]:
    for index, stage in enumerate(stages):
        if stage.count("k") != index:
            raise InvalidTable(f"stages[{index}].k is {stage.count('k')}, but stages must be numbered 0, 1, 2, ...")
    return tuple(stage.number("pressure_kpa") for stage in stages)


def _approach(section: Section) -> tuple[Approach, int]:
    interlock = section.text("interlock")
    if interlock != INTERLOCK:
        raise InvalidTable(f'approach.interlock is {interlock!r}, but only "{INTERLOCK}" is allowed.')
    approach = Approach(section.number("length_m"), section.count("entrance_stage"))
    return approach, section.count("initial_stage")
