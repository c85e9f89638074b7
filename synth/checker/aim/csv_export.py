"""A CSV export of an aim table, and the golden aims beside controller code, against the tables."""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from typing import Any, Final

from synth.checker.aim.reading import FIGURES, Aim
from synth.checker.aim.rule import exit_speed
from synth.checker.aim.sense import at
from synth.checker.csv_export import Rows, checksum_of, row_differences, rows_of, same, with_exporter
from synth.checker.finding import DamagedError
from synth.checker.float32 import bits, from_bits, rounded
from synth.checker.source_file import rows_below

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
