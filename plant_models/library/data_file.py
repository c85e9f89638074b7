"""Strict reading of one library file: TOML whose every number is an inline table with its origin; and what a value
of each form may be, as JSON Schema.

    brake_delay_s = { value = 0.10, range = [0.05, 0.20], source = "engineering judgement", confidence = "L" }

A *form* turns the raw TOML value into a `Value` or returns None if it is of the wrong type. The functions here raise
`PlantError` that names the key, or `Faults` of several; `telling` puts file and line before each.
"""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any, Final

from plant_models.errors import Faults, PlantError, near_miss, require
from plant_models.library.library import TypeFileError
from plant_models.library.sourced_value import CONFIDENCES, SourcedTable, SourcedValue, Value
from plant_models.library.toml_lines import line_around

Form = Callable[[object], Value | None]

SHOWN: Final = 80
"""Characters of a wrong value that a message shows."""


@dataclass(frozen=True)
class Quantity:
    """What a key of a library file holds: its unit and its form."""

    unit: str
    form: Form


KEY: Final = re.compile(r"(?:unknown key |key )?([\w.-]+)")
"""The key that a sentence is about."""


@contextmanager
def telling(place: str, text: str = "", keys: Mapping[str, str] | None = None, table: str = "") -> Iterator[None]:
    """Within, a `PlantError` becomes a `TypeFileError` of the file `place`, with the line of its `text` at fault.

    `keys`: how the plant's own messages begin, and the key of the file that this means. `table`: of the file, in which
    the keys stand; '' for the whole.
    """
    try:
        yield
    except TypeFileError:
        raise
    except PlantError as error:
        sentences = error.sentences if isinstance(error, Faults) else (str(error),)
        told = (keyed(sentence, keys or {}) for sentence in sentences)
        raise TypeFileError(
            *(f"{place}{line_told(text, table, each)}: {f'{table}: ' if table else ''}{each}" for each in told)
        ) from None


def line_told(text: str, table: str, sentence: str) -> str:
    """', line 12' where `sentence` begins with a key that `text` has, or with one that is missing in a table of it."""
    about = KEY.match(sentence)
    try:
        tomllib.loads(text)
    except (ValueError, RecursionError):  # the sentence is about that
        return ""
    key = about[1].rstrip(".").split(".") if about else []
    line = line_around(text, [table, *key] if table else key)
    return "" if line is None else f", line {line}"


def keyed(sentence: str, keys: Mapping[str, str]) -> str:
    """The plant's sentence with a key in place of the plant's own name, the longest beginning first."""
    for prefix in sorted(keys, key=len, reverse=True):
        if sentence.startswith(prefix):
            return keys[prefix] + sentence.removeprefix(prefix)
    return sentence


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


def parse_toml(text: str) -> dict[str, Any]:
    """The parsed text; `PlantError` names the line of a syntax error."""
    try:
        found = tomllib.loads(text)
        repr(found)  # a hexadecimal number is read in any length, but not told
    except tomllib.TOMLDecodeError as error:
        raise PlantError(f"not valid TOML: {error}") from None
    except RecursionError:
        raise PlantError("its lists or tables are nested too deeply; no type needs more than four levels") from None
    except ValueError:  # Python turns no longer text into a whole number
        raise PlantError("a number in it has thousands of digits; whole numbers have at most 19") from None
    return found


def take_string(table: dict[str, Any], key: str) -> str:
    """Remove and return the non-empty string of printable characters under `key`."""
    require(key in table, f"key {key} is missing")
    value = table.pop(key)
    require(
        isinstance(value, str) and value != "" and value.isprintable(),
        f"{key} is {shown(value)}; it must be a non-empty string of printable characters",
    )
    return str(value)


def take_strings(table: dict[str, Any], key: str) -> tuple[str, ...]:
    """Remove and return the (possibly absent) list of strings of printable characters under `key`."""
    value = table.pop(key, [])
    require(
        isinstance(value, list) and all(isinstance(x, str) and x.isprintable() for x in value),
        f"{key} is {shown(value)}; it must be a list of strings of printable characters",
    )
    return tuple(value)


def sourced_table(tree: Mapping[str, Any], schema: Mapping[str, Quantity], origin: str = "") -> SourcedTable:
    """All of `schema` and nothing else out of the nested `tree`, in the order of the schema.

    `origin`: the user's file, told behind the source of each number; '' for a file that comes with the program.
    Raises `Faults`, each with its key: unknown or missing key, wrong type, value outside its own range.
    """
    cells = dict(walk(tree, "", schema))
    faults = list(unknown_keys(tree, "", schema))
    if not faults:  # else a missing key may be one of these, mistyped
        faults += (f"key {key} is missing" for key in schema if key not in cells)
    values = []
    for key in filter(cells.__contains__, schema):
        try:
            values.append(sourced_value(cells[key], key, schema[key], origin))
        except PlantError as fault:
            faults.append(str(fault))
    if faults:
        raise Faults(*faults)
    return SourcedTable(tuple(values))


def unknown_keys(tree: Mapping[str, Any], prefix: str, schema: Mapping[str, Quantity]) -> Iterator[str]:
    """A sentence for each key below `tree` that the schema has not."""
    for name, item in tree.items():
        key = prefix + name
        if key not in schema:
            if isinstance(item, dict) and holds(schema, key):
                yield from unknown_keys(item, key + ".", schema)
            else:
                yield f"unknown key {shown_key(key)}; {near_miss(key, schema)}"


def holds(schema: Mapping[str, Quantity], table: str) -> bool:
    """Whether `table` is one whose keys the schema has."""
    return any(known.startswith(table + ".") for known in schema)


def walk(tree: Mapping[str, Any], prefix: str, schema: Mapping[str, Quantity]) -> Iterator[tuple[str, Any]]:
    """(dotted key, cell) of every cell below `tree` that the schema has."""
    for name, item in tree.items():
        key = prefix + name
        if key in schema:
            yield key, item
        elif isinstance(item, dict) and holds(schema, key):
            yield from walk(item, key + ".", schema)


def sourced_value(cell: object, key: str, quantity: Quantity, origin: str = "") -> SourcedValue:
    """The checked cell under `key`."""
    if not isinstance(cell, dict):
        raise PlantError(f"{key} is {shown(cell)}; it must be a table of value, range, source and confidence")
    parts = {"value", "range", "source", "confidence"}
    for part in sorted(cell.keys() - parts):
        raise PlantError(f"unknown key {key}.{shown_key(part)}; {near_miss(part, parts)}")
    for part in sorted(parts):
        require(part in cell, f"key {key}.{part} is missing")
    value = quantity.form(cell["value"])
    if value is None:
        raise PlantError(f"{key}.value is {shown(cell['value'])}; it must be {form_name(quantity.form)}")
    limits = numbers(cell["range"])
    if limits is None or len(limits) != 2 or limits[0] > limits[1]:
        raise PlantError(f"{key}.range is {shown(cell['range'])}; it must be [low, high]")
    source = cell["source"]
    require(
        isinstance(source, str) and source != "" and source.isprintable(),
        f"{key}.source is {shown(source)}; it must be a non-empty string of printable characters",
    )
    confidence = cell["confidence"]
    require(
        confidence in CONFIDENCES,
        f"{key}.confidence is {shown(confidence)}; it must be one of {', '.join(CONFIDENCES)}",
    )
    told = f"{source} ({origin})" if origin else source
    result = SourcedValue(key, value, quantity.unit, (limits[0], limits[1]), told, confidence)
    require(result.in_range, f"{key}.value is {shown(cell['value'])}; it is outside its own range {cell['range']!r}")
    return result


def form_name(form: Form) -> str:
    """How a message calls the form: the first sentence of its docstring."""
    sentence = (form.__doc__ or "").strip().rstrip(".")
    return sentence[:1].lower() + sentence[1:]


def shown(value: object) -> str:
    """A wrong value in a message, cut off if long."""
    text = repr(value)
    return text if len(text) <= SHOWN else f"{text[: SHOWN - 1]}…"


def shown_key(key: str) -> str:
    """A key in a message: as it is, or in quotes where it would break the line, cut off if long."""
    text = key if key.isprintable() else repr(key)
    return text if len(text) <= SHOWN else f"{text[: SHOWN - 1]}…"


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
