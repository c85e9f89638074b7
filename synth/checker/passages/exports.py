"""What controller code for point sensors holds of its tables, and the golden stages beside it: each answer worked
out anew.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator, Sequence
from typing import Final

from synth.checker.code_export import Due
from synth.checker.code_records import Numbers
from synth.checker.content import rows_below
from synth.checker.finding import DamagedError
from synth.checker.float32 import from_bits
from synth.checker.passages.table import LARGEST, PassageTable, passages_heard, wanted


def due_of_passages(tables: Sequence[PassageTable]) -> Due:
    """What an export of these tables must hold, in their order."""
    categories = {table.category: table.category_number or 0 for table in tables}
    return Due([table.id for table in tables], [held(table, tables) for table in tables], categories)


def held(table: PassageTable, tables: Sequence[PassageTable]) -> Numbers:
    """What a controller holds of a table, with room for all of its book; what it has not is 0."""
    plausible = table.document["plausible"]
    least, greatest = plausible["speed_m_s"]
    heard = passages_heard(table.sensors_m, table.axle_offsets_m)
    number_of = {(each.sensor, each.axle): number for number, each in enumerate(table.passages)}
    room = max(len(each.sensors_m) * len(each.axle_offsets_m) for each in tables)
    rest = [0] * (room - len(heard))
    return {
        "category": [table.category_number or 0],
        "axles": [len(table.axle_offsets_m)],
        "stages": [len(table.pressures_kpa)],
        "heard": [len(heard)],
        "passages": [len(table.passages)],
        "beforeentrance": [sum(each.path_m < 0.0 for each in table.passages)],
        "entrancestage": [table.entrance_stage],
        "initialstage": [table.initial_stage],
        "masst": [table.mass_t],
        "targetms": [table.target_m_s],
        "basem": [table.base_m],
        "scanperiods": [table.scan_period_s],
        "computingdelays": [table.computing_delay_s],
        "leastms": [least],
        "greatestms": [greatest],
        "accelerationms2": [plausible["acceleration_m_s2"]],
        "decelerationms2": [plausible["deceleration_m_s2"]],
        "speedtolerance": [plausible["speed_tolerance"]],
        "pathtolerancem": [plausible["path_tolerance_m"]],
        "pathm": [*(path_m for path_m, _, _ in heard), *rest],
        "sensor": [*(sensor for _, sensor, _ in heard), *rest],
        "deciding": [*(number_of.get((sensor, axle), -1) for _, sensor, axle in heard), *rest],
        "switchingms": switching(table, tables),
    }


def switching(table: PassageTable, tables: Sequence[PassageTable]) -> list[float]:
    """The switching speeds by passage, stage in force and threshold; infinite ones are the largest of their sign."""
    stages = max(len(each.pressures_kpa) for each in tables)
    found: list[float] = []
    for number in range(max(len(each.passages) for each in tables)):
        rows = table.passages[number].rows if number < len(table.passages) else ()
        for stage in range(stages):
            row = [min(max(speed, -LARGEST), LARGEST) for speed in rows[stage]] if stage < len(rows) else []
            found += [*row, *[0.0] * (stages - 1 - len(row))]
    return found


HEAD: Final = ["table", "id", "passage", "stage", "reading_m_s_bits", "wanted", "reading_m_s"]


def stage_differences(content: bytes, tables: Sequence[PassageTable]) -> Iterator[tuple[str, str]]:
    """(about, sentence) for tables with wrong stages, the first of each."""
    rows = rows_below(HEAD, content)
    by_id = {table.id: table for table in tables}
    seen: set[str] = set()
    wrong: set[str] = set()
    for place, row in enumerate(rows, start=2):
        try:
            name, passage, stage, answer = row[1], int(row[2]), int(row[3]), int(row[5])
            v_m_s, table = from_bits(int(row[4], 16)), by_id[name]
        except (ValueError, IndexError, KeyError, struct.error) as fault:
            raise DamagedError(f"row {place} is no golden stage of a table: {fault}") from None
        seen.add(name)
        right = wanted(table, passage, stage, v_m_s)
        if answer != right and name not in wrong:
            wrong.add(name)
            yield name, f"row {place} says {answer}, but the rule says {right}"
    yield from ((table.id, "it has no golden stage") for table in tables if table.id not in seen)
