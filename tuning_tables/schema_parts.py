"""What JSON Schemas (draft 2020-12) are built from."""

from __future__ import annotations

from typing import Any, Final

DIALECT: Final = "https://json-schema.org/draft/2020-12/schema"


def object_of(**properties: object) -> dict[str, Any]:
    """All `properties` and no others; all are required."""
    return {
        "type": "object",
        "properties": dict(properties),
        "required": list(properties),
        "additionalProperties": False,
    }


def array_of(items: object, fewest: int, most: int | None = None) -> dict[str, object]:
    """An array of `items`, from `fewest` to `most` of them."""
    bounds = {"minItems": fewest} if most is None else {"minItems": fewest, "maxItems": most}
    return {"type": "array", "items": items, **bounds}


def pair_of(items: object) -> dict[str, object]:
    """An array of two `items`."""
    return array_of(items, 2, 2)


def number(smallest: float | None = None, largest: float | None = None) -> dict[str, object]:
    """A number within the bounds that are given."""
    return _bounded("number", smallest, largest)


def whole(smallest: int, largest: int | None = None) -> dict[str, object]:
    """A whole number within the bounds that are given."""
    return _bounded("integer", smallest, largest)


def _bounded(kind: str, smallest: float | None, largest: float | None) -> dict[str, object]:
    bounds = {"minimum": smallest, "maximum": largest}
    return {"type": kind, **{key: bound for key, bound in bounds.items() if bound is not None}}


def above_zero() -> dict[str, object]:
    """A number greater than 0."""
    return {"type": "number", "exclusiveMinimum": 0}


def text() -> dict[str, object]:
    """A string that is not empty."""
    return {"type": "string", "minLength": 1}
