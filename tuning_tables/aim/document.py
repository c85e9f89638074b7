"""An aim table as a JSON document (dicts, lists, numbers, strings), and back, without the text around it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final, NoReturn

import numpy as np

from tuning_tables.aim.aim_table import AimTable
from tuning_tables.aim.axes import AimAxes
from tuning_tables.aim.nodes import Nodes
from tuning_tables.aim.purpose import (
    AimCategory,
    CategoryAlone,
    Knowledge,
    MeasuredResistance,
    ParkPosition,
    Required,
)
from tuning_tables.aim.reported import FIGURES, Reported
from tuning_tables.canonical import CHECKSUM_KEY, document_checksum
from tuning_tables.document_head import require_checksum, require_format, require_version
from tuning_tables.errors import DamagedTable, InvalidTable
from tuning_tables.excerpt import excerpt
from tuning_tables.provenance import Generator
from tuning_tables.section import Section

AIM_FORMAT: Final = "aim-table"
AIM_VERSION: Final = 1
LONGEST_REASON: Final = 400

CATEGORY_KIND: Final = "category"
MEASURED_KIND: Final = "measured_resistance"
KNOWLEDGE_KEYS: Final[Mapping[str, tuple[str, ...]]] = {
    CATEGORY_KIND: ("kind",),
    MEASURED_KIND: ("kind", "from_m", "to_m", "speed_std_m_s"),
}

_KEYS: Final = (
    "format",
    "version",
    "id",
    "created",
    "generator",
    "position",
    "category",
    "required",
    "knowledge",
    "axes",
    "exit_speed_m_s",
    "bounds",
    "interpolation",
    "reported",
    CHECKSUM_KEY,
)


def to_aim_document(table: AimTable) -> dict[str, object]:
    """The document of `table`, in the order in which it is to be read, its checksum last."""
    axes = table.axes
    resistance = axes.resistance_n_per_kn
    generator = table.generator
    document: dict[str, object] = {
        "format": AIM_FORMAT,
        "version": AIM_VERSION,
        "id": table.id,
        "created": table.created,
        "generator": {
            "name": generator.name,
            "version": generator.version,
            "config_sha256": generator.config_sha256,
        },
        "position": {"name": table.position.name, "exit_at_m": float(table.position.exit_at_m)},
        "category": {"number": table.category.number, "name": table.category.name},
        "required": {
            "p_overspeed": float(table.required.p_overspeed),
            "coupling_speed_m_s": float(table.required.coupling_speed_m_s),
        },
        "knowledge": _knowledge_document(table.knowledge),
        "axes": {
            "cars": axes.cars.tolist(),
            "free_distance_m": axes.free_distance_m.tolist(),
            "resistance_n_per_kn": None if resistance is None else resistance.tolist(),
        },
        "exit_speed_m_s": _nested(table.exit_speed_m_s),
        "bounds": {"exit_speed_m_s": [float(bound) for bound in table.bounds_m_s]},
        "interpolation": {"error_m_s": float(table.interpolation_error_m_s)},
        "reported": {
            "passes": table.reported.passes,
            **{name: _nested(getattr(table.reported, name)) for name in FIGURES},
        },
    }
    return {**document, CHECKSUM_KEY: document_checksum(document)}


def from_aim_document(document: object, source: str) -> AimTable:
    """The table in `document`, as parsed from the file that `source` names in messages.

    Raises `UnknownFormat`, `NewerVersion`, `OlderVersion` for another format or version, and `DamagedTable` for a wrong
    checksum, a missing or unknown key, a wrong type, and values that make no table. Checked in this order.
    """
    members = require_format(document, source, AIM_FORMAT, "an aim table")
    require_version(members, source, AIM_VERSION, AIM_VERSION)
    top = Section(members, source, "", _KEYS)
    require_checksum(members, top.text(CHECKSUM_KEY), source)
    generator = top.section("generator", ("name", "version", "config_sha256"))
    position = top.section("position", ("name", "exit_at_m"))
    category = top.section("category", ("number", "name"))
    required = top.section("required", ("p_overspeed", "coupling_speed_m_s"))
    try:
        axes = _axes(top.section("axes", ("cars", "free_distance_m", "resistance_n_per_kn")))
        return AimTable(
            id=top.text("id"),
            created=top.text("created"),
            generator=Generator(generator.text("name"), generator.text("version"), generator.text("config_sha256")),
            position=ParkPosition(position.text("name"), position.number("exit_at_m")),
            category=AimCategory(category.count("number"), category.text("name")),
            required=Required(required.number("p_overspeed"), required.number("coupling_speed_m_s")),
            knowledge=_knowledge(top),
            axes=axes,
            exit_speed_m_s=_nodes(top, "exit_speed_m_s", axes.shape),
            bounds_m_s=top.section("bounds", ("exit_speed_m_s",)).pair("exit_speed_m_s"),
            interpolation_error_m_s=top.section("interpolation", ("error_m_s",)).number("error_m_s"),
            reported=_reported(top.section("reported", ("passes", *FIGURES)), axes.shape),
        )
    except InvalidTable as invalid:
        # The reason may quote a value, and a file may hold one of any length.
        raise DamagedTable(f"{source}: {excerpt(str(invalid), LONGEST_REASON)}") from invalid


def _knowledge_document(knowledge: Knowledge) -> dict[str, object]:
    if isinstance(knowledge, CategoryAlone):
        return {"kind": CATEGORY_KIND}
    return {
        "kind": MEASURED_KIND,
        "from_m": float(knowledge.from_m),
        "to_m": float(knowledge.to_m),
        "speed_std_m_s": float(knowledge.speed_std_m_s),
    }


def _knowledge(top: Section) -> Knowledge:
    match top.value("knowledge"):
        case {"kind": str(kind)} if kind in KNOWLEDGE_KEYS:
            section = top.section("knowledge", KNOWLEDGE_KEYS[kind])
        case other:
            known = ", ".join(KNOWLEDGE_KEYS)
            raise InvalidTable(f"knowledge is {other!r:.60}, but it must be an object whose kind is one of {known}.")
    if kind == CATEGORY_KIND:
        return CategoryAlone()
    return MeasuredResistance(section.number("from_m"), section.number("to_m"), section.number("speed_std_m_s"))


def _axes(section: Section) -> AimAxes:
    resistance = section.numbers_or_null("resistance_n_per_kn")
    return AimAxes(
        np.array(section.counts("cars")),
        np.array(section.numbers("free_distance_m")),
        None if resistance is None else np.array(resistance),
    )


def _reported(section: Section, shape: tuple[int, ...]) -> Reported:
    return Reported(section.count("passes"), *(_nodes(section, name, shape, "reported.") for name in FIGURES))


def _nodes(section: Section, key: str, shape: tuple[int, ...], parent: str = "") -> Nodes:
    return np.array(_checked(section.value(key), f"{parent}{key}", shape), dtype=np.float64)


def _checked(value: object, key: str, shape: tuple[int, ...]) -> Any:
    """`value`, arrays in arrays of exactly this shape, with NaN for null; raises `InvalidTable`."""
    if not shape:
        if value is None:
            return np.nan
        if not isinstance(value, int | float) or isinstance(value, bool):
            _refuse(value, key, "a number or null")
        return float(value)
    if not isinstance(value, list) or len(value) != shape[0]:
        _refuse(value, key, f"an array of {shape[0]}, as the axes say")
    return [_checked(item, f"{key}[{index}]", shape[1:]) for index, item in enumerate(value)]


def _refuse(value: object, key: str, wanted: str) -> NoReturn:
    raise InvalidTable(f"{key} is {excerpt(repr(value))}, but it must be {wanted}.")


def _nested(nodes: Nodes) -> list[object]:
    """Arrays in arrays, null where there is no number."""
    if nodes.ndim > 1:
        return [_nested(part) for part in nodes]
    return [None if np.isnan(value) else float(value) for value in nodes]
