"""The controller code of aim tables against the tables: the same members in C99 and in Structured Text."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from synth.checker.aim.reading import Aim
from synth.checker.category_constants import category_differences
from synth.checker.code_records import (
    Numbers,
    c_members,
    c_numbers,
    c_records,
    checksum_fault,
    st_records,
)
from synth.checker.code_records import differences as record_differences

TYPE, LOAD, SELECT = "AIM_TABLE", "AIM_LOAD", "AIM_SELECT"

Differences = Iterator[tuple[str, str]]


def c_differences(source: str, header: str, aims: Sequence[Aim]) -> Differences:
    """(about, sentence) for each disagreement of `aim_table.c`, "" about the code."""
    members = c_members(header, "aim_table")
    blocks = c_records(source, members, "aim_tables", "aim_table_count")
    numbers = [c_numbers(members, block) for block in blocks]
    categories = {aim.category_name: aim.category for aim in aims}
    yield from (("", sentence) for sentence in category_differences("AIM", categories, header))
    for number, aim in enumerate(in_order(numbers, aims)):
        fault = checksum_fault(number, blocks[number])
        if fault is not None:
            yield aim.id if aim is not None else "", fault
    yield from differences(numbers, aims)


def st_differences(text: str, aims: Sequence[Aim]) -> Differences:
    """(about, sentence) for each disagreement of the Structured Text."""
    records = st_records(text, TYPE, LOAD)
    yield from (("", fault) for fault in records.faults)
    yield from differences(records.tables, aims)


def in_order(tables: Sequence[Numbers], aims: Sequence[Aim]) -> list[Aim | None]:
    """For each table of an export the one that it is of: by category and kind."""
    by_place = {(float(aim.category), aim.is_measured): aim for aim in aims}
    return [by_place.get((first(table, "category"), first(table, "ismeasured") == 1.0)) for table in tables]


def first(table: Numbers, member: str) -> float:
    """The number of a member, -1 for one that is missing."""
    return (table.get(member) or [-1.0])[0]


def differences(tables: Sequence[Numbers], aims: Sequence[Aim]) -> Differences:
    """What is wrong with the tables of an export, in whatever order they are."""
    found = in_order(tables, aims)
    if len(tables) != len(aims) or len({aim.id for aim in found if aim is not None}) != len(tables):
        told = [f"{first(table, 'category'):g} measured {first(table, 'ismeasured'):g}" for table in tables]
        yield "", f"it holds tables for the categories {', '.join(told)}, but there are others"
    for number, (table, aim) in enumerate(zip(tables, found, strict=True)):
        if aim is not None:
            yield from ((aim.id, each) for each in record_differences(number, table, held(aim, aims)))
    yield from ((aim.id, "it is not among the tables of the export") for aim in aims if aim not in found)


def held(aim: Aim, aims: Sequence[Aim]) -> Numbers:
    """What a controller holds of a table, with room for all of its set; what it has not is 0, no answer -1."""
    cars, distances = max(len(each.cars) for each in aims), max(len(each.distances_m) for each in aims)
    columns = max(max(1, len(each.resistances)) for each in aims)
    speeds = []
    for c in range(cars):
        for d in range(distances):
            inside = c < len(aim.cars) and d < len(aim.distances_m)
            speeds += padded([-1.0 if x is None else x for x in aim.speeds[c][d]] if inside else [], columns)
    return {
        "category": [aim.category],
        "ismeasured": [int(aim.is_measured)],
        "listed": [len(aim.cars)],
        "distances": [len(aim.distances_m)],
        "resistances": [max(1, len(aim.resistances))],
        "poverspeed": [aim.p_overspeed],
        "couplingms": [aim.coupling_m_s],
        "lowestms": [aim.bounds_m_s[0]],
        "highestms": [aim.bounds_m_s[1]],
        "cars": padded(aim.cars, cars),
        "distancem": padded(aim.distances_m, distances),
        "resistancenperkn": padded(aim.resistances, columns),
        "speedms": speeds,
    }


def padded(values: Sequence[float], length: int) -> list[float]:
    """`values` with zeros behind them."""
    return [*values, *[0.0] * (length - len(values))]
