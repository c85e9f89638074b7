"""What a value of each form may be, as JSON Schema."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Final

from plant_models.library.data_file import Form, number, number_or_pairs, numbers, pairs

Json = dict[str, Any]

NUMBER: Final[Json] = {"type": "number"}


def rows_of(count: int, fewest: int = 0) -> Json:
    """A list of rows of so many numbers."""
    row = {"type": "array", "items": NUMBER, "minItems": count, "maxItems": count}
    return {"type": "array", "items": row, "minItems": fewest}


FORMS: Final[Mapping[Form, Json]] = {
    number: NUMBER,
    numbers: {"type": "array", "items": NUMBER, "minItems": 1},
    number_or_pairs: {"anyOf": [NUMBER, rows_of(2, 1)]},
    pairs: rows_of(2, 1),
}
