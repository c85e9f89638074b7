"""A table of a configuration file, and the declaration of a setting in it.

A setting is declared once: value, unit, range, meaning, source. The commented template, the check of a file, the list
of parameters, the options of the command line and the JSON Schema follow from the declaration.
"""

from __future__ import annotations

from typing import Any

from annotated_types import Ge, Le, MaxLen, MinLen
from pydantic import BaseModel, ConfigDict, Field
from pydantic.fields import FieldInfo

TOOL_DEFAULT = "default of the tool"


def setting(default: float, unit: str, low: float, high: float, meaning: str, source: str = TOOL_DEFAULT) -> Any:
    """A numerical setting with its unit, its limits (both allowed), what it means, and where its default is from."""
    return Field(default, ge=low, le=high, description=meaning, json_schema_extra={"unit": unit, "source": source})


def needed(unit: str, low: float, high: float, meaning: str, source: str = TOOL_DEFAULT) -> Any:
    """The same without a default of its own; `source`: of the values that the tool gives it."""
    return Field(ge=low, le=high, description=meaning, json_schema_extra={"unit": unit, "source": source})


def optional(unit: str, low: float, high: float, meaning: str, example: float) -> Any:
    """A number that may be left out; the template shows `example` as a comment."""
    return Field(
        None, ge=low, le=high, description=meaning, examples=[example], json_schema_extra={"unit": unit, "source": ""}
    )


def choice(default: object, meaning: str) -> Any:
    """A word, a switch, a name or a path."""
    return Field(default, description=meaning)


def many(default: object, low: int, high: int, entries: str, strict: bool = False) -> Any:
    """A list of `low` to `high` `entries`, as sentences call them; `strict`: a table of them by name."""
    return Field(default, min_length=low, max_length=high, strict=strict, json_schema_extra={"entries": entries})


class Section(BaseModel):
    """A table of the file: unknown keys, wrong types, inf and nan are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)


def setting_unit(field: FieldInfo) -> str:
    """Unit of a field made by `setting`, '' of another one."""
    return extra_of(field, "unit")


def setting_source(field: FieldInfo) -> str:
    """Where the default of a field made by `setting` is from."""
    return extra_of(field, "source")


def extra_of(field: FieldInfo, key: str) -> str:
    """What `setting` has noted of a field under `key`."""
    extra = field.json_schema_extra
    return str(extra[key]) if isinstance(extra, dict) and key in extra else ""


def length_limits(field: FieldInfo) -> tuple[int, int]:
    """How many entries a list made by `many` may have."""
    low = [m.min_length for m in field.metadata if isinstance(m, MinLen)]
    high = [m.max_length for m in field.metadata if isinstance(m, MaxLen)]
    return low[0], high[0]


def setting_limits(field: FieldInfo) -> tuple[float, float] | None:
    """Lowest and highest allowed value of a field, or None."""
    low = [float(m.ge) for m in field.metadata if isinstance(m, Ge)]  # type: ignore[arg-type]  # ge is a number here
    high = [float(m.le) for m in field.metadata if isinstance(m, Le)]  # type: ignore[arg-type]
    return (low[0], high[0]) if low and high else None
