"""An aim table read from its JSON document, as docs/aim-table.md has it."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

from synth.checker.canonical import canonical_form, crc32, parse_json, without_checksum
from synth.checker.document_shape import COUNT, NUMBER, TEXT, OrNull, Pair, refuse_unless, require_shape
from synth.checker.finding import DamagedError, shown

NodeValues = tuple[tuple[tuple[float | None, ...], ...], ...]
"""By cars, free distance, resistance; one resistance in a table by category alone. None: no exit speed."""

MARK: Final = re.compile(rb'"format"\s*:\s*"aim-table"')
"""No text in a JSON document can hold this: its quotes would be escaped."""

FIGURES: Final = ("p_overspeed", "p_overspeed_low95", "p_overspeed_high95", "mean_gap_m")
CATEGORY: Final[Mapping[str, Any]] = {"kind": TEXT}
MEASURED: Final[Mapping[str, Any]] = {"kind": TEXT, "from_m": NUMBER, "to_m": NUMBER, "speed_std_m_s": NUMBER}
SHAPE: Final[Mapping[str, Any]] = {
    "format": TEXT,
    "version": COUNT,
    "id": TEXT,
    "created": TEXT,
    "generator": {"name": TEXT, "version": TEXT, "config_sha256": TEXT},
    "position": {"name": TEXT, "exit_at_m": NUMBER},
    "category": {"number": COUNT, "name": TEXT},
    "required": {"p_overspeed": NUMBER, "coupling_speed_m_s": NUMBER},
    "bounds": {"exit_speed_m_s": Pair()},
    "interpolation": {"error_m_s": NUMBER},
    "crc32": TEXT,
}
"""Of both kinds; what depends on the kind is added by `shape_of`."""


@dataclass(frozen=True)
class Aim:
    """An aim table as the controller must understand it, and the document it was read from (less its checksum).

    `resistances` is empty in a table by category alone. `figures`: what was reported at the nodes, by name.
    """

    id: str
    category: int
    category_name: str
    p_overspeed: float
    coupling_m_s: float
    cars: tuple[int, ...]
    distances_m: tuple[float, ...]
    resistances: tuple[float, ...]
    speeds: NodeValues
    bounds_m_s: tuple[float, float]
    figures: Mapping[str, NodeValues]
    document: Mapping[str, Any]

    @property
    def is_measured(self) -> bool:
        """Whether the resistance of the cut is asked for."""
        return bool(self.resistances)

    def places(self) -> list[tuple[int, int, int]]:
        """The indices of all nodes, in their order in the file."""
        return [
            (c, d, r)
            for c in range(len(self.cars))
            for d in range(len(self.distances_m))
            for r in range(max(1, len(self.resistances)))
        ]


def read_aim(content: bytes) -> Aim:
    """The table in the JSON text `content`; `DamagedError` for whatever is not one, a wrong checksum among it."""
    document = parse_json(content)
    if not isinstance(document, dict) or document.get("format") != "aim-table":
        raise DamagedError('it is no aim table: its format is not "aim-table"')
    if document.get("version") != 1 or not isinstance(document["version"], int):
        raise DamagedError(f"its version is {shown(document.get('version'))}, but this checker knows version 1 only")
    require_shape(document, shape_of(document), "")
    sum_found = f"{crc32(canonical_form(without_checksum(document)).encode('utf-8')):08x}"
    if document["crc32"] != sum_found:
        raise DamagedError(f"its crc32 is {shown(document['crc32'])}, but its content gives {sum_found}")
    return aim_of(without_checksum(document))


def shape_of(document: Mapping[str, Any]) -> Mapping[str, Any]:
    """What the document must look like, by the kind of knowledge that it states."""
    knowledge = document.get("knowledge")
    kind = knowledge.get("kind") if isinstance(knowledge, dict) else None
    refuse_unless(kind in ("category", "measured_resistance"), kind, "knowledge.kind", "category, measured_resistance")
    measured = kind == "measured_resistance"
    nodes: Any = [[[OrNull(NUMBER)]]] if measured else [[OrNull(NUMBER)]]
    axes = {"cars": [COUNT], "free_distance_m": [NUMBER]}
    return {
        **SHAPE,
        "knowledge": MEASURED if measured else CATEGORY,
        "axes": {**axes, "resistance_n_per_kn": [NUMBER] if measured else None},
        "exit_speed_m_s": nodes,
        "reported": {"passes": COUNT, **dict.fromkeys(FIGURES, nodes)},
    }


def aim_of(document: Mapping[str, Any]) -> Aim:
    """The table in a document of the right shape; `DamagedError` where its arrays do not fit its axes."""
    axes, required = document["axes"], document["required"]
    resistances = tuple(map(float, axes["resistance_n_per_kn"] or ()))
    lengths = (len(axes["cars"]), len(axes["free_distance_m"]), *([len(resistances)] if resistances else []))
    low, high = document["bounds"]["exit_speed_m_s"]
    return Aim(
        id=document["id"],
        category=document["category"]["number"],
        category_name=document["category"]["name"],
        p_overspeed=float(required["p_overspeed"]),
        coupling_m_s=float(required["coupling_speed_m_s"]),
        cars=tuple(axes["cars"]),
        distances_m=tuple(map(float, axes["free_distance_m"])),
        resistances=resistances,
        speeds=nodes_of(document["exit_speed_m_s"], lengths, "exit_speed_m_s"),
        bounds_m_s=(float(low), float(high)),
        figures={name: nodes_of(document["reported"][name], lengths, f"reported.{name}") for name in FIGURES},
        document=document,
    )


def nodes_of(value: Any, lengths: tuple[int, ...], path: str) -> NodeValues:
    """The numbers at the nodes, with a third axis in any case."""
    refuse_unless(len(value) == lengths[0], len(value), f"the length of {path}", str(lengths[0]))
    for c, rows in enumerate(value):
        refuse_unless(len(rows) == lengths[1], len(rows), f"the length of {path}[{c}]", str(lengths[1]))
        for d, row in enumerate(rows if len(lengths) > 2 else ()):
            refuse_unless(len(row) == lengths[2], len(row), f"the length of {path}[{c}][{d}]", str(lengths[2]))
    plain = value if len(lengths) > 2 else [[[cell] for cell in rows] for rows in value]
    return tuple(tuple(tuple(None if x is None else float(x) for x in row) for row in rows) for rows in plain)
