"""The parts of a JSON Schema that tables of all versions have in common: origin, cut, and figures."""

from __future__ import annotations

from typing import Any

from tuning_tables.category_number import KNOWN_NUMBERS, LARGEST_OWN, LEAST_OWN
from tuning_tables.requirement import SHA256_HEX
from tuning_tables.schema_parts import above_zero, array_of, number, object_of, pair_of, text, whole

FURTHER_FIGURES = {"p_stall": number(0, 1), "passes": whole(1)}


def generator_schema() -> dict[str, Any]:
    """Of the section "generator"."""
    return object_of(name=text(), version=text(), config_sha256={"type": "string", "pattern": SHA256_HEX})


def retarder_schema() -> dict[str, Any]:
    """Of the section "retarder"."""
    zones = array_of(pair_of(number()), 1)
    return object_of(name=text(), zones_m=zones, exit_m=number(), dead_band_kpa=number(0))


def cut_schema() -> dict[str, Any]:
    """Of the section "cut"."""
    cut = object_of(category=text(), mass_t=above_zero(), axle_offsets_m=array_of(number(0), 1))
    cut["properties"]["category_number"] = whole(1, LARGEST_OWN)
    return {**cut, "oneOf": _numbered_cuts()}


def predicted_schema(*further: str) -> dict[str, Any]:
    """Of the section "predicted", which may have the figures `further`."""
    predicted = object_of(rms_m_s=number(0), bias_m_s=number(), p_overspeed=number(0, 1), switchings=number(0))
    predicted["properties"] |= {name: FURTHER_FIGURES[name] for name in further}
    return predicted


def validated_schema() -> dict[str, Any]:
    """Of the section "validated"."""
    validated = object_of(passes=whole(1), rms_m_s=number(0), rms_ci95_m_s=pair_of(number(0)))
    return {"anyOf": [{"type": "null"}, validated]}


def _numbered_cuts() -> list[object]:
    """No number is given, or that of the category of the yard, or one of a user's own category."""
    own = {"category": {"not": {"enum": list(KNOWN_NUMBERS)}}, "category_number": whole(LEAST_OWN, LARGEST_OWN)}
    known = [
        {"category": {"const": name}, "category_number": {"const": number}} for name, number in KNOWN_NUMBERS.items()
    ]
    stated = [{"properties": each, "required": ["category_number"]} for each in (own, *known)]
    return [{"properties": {"category_number": False}}, *stated]
