"""The numbers of declared settings, each with unit, range and origin."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, Final

from pydantic.fields import FieldInfo

from plant_models.library import SourcedValue
from plant_models.library.sourced_value import SET_BY_USER
from synth.frame.settings.section import Section, setting_limits, setting_source, setting_unit

DIMENSIONLESS: Final = "1"

NAMES: Final = ("name", "label", "input")
"""The key of a table in a list that tells it from the others, if it has one; else its number does."""

SOURCE: Final = "source"
"""The key of a table that tells where its numbers are from."""


def numbers_of(section: Section, path: str = "", usual: Section | None = None) -> Iterator[SourcedValue]:
    """Every number of `section` that is declared with a unit, by its dotted key below `path`.

    `usual`: the same section with the values that the tool gives it; None: those that it declares. A number that
    differs is the user's, and so are those of a list that differs.
    """
    for key, field in type(section).model_fields.items():
        value, name = getattr(section, key), f"{path}.{key}".lstrip(".")
        default = field.default if usual is None else getattr(usual, key)
        if isinstance(value, Section):
            yield from numbers_of(value, name, default if isinstance(default, Section) else None)
        elif holds_sections(value):
            same = value == default
            for place, each in enumerate(value):
                yield from listed_numbers(each, f"{name}.{name_of(each, place)}", same)
        elif is_declared_number(value, field):
            yield sourced(name, value, field, value == default)


def listed_numbers(section: Section, path: str, usual: bool) -> Iterator[SourcedValue]:
    """The numbers of a table of a list; `usual`: the list is the tool's own."""
    told = getattr(section, SOURCE, None)
    for key, field in type(section).model_fields.items():
        value = getattr(section, key)
        if is_declared_number(value, field):
            number = sourced(f"{path}.{key}", value, field, usual)
            yield SourcedValue(number.key, number.value, number.unit, number.range, told or number.source, "")


def sourced(key: str, value: float, field: FieldInfo, usual: bool) -> SourcedValue:
    """One number; whose it is."""
    source = setting_source(field) if usual and setting_source(field) else SET_BY_USER
    return SourcedValue(key, float(value), setting_unit(field), setting_limits(field), source, "")


def name_of(section: Section, place: int) -> str:
    """What a table of a list is called in keys."""
    found = (getattr(section, key) for key in NAMES if key in type(section).model_fields)
    return str(next(found, place))


def holds_sections(value: Any) -> bool:
    """A list of tables."""
    return isinstance(value, tuple) and bool(value) and all(isinstance(each, Section) for each in value)


def is_declared_number(value: Any, field: FieldInfo) -> bool:
    """A number with a unit."""
    return isinstance(value, int | float) and not isinstance(value, bool) and bool(setting_unit(field))


def range_warnings(parameters: Sequence[SourcedValue]) -> Iterator[str]:
    """A sentence for every value outside its sensible range."""
    for p in parameters:
        if p.range is not None and not p.in_range:
            unit = "" if p.unit == DIMENSIONLESS else f" {p.unit}"
            yield f"{p.key} is {p.value!r}; its sensible range is {p.range[0]:g} to {p.range[1]:g}{unit}"
