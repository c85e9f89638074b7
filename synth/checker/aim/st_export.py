"""The Structured Text of aim tables against the tables: its constant arrays, read as float32."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

from synth.checker.aim.reading import Aim
from synth.checker.float32 import rounded
from synth.checker.st_export import Arrays, array_differences


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
