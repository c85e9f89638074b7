"""The numbers of declared settings, each with unit, range and origin."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any, Final

from pydantic.fields import FieldInfo

from plant_models.library import SourcedValue
from plant_models.library.sourced_value import SET_BY_USER
from synth.frame.settings.section import (
    DIMENSIONLESS,
    OF_LIBRARY,
    Section,
    setting_limits,
    setting_source,
    setting_unit,
)

NAMES: Final = ("name", "label", "input")
"""The key of a table in a list that tells it from the others, if it has one; else its number does."""

SOURCE: Final = "source"
"""The key of a table that tells where its numbers are from."""


def numbers_of(section: Section, path: str = "", usual: Section | None = None) -> Iterator[SourcedValue]:
    """Every number of `section` that is declared with a unit, by its dotted key below `path`; a list of numbers is one.

    `usual`: the same section with the values that the tool gives it; None: those that it declares. A number that
    differs is the user's, and so are those of a list or table by name that differs.
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
        else:
            yield from declared_numbers(name, value, field, value == default)


def library_values(section: Section, path: str = "") -> Iterator[tuple[str, Any]]:
    """What `section` and its tables say in place of types of the library, by dotted key below `path`; numbers as
    floats."""
    for key, field in type(section).model_fields.items():
        value, name = getattr(section, key), f"{path}.{key}".lstrip(".")
        if isinstance(value, Section):
            yield from library_values(value, name)
        elif value is not None and setting_source(field) == OF_LIBRARY:
            yield name, float(value) if isinstance(value, int) else value


def listed_numbers(section: Section, path: str, usual: bool) -> Iterator[SourcedValue]:
    """The numbers of a table of a list; `usual`: the list is the tool's own."""
    told = getattr(section, SOURCE, None)
    for key, field in type(section).model_fields.items():
        value = getattr(section, key)
        for number in declared_numbers(f"{path}.{key}", value, field, usual):
            yield replace(number, source=told or number.source)


def declared_numbers(key: str, value: Any, field: FieldInfo, usual: bool) -> Iterator[SourcedValue]:
    """What is under a key that is declared with a unit: a number, a list of them, or one by each name."""
    if isinstance(value, dict):
        for name, number in value.items():
            yield from declared_numbers(f"{key}.{name}", number, field, usual)
    elif setting_unit(field) and value is not None and not isinstance(value, bool | str):
        yield sourced(key, value, field, usual)


def sourced(key: str, value: float | tuple[float, ...], field: FieldInfo, usual: bool = False) -> SourcedValue:
    """One number, or a list of them; whose it is."""
    source = setting_source(field) if usual and setting_source(field) else SET_BY_USER
    number = tuple(float(each) for each in value) if isinstance(value, tuple) else float(value)
    return SourcedValue(key, number, setting_unit(field), setting_limits(field), source, "")


def name_of(section: Section, place: int) -> str:
    """What a table of a list is called in keys."""
    found = (getattr(section, key) for key in NAMES if key in type(section).model_fields)
    return str(next((name for name in found if name is not None), place))


def holds_sections(value: Any) -> bool:
    """A list of tables."""
    return isinstance(value, tuple) and bool(value) and all(isinstance(each, Section) for each in value)


def range_warnings(parameters: Sequence[SourcedValue]) -> Iterator[str]:
    """A sentence for every value outside its sensible range."""
    for p in parameters:
        if p.range is not None and not p.in_range:
            unit = "" if p.unit == DIMENSIONLESS else f" {p.unit}"
            yield f"{p.key} is {p.value!r}; its sensible range is {p.range[0]:g} to {p.range[1]:g}{unit}"
