"""Numbers that a file writes with a unit of its own, "4 mph": turned into the unit that is declared for them."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, Final

UNITS: Final[Mapping[str, Mapping[str, float]]] = {
    "m/s": {"m/s": 1.0, "km/h": 1.0 / 3.6, "mph": 0.44704, "ft/s": 0.3048},
    "m": {"m": 1.0, "ft": 0.3048, "yd": 0.9144},
    "t": {"t": 1.0, "kg": 0.001, "short tons": 0.90718474, "long tons": 1.0160469088, "lb": 0.00045359237},
    "permille": {"permille": 1.0, "%": 10.0},
}
"""By declared unit: what a file may write, and how much of the declared unit it is. "tons" alone are no unit: they may
be short or long ones."""

IN_NAMES: Final = {"_m_s": "m/s", "_m": "m", "_t": "t", "_permille": "permille"}
"""By the end of a key: the unit that it has."""

WRITTEN: Final = re.compile(r"([-+]?[0-9]+(?:\.[0-9]+)?) ?([^0-9]+)")


def in_unit(raw: Any, unit: str) -> Any:
    """`raw` with each number that is written with a unit as a number in `unit`; all else as it is. A list or a table is
    taken value by value."""
    if isinstance(raw, list):
        return [in_unit(each, unit) for each in raw]
    if isinstance(raw, dict):
        return {key: in_unit(each, unit) for key, each in raw.items()}
    found = WRITTEN.fullmatch(raw) if isinstance(raw, str) else None
    factor = UNITS.get(unit, {}).get(found[2]) if found else None
    return raw if found is None or factor is None else float(found[1]) * factor


def unit_in_name(key: str) -> str:
    """The unit that ends `key`, of those that may be written in another way; '' where it has none of them."""
    found = (unit for end, unit in IN_NAMES.items() if key.endswith(end) and not key.endswith(f"_per{end}"))
    return next(found, "")


def words_for(raw: object, unit: str) -> str:
    """What `raw` must be, where it is no number but could be one with a unit; '' where it could not."""
    if not isinstance(raw, str) or unit not in UNITS:
        return ""
    return f"a number in {unit}, or in quotes a number with one of the units {', '.join(UNITS[unit])}"


def unit_schema(unit: str) -> dict[str, Any] | None:
    """The JSON Schema of a number with its unit; None where `unit` alone is allowed."""
    if unit not in UNITS:
        return None
    return {"type": "string", "pattern": rf"^[-+]?[0-9]+(\.[0-9]+)? ?({'|'.join(UNITS[unit])})$"}
