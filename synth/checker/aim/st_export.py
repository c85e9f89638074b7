"""The Structured Text of aim tables against the tables: its constant arrays, read as float32."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import Any, Final

from synth.checker.aim.reading import Aim
from synth.checker.finding import DamagedError, shown
from synth.checker.float32 import rounded

ARRAY: Final = re.compile(r"\b(\w+) : ARRAY\[0\.\.(\d{1,6})\] OF (REAL|INT|BOOL) := \[([^\]]*)\];")
COMMENT: Final = re.compile(r"\(\*.*?\*\)", re.DOTALL)

Arrays = dict[str, list[list[Any]]]


def differences(arrays: Arrays, aims: Sequence[Aim]) -> Iterator[tuple[str, str]]:
    """(about, sentence) for each disagreement; the order of the tables is told by category and kind."""
    categories, measured = (arrays.get(name, [[]])[0] for name in ("CategoryOf", "MeasuredOf"))
    by_place = {(aim.category, aim.is_measured): aim for aim in aims}
    order = [by_place.get(place) for place in zip(categories, measured, strict=False)]
    tables = [aim for aim in order if aim is not None]
    if (
        len(categories) != len(measured)
        or len(tables) != len(order)
        or {id(x) for x in tables} != {id(x) for x in aims}
    ):
        yield "", f"it holds tables for the categories {categories}, measured {measured}, but there are others"
        return
    rows = [len(aim.cars) for aim in tables]
    wanted: dict[str, list[Any]] = {
        "ListedOf": rows,
        "DistancesOf": [len(aim.distances_m) for aim in tables],
        "ResistancesOf": [len(aim.resistances) for aim in tables],
        "FirstRowOf": [sum(rows[:number]) for number in range(len(rows))],
    }
    about = dict.fromkeys(wanted, "")
    for number, aim in enumerate(tables):
        own: dict[str, list[Any]] = {
            f"Cars_{number}": list(aim.cars),
            f"Distance_{number}": [rounded(x) for x in aim.distances_m],
        }
        if aim.is_measured:
            own[f"Resistance_{number}"] = [rounded(x) for x in aim.resistances]
        for place, nodes in enumerate(aim.speeds, start=sum(rows[:number])):
            own[f"Speed_{place}"] = [rounded(-1.0 if x is None else x) for row in nodes for x in row]
        wanted |= own
        about |= dict.fromkeys(own, aim.id)
    for name, values in wanted.items():
        yield from array_differences(name, arrays, values, about[name])
    for name in sorted(arrays.keys() - wanted.keys() - {"CategoryOf", "MeasuredOf"}):
        yield "", f"the array {name} is of no table"


def read_arrays(source: str) -> Arrays:
    """All constant arrays by name, each as often as it is declared; `DamagedError` for one that cannot be read."""
    found: Arrays = {}
    for name, last, kind, content in ARRAY.findall(COMMENT.sub(" ", source)):
        try:
            values = [value_of(literal.strip(), kind) for literal in content.split(",")]
        except ValueError:
            raise DamagedError(f"the array {name} holds something else than {kind}") from None
        if len(values) != int(last) + 1:
            raise DamagedError(f"the array {name} holds {len(values)} values, but is declared with {int(last) + 1}")
        found.setdefault(name, []).append(values)
    return found


def value_of(literal: str, kind: str) -> Any:
    """The value of a literal; a REAL as float32 number."""
    if kind == "BOOL":
        return {"TRUE": True, "FALSE": False}.get(literal) if literal in ("TRUE", "FALSE") else int("no BOOL")
    if kind == "INT":
        return int(literal)
    return rounded(float(literal))


def array_differences(name: str, arrays: Arrays, wanted: list[Any], about: str) -> Iterator[tuple[str, str]]:
    """What is wrong with every declaration of the array `name`."""
    if name not in arrays:
        yield about, f"the array {name} is missing"
    for found in arrays.get(name, []):
        if len(found) != len(wanted):
            yield about, f"{name} has {len(found)} values, but {len(wanted)} are due"
        elif found != wanted:
            at = next(i for i, (a, b) in enumerate(zip(found, wanted, strict=True)) if a != b)
            yield about, f"{name}[{at}] is {shown(found[at])}, but the table says {shown(wanted[at])}"
