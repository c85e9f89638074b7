"""What controller code holds of tables with lines, and the golden vectors and tracks beside it: each answer and
each estimate worked out anew from the table.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import Final

from synth.checker.code_export import Due
from synth.checker.code_records import Numbers
from synth.checker.content import rows_below
from synth.checker.estimator import Estimator, Observer, next_unseen
from synth.checker.finding import DamagedError, shown
from synth.checker.float32 import bits, decide, from_bits, rises, rounded
from synth.checker.table_reading import Table

OF_LINES: Final = ("targetms", "coefficient", "slope")
"""In these two tables of one family may differ."""


def due_of_lines(tables: Sequence[Table]) -> Due:
    """What an export of these tables must hold, in their order."""
    categories = {table.category: table.category_number or 0 for table in tables}
    return Due([table.id for table in tables], held_of(tables), categories)


def held_of(tables: Sequence[Table]) -> list[Numbers]:
    """What a controller holds of each table: `held`, and its family.

    That is the number of the first table that differs in nothing but target and lines.
    """
    numbers = [held(table, tables) for table in tables]
    rest = [{name: [*map(rounded, each[name])] for name in each if name not in OF_LINES} for each in numbers]
    return [{**each, "familyno": [rest.index(of_family)]} for each, of_family in zip(numbers, rest, strict=True)]


def held(table: Table, tables: Sequence[Table]) -> Numbers:
    """What a controller holds of a table by itself, with room for all of its book; what it has not is 0."""
    stages, powers = max(len(each.lines) for each in tables), max(each.degree for each in tables) + 1
    found: dict[str, Sequence[float]] = {
        "category": [table.category_number or 0],
        "axles": [len(table.axle_offsets_m)],
        "stages": [len(table.lines)],
        "powers": [table.degree + 1],
        "atanytime": [int(table.at_any_time)],
        "entrancestage": [table.entrance_stage],
        "masst": [table.mass_t],
        "targetms": [table.target_m_s],
        "pathminm": [table.path_m[0]],
        "pathmaxm": [table.path_m[1]],
        "approachm": [table.approach_m],
        "sampleperiods": [table.sample_period_s],
        "computingdelays": [table.computing_delay_s],
        "touchkpa": [table.estimator.touch_pressure_kpa if table.estimator else 0.0],
    }
    pairs = [*table.lines, *[(None, None)] * (stages - len(table.lines))]
    found["hasline"] = [int(line is not None) for both in pairs for line in both]
    found["coefficient"] = [
        c for both in pairs for line in both for c in [*(line or ()), *[0.0] * (powers - len(line or ()))]
    ]
    if any(each.has_gauge for each in tables):
        found |= gauge(table, stages)
    breaks = most_breaks(tables)
    return found | estimator(table, breaks) if breaks else found


def gauge(table: Table, stages: int) -> dict[str, Sequence[float]]:
    """What the lines depend on the pressure by; a table without gauge has neither pressures nor slopes."""
    slopes = [slope or 0.0 for both in table.slopes for slope in both]
    pressures = table.pressures_kpa if table.has_gauge else ()
    return {
        "hasgauge": [int(table.has_gauge)],
        "highestkpa": [table.pressures_kpa[table.top_stage] if table.has_gauge else 0.0],
        "pressurekpa": [*pressures, *[0.0] * (stages - len(pressures))],
        "slope": [*slopes, *[0.0] * (2 * stages - len(slopes))],
    }


def most_breaks(tables: Sequence[Table]) -> int:
    """Breaks that each table of an export has room for: 0 if none of its tables has an estimator."""
    return max(len(table.estimator.s_m) if table.estimator else 0 for table in tables)


def estimator(table: Table, breaks: int) -> dict[str, Sequence[float]]:
    """The numbers and the work of an estimator, 0 for a table without."""
    names = ("speedvariance", "factorvariance", "pathvariance", "excessvariance", "leapms", "frozen", "doubted",
             "lostvariance", "caution", "unlikely")  # fmt: skip
    if table.estimator is None:
        numbers: dict[str, Sequence[float]] = {name: [0.0] for name in names}
        return {"breaks": [0], **numbers, **{name: [0.0] * breaks for name in ("placem", "drive", "brake")}}
    held_numbers, *rows = table.estimator.held
    numbers = {name: [value] for name, value in zip(names, held_numbers, strict=True)}
    work = {
        name: [*row, *[0.0] * (breaks - len(row))] for name, row in zip(("placem", "drive", "brake"), rows, strict=True)
    }
    return {"breaks": [len(table.estimator.s_m)], **numbers, **work}


VECTOR_HEAD: Final = ["table", "id", "stage", "s_m_bits", "v_m_s_bits", "answer", "s_m", "v_m_s"]
VECTOR_HEAD_WITH_GAUGE: Final = [*VECTOR_HEAD[:5], "pressure_kpa_bits", *VECTOR_HEAD[5:], "pressure_kpa"]
"""Where a table has slopes."""


def vector_differences(content: bytes, tables: Sequence[Table]) -> Iterator[tuple[str, str]]:
    """(about, sentence) for tables with wrong vectors, the first of each; `tables` in the order of the book."""
    has_gauge = any(table.has_gauge for table in tables)
    head = VECTOR_HEAD_WITH_GAUGE if has_gauge else VECTOR_HEAD
    rows = rows_below(head, content)
    seen: set[int] = set()
    wrong: set[int] = set()
    for place, row in enumerate(rows, start=2):
        try:
            number, name, stage = int(row[0]), row[1], int(row[2])
            s, v, answer = from_bits(int(row[3], 16)), from_bits(int(row[4], 16)), int(row[head.index("answer")])
            kpa = from_bits(int(row[5], 16)) if has_gauge else math.nan
            table = tables[number] if number >= 0 else None
        except (ValueError, IndexError, struct.error) as fault:
            raise DamagedError(f"row {place} is no golden vector: {fault}") from None
        if table is None:
            raise DamagedError(f"row {place} is of table {number}")
        seen.add(number)
        added = rises(table.slopes, table.pressures_kpa, table.top_stage, stage, kpa)
        right = decide(table.lines, table.path_m, table.entrance_stage, table.farthest, stage, s, v, added)
        if (name != table.id or right != answer) and number not in wrong:
            wrong.add(number)
            yield table.id, f"row {place} says {answer} of {name!r}, but the rule says {right} of {table.id!r}"
    for number, table in enumerate(tables):
        if number not in seen:
            yield table.id, "it has no golden vector"


READINGS: Final = ("s_m", "v_m_s", "overpressure_kpa", "estimate_m_s")
WORDS: Final = tuple(f"{name}_bits" for name in READINGS)
TRACK_HEAD: Final = ["track", "table", "id", *WORDS, "unseen_samples", "alarms", *READINGS]

Sample = tuple[int, int, int, int, float, float]


def track_differences(content: bytes, tables: Sequence[Table], numbered: bool) -> Iterator[tuple[str, str]]:
    """(about, sentence) for each wrong track; `numbered`: whether `tables` have the order of the book."""
    rows = rows_below(TRACK_HEAD, content)
    if any(len(row) != len(TRACK_HEAD) for row in rows):
        raise DamagedError(f"one of its rows has not {len(TRACK_HEAD)} fields")
    numbers = {table.id: number for number, table in enumerate(tables)}
    tracked = set()
    for (track, number, name), group in groupby(rows, lambda row: (row[0], row[1], row[2])):
        samples = [sample_of(row) for row in group]
        if name not in numbers or (numbered and number != str(numbers[name])):
            yield "", f"track {shown(track)} is of table {shown(number)}, {shown(name)}, which is not there"
            continue
        table = tables[numbers[name]]
        if table.estimator is not None:
            tracked.add(table.estimator.held)
        at = first_fault(table.estimator, samples)
        if at is not None:
            yield table.id, f"the estimate at sample {at} of track {shown(track)} is another by its estimator"
    for table in tables:
        if table.estimator is not None and table.estimator.held not in tracked:
            yield table.id, "its estimator has no golden track"


def sample_of(row: Sequence[str]) -> Sample:
    """The words of one row, the samples since the last speed that was believed, and the alarms."""
    try:
        words = [int(cell, 16) for cell in row[3:7]]
        for word in words:
            from_bits(word)
        unseen, alarms = float(row[7]), float(row[8])
    except (ValueError, struct.error) as fault:
        raise DamagedError(f"{shown(row)} is no sample: {fault}") from None
    return words[0], words[1], words[2], words[3], unseen, alarms


def first_fault(estimator: Estimator | None, samples: Sequence[Sample]) -> int | None:
    """The first sample with another estimate, count or alarm.

    Without estimator the measured speed is due, bit for bit, and no alarm.
    """
    observer, unseen = Observer(estimator) if estimator is not None else None, 0.0
    for at, (s, v, kpa, estimate, counted, alarmed) in enumerate(samples):
        right = v if observer is None else bits(observer.observe(from_bits(s), from_bits(v), from_bits(kpa)))
        unseen = next_unseen(unseen, from_bits(v)) if observer is None else observer.unseen
        if counted != unseen or alarmed != (0 if observer is None else observer.alarms):
            return at
        both = math.isnan(from_bits(right)) and math.isnan(from_bits(estimate))  # of absurd work; there are many NaN
        if right != estimate and not both:
            return at
    return None
