"""The Structured Text export against the tables: its constant arrays, read as float32."""

from __future__ import annotations

import re
from collections.abc import Generator, Iterator, Mapping, Sequence
from typing import Any, Final

from synth.checker.finding import DamagedError, shown
from synth.checker.float32 import rounded
from synth.checker.table_reading import Table

ARRAY: Final = re.compile(r"\b(\w+) : ARRAY\[0\.\.(\d{1,6})\] OF (REAL|INT|BOOL) := \[([^\]]*)\];")
COMMENT: Final = re.compile(r"\(\*.*?\*\)", re.DOTALL)
LAYOUT: Final = r"\bIF Layout <> (\d{1,6}) THEN"
OWN_ARRAYS: Final = ("Lower", "Upper", "Coefficient")
HELD_COLUMNS: Final[Mapping[str, str]] = {
    "SpeedVarianceOf": "speed_variance",
    "FactorVarianceOf": "factor_variance",
    "PathVarianceOf": "path_variance",
    "ExcessVarianceOf": "excess_variance",
    "LeapOf": "leap",
    "FrozenOf": "frozen_readings",
    "DoubtedOf": "doubted_readings",
    "LostVarianceOf": "lost_variance",
    "CautionOf": "caution",
    "UnlikelyOf": "unlikely_deviation",
}
"""By estimator, what each holds of the numbers of `Held`: all but the touch pressure, which stands there by table."""
APPROACH_COLUMNS: Final = {"ApproachOf", "EntranceStageOf"}
GAUGE_ARRAYS: Final = ("Pressure", "Slope")
ESTIMATOR_ROWS: Final = ("BreakPath", "Drive", "Brake")

Arrays = dict[str, list[list[Any]]]


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


def differences(arrays: Arrays, tables: Sequence[Table]) -> Iterator[tuple[str, str]]:
    """(about, sentence) for each disagreement; `tables` in the order of the book, "" stands for the export."""
    parts = [name.rpartition("_") for name in arrays]
    numbered = {int(n) for stem, _, n in parts if stem in OWN_ARRAYS and n.isdigit()}
    if numbered != set(range(len(tables))):
        yield "", f"it holds {len(numbered)} tables, but there are {len(tables)}"
        return
    columns: dict[str, list[Any]] = {
        "StagesOf": [len(table.lines) for table in tables],
        "PowersOf": [table.degree + 1 for table in tables],
        "TargetOf": [rounded(table.target_m_s) for table in tables],
        "PathMinOf": [rounded(table.path_m[0]) for table in tables],
        "PathMaxOf": [rounded(table.path_m[1]) for table in tables],
        "CategoryOf": [table.category_number for table in tables],
        "AxlesOf": [len(table.axle_offsets_m) for table in tables],
        "MassOf": [rounded(table.mass_t) for table in tables],
    }
    approached = any(table.approach_m > 0.0 for table in tables)
    if approached:
        columns["ApproachOf"] = [rounded(table.approach_m) for table in tables]
        columns["EntranceStageOf"] = [table.entrance_stage for table in tables]
    elif APPROACH_COLUMNS & arrays.keys():
        yield "", "it holds approaches, but no table has one"
    columns |= yield from time_columns(arrays, tables)
    for name, wanted in columns.items():
        yield from array_differences(name, arrays, wanted, "")
    stages, powers = max(len(t.lines) for t in tables), max(t.degree for t in tables) + 1
    for number, table in enumerate(tables):
        for line, name in enumerate(OWN_ARRAYS[:2]):
            has = [both[line] is not None for both in table.lines]
            yield from array_differences(f"{name}_{number}", arrays, has + [False] * (stages - len(has)), table.id)
        padded = [*table.lines, *[(None, None)] * (stages - len(table.lines))]
        flat = [c for both in padded for each in both for c in [*(each or ()), *[0.0] * (powers - len(each or ()))]]
        yield from array_differences(f"Coefficient_{number}", arrays, flat, table.id)
        if any(each.has_gauge for each in tables):
            yield from gauge_differences(number, arrays, table, stages)
    yield from estimator_differences(arrays, tables)


def time_columns(arrays: Arrays, tables: Sequence[Table]) -> Generator[tuple[str, str], None, dict[str, list[Any]]]:
    """What times of decision and highest pressures should be there; says which are there and should not."""
    columns: dict[str, list[Any]] = {}
    if any(table.at_any_time for table in tables):
        columns["AtAnyTimeOf"] = [table.at_any_time for table in tables]
    elif "AtAnyTimeOf" in arrays:
        yield "", "it holds times of decision, but no table decides at any time"
    if any(table.has_gauge for table in tables):
        highest = [table.pressures_kpa[table.top_stage] if table.has_gauge else 0.0 for table in tables]
        columns["HighestPressureOf"] = [rounded(kpa) for kpa in highest]
    elif "HighestPressureOf" in arrays or any(name.rpartition("_")[0] in GAUGE_ARRAYS for name in arrays):
        yield "", "it holds pressures or slopes, but no table has slopes"
    return columns


def gauge_differences(number: int, arrays: Arrays, table: Table, stages: int) -> Iterator[tuple[str, str]]:
    """What is wrong with pressures and slopes of table `number`; all are 0 in a table without slopes."""
    pressures = [rounded(kpa) for kpa in table.pressures_kpa] if table.has_gauge else []
    slopes = [slope or 0.0 for both in table.slopes for slope in both]
    for name, values, length in (("Pressure", pressures, stages), ("Slope", slopes, 2 * stages)):
        yield from array_differences(f"{name}_{number}", arrays, values + [0.0] * (length - len(values)), table.id)


def estimator_differences(arrays: Arrays, tables: Sequence[Table]) -> Iterator[tuple[str, str]]:
    """What is wrong with the estimators, which stand there once each, however many tables share one."""
    each = list(dict.fromkeys(table.estimator.held for table in tables if table.estimator))
    numbered = [name for name in arrays if name.rpartition("_")[0] in ESTIMATOR_ROWS]
    if len(numbered) != len(ESTIMATOR_ROWS) * len(each):
        yield "", f"it holds {len(numbered)} rows of work, but the tables have {len(each)} estimators of three each"
    if not each:
        return
    of = [each.index(table.estimator.held) if table.estimator else -1 for table in tables]
    touch = [rounded(table.estimator.touch_pressure_kpa) if table.estimator else 0.0 for table in tables]
    wanted: dict[str, list[Any]] = {"EstimatorOf": of, "TouchOf": touch}
    wanted["BreaksOf"] = [len(row) for _, row, _, _ in each]
    wanted |= {name: [getattr(numbers, field) for numbers, *_ in each] for name, field in HELD_COLUMNS.items()}
    most = max(len(row) for _, row, _, _ in each)
    for number, (_, *rows) in enumerate(each):
        padded = ([*row, *[0.0] * (most - len(row))] for row in rows)
        wanted |= {f"{name}_{number}": row for name, row in zip(ESTIMATOR_ROWS, padded, strict=True)}
    for name, values in wanted.items():
        yield from array_differences(name, arrays, values, "")


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
