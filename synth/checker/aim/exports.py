"""The exports of aim tables: a CSV and the golden aims against the tables, and what controller code holds of them."""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from typing import Any, Final

from synth.checker.aim.sense import at
from synth.checker.aim.table import FIGURES, Aim, exit_speed
from synth.checker.code_export import Due
from synth.checker.code_records import Numbers
from synth.checker.content import rows_below
from synth.checker.csv_export import Rows, checksum_of, row_differences, rows_of, same, with_exporter
from synth.checker.finding import DamagedError
from synth.checker.float32 import bits, from_bits, rounded

COLUMNS: Final = ("cars", "free_distance_m", "resistance_n_per_kn", "exit_speed_m_s", *FIGURES)
GOLDEN_HEAD: Final = [
    "table", "id", "cars", "free_distance_m_bits", "resistance_n_per_kn_bits", "exit_speed_m_s_bits",
    "free_distance_m", "resistance_n_per_kn", "exit_speed_m_s",
]  # fmt: skip


def aim_sheet_differences(rows: Rows, aim: Aim) -> Iterator[str]:
    """Each row that is not what the table says."""
    whole = with_exporter(aim.document, rows)
    document = {**whole, "reported": {"passes": aim.document["reported"]["passes"]}}
    del document["exit_speed_m_s"]
    wanted: dict[tuple[str, str], list[Any]] = dict(rows_of(document, ""))
    wanted["text", "crc32"] = [checksum_of(whole)]
    wanted["names", "node"] = list(COLUMNS)
    for number, place in enumerate(aim.places()):
        c, d, r = place
        resistance = aim.resistances[r] if aim.is_measured else None
        told = [at(nodes, place) for nodes in (aim.speeds, *aim.figures.values())]
        wanted["node", str(number)] = [aim.cars[c], aim.distances_m[d], resistance, *told]
    yield from row_differences(rows, wanted, same_cells)


def same_cells(record: str, cells: tuple[str, ...], values: list[Any]) -> bool:
    """Whether the cells hold these values; an empty one none. Behind the last there are none."""
    if record != "node":
        return same("text" if record == "names" else record, cells, values)
    given = [*cells, *[""] * (len(values) - len(cells))]
    if len(given) != len(values) or any(
        (cell == "") != (value is None) for cell, value in zip(given, values, strict=True)
    ):
        return False
    return same(record, tuple(cell for cell in given if cell), [value for value in values if value is not None])


def aim_differences(content: bytes, aims: Sequence[Aim]) -> Iterator[tuple[str, str]]:
    """(about, sentence) for tables with wrong golden aims, the first of each; each answer is worked out anew."""
    rows = rows_below(GOLDEN_HEAD, content)
    by_id = {aim.id: aim for aim in aims}
    seen: set[str] = set()
    wrong: set[str] = set()
    for place, row in enumerate(rows, start=2):
        try:
            name, cars = row[1], int(row[2])
            distance, resistance = (from_bits(int(cell, 16)) for cell in row[3:5])
            speed, aim = int(row[5], 16), by_id[name]
        except (ValueError, IndexError, KeyError, struct.error) as fault:
            raise DamagedError(f"row {place} is no golden aim of a table: {fault}") from None
        seen.add(name)
        right = exit_speed(aim, cars, distance, resistance)
        if speed != bits(rounded(-1.0 if right is None else right)) and name not in wrong:
            wrong.add(name)
            yield name, f"row {place} says {from_bits(speed):.9g} m/s, but the rule says {right}"
    yield from ((aim.id, "it has no golden aim") for aim in aims if aim.id not in seen)


def due_of_aims(aims: Sequence[Aim]) -> Due:
    """What an export of these tables must hold, in their order."""
    categories = {aim.category_name: aim.category for aim in aims}
    return Due([aim.id for aim in aims], [held(aim, aims) for aim in aims], categories)


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
