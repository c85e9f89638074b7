"""What controller code holds of tables with lines: their numbers by member."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from synth.checker.code_export import Due
from synth.checker.code_records import Numbers
from synth.checker.float32 import rounded
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
