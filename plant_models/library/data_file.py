"""Strict reading of one library file: TOML whose every number is an inline table with its origin.

    brake_delay_s = { value = 0.10, range = [0.05, 0.20], source = "engineering judgement", confidence = "L" }

A *form* turns the raw TOML value into a `Value` or returns None if it is of the wrong type.
"""

from __future__ import annotations

import math
import tomllib
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from importlib.resources import files
from typing import Any

from plant_models.errors import PlantError, require
from plant_models.library.near_miss import near_miss
from plant_models.library.sourced_value import CONFIDENCES, SourcedTable, SourcedValue, Value

Form = Callable[[object], Value | None]


@dataclass(frozen=True)
class Quantity:
    """What a key of a library file holds: its unit and its form."""

    unit: str
    form: Form


def number(raw: object) -> float | None:
    """A finite number."""
    if isinstance(raw, bool) or not isinstance(raw, int | float):
        return None
    try:
        value = float(raw)
    except OverflowError:  # a whole number of more than 308 digits
        return None
    return value if math.isfinite(value) else None


def numbers(raw: object) -> tuple[float, ...] | None:
    """A list of at least one finite number."""
    items = [number(x) for x in raw] if isinstance(raw, list | tuple) else []
    return tuple(x for x in items if x is not None) if items and None not in items else None


def pairs(raw: object) -> tuple[tuple[float, float], ...] | None:
    """A list of at least one pair of finite numbers."""
    items = [numbers(x) for x in raw] if isinstance(raw, list | tuple) else []
    whole = [(x[0], x[1]) for x in items if x is not None and len(x) == 2]
    return tuple(whole) if items and len(whole) == len(items) else None


def number_or_pairs(raw: object) -> Value | None:
    """A finite number or a list of pairs of them."""
    one = number(raw)
    return pairs(raw) if one is None else one


def library_names(folder: str) -> tuple[str, ...]:
    """Names (without .toml) of the files in a folder of the library, sorted."""
    entries = files("plant_models.library").joinpath(folder).iterdir()
    return tuple(sorted(e.name.removesuffix(".toml") for e in entries if e.name.endswith(".toml")))


def library_text(folder: str, name: str) -> str:
    """Text of `folder`/`name`.toml; `PlantError` with a hint if the library has no such file."""
    known = library_names(folder)
    require(name in known, f"{folder.removesuffix('s')} {name!r} is not in the library; {near_miss(name, known)}")
    return files("plant_models.library").joinpath(folder, f"{name}.toml").read_text(encoding="utf-8")


def parse_toml(text: str, file: str) -> dict[str, Any]:
    """The parsed text; `PlantError` names the file and the line of a syntax error."""
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise PlantError(f"{file}: not valid TOML: {error}") from None


def take_string(table: dict[str, Any], key: str, file: str) -> str:
    """Remove and return the non-empty string under `key`."""
    require(key in table, f"{file}: key {key} is missing")
    value = table.pop(key)
    require(isinstance(value, str) and value != "", f"{file}: {key} is {value!r}; it must be a non-empty string")
    return str(value)


def take_strings(table: dict[str, Any], key: str, file: str) -> tuple[str, ...]:
    """Remove and return the (possibly absent) list of strings under `key`."""
    value = table.pop(key, [])
    require(
        isinstance(value, list) and all(isinstance(x, str) for x in value),
        f"{file}: {key} is {value!r}; it must be a list of strings",
    )
    return tuple(value)


def sourced_table(tree: Mapping[str, Any], schema: Mapping[str, Quantity], file: str) -> SourcedTable:
    """All of `schema` and nothing else out of the nested `tree`, in the order of the schema.

    Raises `PlantError`, one sentence with file and key: unknown or missing key, wrong type, value outside
    its own range.
    """
    cells = dict(walk(tree, "", schema, file))
    for key in schema:
        require(key in cells, f"{file}: key {key} is missing")
    return SourcedTable(tuple(sourced_value(cells[key], key, q, file) for key, q in schema.items()))


def walk(tree: Mapping[str, Any], prefix: str, schema: Mapping[str, Quantity], file: str) -> Iterator[tuple[str, Any]]:
    """(dotted key, cell) of every cell below `tree`."""
    for name, item in tree.items():
        key = prefix + name
        if key in schema:
            yield key, item
            continue
        inner = isinstance(item, dict) and any(known.startswith(key + ".") for known in schema)
        require(inner, f"{file}: unknown key {key}; {near_miss(key, schema)}")
        yield from walk(item, key + ".", schema, file)


def sourced_value(cell: object, key: str, quantity: Quantity, file: str) -> SourcedValue:
    """The checked cell under `key`."""
    if not isinstance(cell, dict):
        raise PlantError(f"{file}: {key} is {cell!r}; it must be a table of value, range, source and confidence")
    parts = {"value", "range", "source", "confidence"}
    for part in cell.keys() - parts:
        raise PlantError(f"{file}: unknown key {key}.{part}; {near_miss(part, parts)}")
    for part in sorted(parts):
        require(part in cell, f"{file}: key {key}.{part} is missing")
    value = quantity.form(cell["value"])
    if value is None:
        raise PlantError(f"{file}: {key}.value is {cell['value']!r}; it must be {form_name(quantity.form)}")
    limits = numbers(cell["range"])
    if limits is None or len(limits) != 2 or limits[0] > limits[1]:
        raise PlantError(f"{file}: {key}.range is {cell['range']!r}; it must be [low, high]")
    source = take_string(cell, "source", f"{file}: {key}")
    confidence = cell["confidence"]
    require(
        confidence in CONFIDENCES,
        f"{file}: {key}.confidence is {confidence!r}; it must be one of {', '.join(CONFIDENCES)}",
    )
    result = SourcedValue(key, value, quantity.unit, (limits[0], limits[1]), source, confidence)
    require(result.in_range, f"{file}: {key}.value is {cell['value']!r}; it is outside its own range {cell['range']!r}")
    return result


def form_name(form: Form) -> str:
    """How a message calls the form: the first sentence of its docstring."""
    sentence = (form.__doc__ or "").strip().rstrip(".")
    return sentence[:1].lower() + sentence[1:]
