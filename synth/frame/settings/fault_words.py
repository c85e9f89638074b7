"""Words for values that are at fault, in files and on command lines."""

from __future__ import annotations

from typing import Any

ALLOWED = {
    "float_type": "a number",
    "int_type": "a whole number",
    "string_type": "a string in quotes",
    "bool_type": "true or false",
    "finite_number": "a finite number",
    "model_type": "a table",
    "dict_type": "a table",
    "tuple_type": "a list",
    "string_pattern_mismatch": "made of at most 61 letters, digits, dots, hyphens and underscores",
}
"""What a value must be, by pydantic's error type."""


def shown(value: Any) -> str:
    """A value as the file writes it, cut off if long."""
    text = str(value).lower() if isinstance(value, bool) else repr(value)
    return text if len(text) <= 80 else text[:77] + "…"
