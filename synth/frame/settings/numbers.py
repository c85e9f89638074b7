"""What is told of the keys of declared settings: numbers with unit, range and origin, for heads, templates and
documents; forms of values beside numbers, names and switches; and the JSON Schema, for editors that check what is
typed.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from enum import Enum
from typing import Annotated, Any, Final, Literal, get_args, get_origin

from pydantic import AfterValidator, Field, PlainValidator, WithJsonSchema
from pydantic.fields import FieldInfo

from plant_models.library import SourcedValue, Value
from plant_models.library.data_file import FORMS, Form, form_name, number_or_pairs, numbers, pairs
from plant_models.library.hump_forms import unit_in_name, unit_schema
from plant_models.library.sourced_value import JUDGEMENT, SET_BY_USER
from synth.frame.settings.section import (
    DIMENSIONLESS,
    OF_LIBRARY,
    Section,
    parts_of,
    setting_limits,
    setting_source,
    setting_unit,
)


def in_form(form: Form) -> PlainValidator:
    """Validator by a form of the library."""

    def check(raw: object) -> Value:
        value = form(raw)
        if value is None:
            raise ValueError(f"it must be {form_name(form)}")
        return value

    return PlainValidator(check)


def printable(text: str) -> str:
    """Validator: `text` itself; `ValueError` where it holds what no terminal and no page should get."""
    if not text.isprintable():
        raise ValueError("it must be made of printable characters")
    return text


Numbers = Annotated[tuple[float, ...], in_form(numbers), WithJsonSchema(FORMS[numbers])]
Pairs = Annotated[tuple[tuple[float, float], ...], in_form(pairs), WithJsonSchema(FORMS[pairs])]
Grade = Annotated[
    float | tuple[tuple[float, float], ...], in_form(number_or_pairs), WithJsonSchema(FORMS[number_or_pairs])
]
Title = Annotated[str, AfterValidator(printable)]

Source = Annotated[str, Field(min_length=1, max_length=400), AfterValidator(printable)]
"""Where a number is from, in the user's words."""


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


@dataclass(frozen=True)
class Told:
    """`value` as TOML can hold it, None for none; '' for what is not told of it: a word has neither unit nor origin.

    `source`: with the confidence, where the value is of the library; `assumed`: nothing citable stands behind it.
    """

    value: Any
    unit: str = ""
    range: str = ""
    source: str = ""
    assumed: bool = False

    @property
    def origin(self) -> str:
        """Unit; range; source of a number; '' of a word."""
        source = f"ASSUMED, {self.source}" if self.assumed else self.source
        parts = (self.unit, self.range or "any", source) if self.unit else ()
        return "; ".join(part for part in parts if part)


Usual = Mapping[str, Told]
"""What stands for keys that a file leaves out, by dotted key, 'cut[0].mass_t' in lists of tables."""


def told_numbers(values: Iterable[SourcedValue]) -> dict[str, Told]:
    """Of numbers of the library."""
    return {value.key: told_number(value) for value in values}


def told_number(number: SourcedValue) -> Told:
    """Of a number of the library; its range is the sensible one."""
    confidence = f" (confidence {number.confidence})" if number.confidence else ""
    return Told(number.value, number.unit, number.span, number.source + confidence, number.assumed)


def told_key(value: Any, field: FieldInfo, usual: Told | None) -> Told:
    """Of a key that has this `value`, or without one that of the library; its origin as it is declared."""
    if value is None and usual is not None:
        return replace(usual, value=whole(usual.value, field))
    held = value.value if isinstance(value, Enum) else value
    unit, limits, source = setting_unit(field), setting_limits(field), setting_source(field)
    span = f"{limits[0]:g} to {limits[1]:g}" if limits else ""
    return Told(held, unit, span, source, source.startswith(JUDGEMENT))


def whole(value: Any, field: FieldInfo) -> Any:
    """A number of the library, which are all floats, as a key for whole numbers takes it."""
    kinds = set(parts_of(field.annotation))
    return int(value) if int in kinds and float not in kinds else value


def words_of(field: FieldInfo) -> tuple[str, ...]:
    """The words that a field may be, or that a list may hold, if they are a few."""
    for kind in parts_of(field.annotation):
        if get_origin(kind) is Literal:
            return get_args(kind)
        if isinstance(kind, type) and issubclass(kind, Enum):
            return tuple(each.value for each in kind)
    return ()


DIALECT: Final = "https://json-schema.org/draft/2020-12/schema"


def schema_of(model: type[Section], title: str) -> dict[str, Any]:
    """The schema: keys, types, limits, units, meanings and origins, as they are declared."""
    return {"$schema": DIALECT, **with_units(model.model_json_schema()), "title": title}


def with_units(node: Any, unit: str = "") -> Any:
    """A part of a schema in which numbers may be written with a unit; `unit`: the declared one of those in it."""
    if isinstance(node, list):
        return [with_units(each, unit) for each in node]
    if not isinstance(node, dict):
        return node
    declared = node["unit"] if isinstance(node.get("unit"), str) else unit
    in_node = ((key, each, unit_in_name(key) if is_of_library(each) else declared) for key, each in node.items())
    inner = {key: with_units(each, of_it) for key, each, of_it in in_node}
    written = unit_schema(declared)
    if written is None or inner.get("type") != "number":
        return inner
    number = {key: inner.pop(key) for key in ("type", "minimum", "maximum") if key in inner}
    return {**inner, "anyOf": [number, written]}


def is_of_library(node: Any) -> bool:
    """Whether a part of a schema is that of a value of the library, whose key has its unit."""
    return isinstance(node, dict) and node.get("source") == OF_LIBRARY
