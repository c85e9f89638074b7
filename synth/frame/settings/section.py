"""A table of a configuration file, the declaration of a setting in it, and the section that says what is written
besides figures.

A setting is declared once: value, unit, range, meaning, source. The commented template, the check of a file, the list
of parameters, the options of the command line and the JSON Schema follow from the declaration.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, ClassVar, get_args

from annotated_types import Ge, Le, MaxLen, MinLen
from pydantic import BaseModel, ConfigDict, Field, model_validator
from pydantic.fields import FieldInfo

DIMENSIONLESS = "1"

TOOL_DEFAULT = "default of the tool"
OF_LIBRARY = "the type in the library"


def setting(default: float, unit: str, low: float, high: float, meaning: str, source: str = TOOL_DEFAULT) -> Any:
    """A numerical setting with its unit, its limits (both allowed), what it means, and where its default is from."""
    return Field(default, ge=low, le=high, description=meaning, json_schema_extra={"unit": unit, "source": source})


def needed(unit: str, low: float, high: float, meaning: str, source: str = TOOL_DEFAULT) -> Any:
    """The same without a default of its own; `source`: of the values that the tool gives it."""
    return Field(ge=low, le=high, description=meaning, json_schema_extra={"unit": unit, "source": source})


def optional(unit: str, low: float, high: float, meaning: str, example: float, source: str = "") -> Any:
    """A number that may be left out; the template shows `example` as a comment. `source`: of what the tool then has."""
    return Field(
        None,
        ge=low,
        le=high,
        description=meaning,
        examples=[example],
        json_schema_extra={"unit": unit, "source": source},
    )


def of_library(meaning: str, example: object = None) -> Any:
    """What a type of the library has, unless the file says otherwise: value, unit, range and source are those of the
    type; the template shows `example` as a comment where the type has no such value."""
    examples = None if example is None else [example]
    return Field(None, description=meaning, examples=examples, json_schema_extra={"source": OF_LIBRARY})


def choice(default: object, meaning: str, example: object = None) -> Any:
    """A word, a switch, a name or a path; the template shows `example` as a comment where `default` is None."""
    return Field(default, description=meaning, examples=None if example is None else [example])


def many(
    default: object, low: int, high: int, entries: str, meaning: str = "", unit: str = "", source: str = "",
    example: object = None,
) -> Any:  # fmt: skip
    """A list, or a table by name, of `low` to `high` `entries`, as sentences call them.

    Numbers have a `unit`, the `source` of the default, and their limits in the annotation, as in `tuple[Share, ...]`.
    """
    return Field(
        default,
        min_length=low,
        max_length=high,
        strict=False,
        description=meaning or None,
        examples=None if example is None else [example],
        json_schema_extra={"entries": entries, "unit": unit, "source": source},
    )


class Section(BaseModel):
    """A table of the file: unknown keys, wrong types, inf and nan are refused; a number may have a unit of its own.

    `MEANT`: words that users write for keys that have another name.
    """

    MEANT: ClassVar[Mapping[str, str]] = {}

    model_config = ConfigDict(extra="forbid", frozen=True, strict=True, allow_inf_nan=False)

    @model_validator(mode="before")
    @classmethod
    def _in_declared_units(cls, given: Any) -> Any:
        """Numbers that are written with another unit, in the declared one."""
        if not isinstance(given, dict):
            return given
        fields = {key: field for key, field in cls.model_fields.items() if setting_unit(field) or is_of_library(field)}
        written = [key for key, value in given.items() if key in fields and isinstance(value, str | list | dict)]
        if not written:
            return given
        from plant_models.library.hump_forms import in_unit, unit_in_name  # the package of the plant has numpy

        units = {key: setting_unit(fields[key]) or unit_in_name(key) for key in written}
        return {key: in_unit(value, units[key]) if key in units else value for key, value in given.items()}


def setting_unit(field: FieldInfo) -> str:
    """Unit of a declared number, or of those of a list; '' of another field."""
    return extra_of(field, "unit")


def is_of_library(field: FieldInfo) -> bool:
    """Whether a type of the library has the value and its unit, which stands in the key."""
    return setting_source(field) == OF_LIBRARY


def setting_source(field: FieldInfo) -> str:
    """Where the default of a declared number is from."""
    return extra_of(field, "source")


def extra_of(field: FieldInfo, key: str) -> str:
    """What a declaration has noted of a field under `key`."""
    extra = field.json_schema_extra
    return str(extra[key]) if isinstance(extra, dict) and key in extra else ""


def length_limits(field: FieldInfo) -> tuple[int, int]:
    """How many entries a list made by `many` may have."""
    low = [m.min_length for m in field.metadata if isinstance(m, MinLen)]
    high = [m.max_length for m in field.metadata if isinstance(m, MaxLen)]
    return low[0], high[0]


def setting_limits(field: FieldInfo) -> tuple[float, float] | None:
    """Lowest and highest allowed value of a field, or of each number of a list; None where there are no limits."""
    of_each = (part for part in parts_of(field.annotation) if isinstance(part, FieldInfo))
    held = [*field.metadata, *(limit for each in of_each for limit in each.metadata)]
    low = [float(m.ge) for m in held if isinstance(m, Ge)]  # type: ignore[arg-type]  # ge is a number here
    high = [float(m.le) for m in held if isinstance(m, Le)]  # type: ignore[arg-type]
    return (low[0], high[0]) if low and high else None


def sections_in(field: FieldInfo) -> list[type[Section]]:
    """The section that a field holds, or a list of; empty for a plain value."""
    return [c for c in parts_of(field.annotation) if isinstance(c, type) and issubclass(c, Section)]


def parts_of(annotation: Any) -> Iterator[Any]:
    """A type, and all that it is made of."""
    yield annotation
    for part in get_args(annotation):
        yield from parts_of(part)


class OutputSettings(Section):
    """What is written besides figures; changes no result and no hash."""

    plots: bool = choice(True, "draw the pictures")
    report: bool = choice(True, "write report.html")
    workbook: bool = choice(False, "write sheets.xlsx, all tables in one workbook")
