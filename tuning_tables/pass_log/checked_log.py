"""From the rows of a file to its sound passes: faults of the whole file (units, and a pressure that does not
follow the stage), and a sentence for each pass that is left out.

Faults of a whole file: units, and a pressure that does not follow the stage. Each gives one sentence's end or none.
They look at all sound passes together, and say nothing where these are too few.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Final

import numpy as np

from tuning_tables.errors import InvalidLog, excerpt
from tuning_tables.pass_log.log_columns import BrokenRow, LogColumns, PassFault
from tuning_tables.pass_log.pass_checks import CHECKS, Segments, segments_of
from tuning_tables.pass_log.pass_log import PassLog

FEWEST_STEPS: Final = 50
SLOWEST_M_S: Final = 0.5
USUAL_RATIO: Final = 1.25
FEWEST_PRESSURES: Final = 200
LOWEST_PRESSURE_KPA: Final = 20.0
LEAST_CORRELATION: Final = 0.3

UNIT_RATIOS: Final = (
    (3.6, "speed_m_s", 'in km/h: give [units] speed_m_s = "km/h" in a mapping'),
    (1.0 / 3.6, "speed_m_s", "divided by 3.6 once too often: take the unit km/h out of the mapping"),
    (2.237, "speed_m_s", 'in mph: give [units] speed_m_s = "mph" in a mapping'),
    (0.3048, "path_m", 'in feet: give [units] path_m = "ft" in a mapping'),
    (1000.0, "time_s", 'in milliseconds: give [units] time_s = "ms" in a mapping'),
    (0.001, "time_s", "divided by 1000 once too often: take the unit ms out of the mapping"),
)
"""Measured speed / path in time, the column that is suspected, and what it seems to be."""


def file_fault(log: PassLog) -> tuple[int, str, str] | None:
    """(row of the log, column, what is wrong with it) of the first fault of a whole file; None where it has none."""
    return speed_fault(log) or pressure_unit_fault(log) or stage_fault(log)


def speed_fault(log: PassLog) -> tuple[int, str, str] | None:
    """The measured speed is the path in time, but for a unit."""
    inner = np.ones(len(log.time_s), dtype=np.bool_)
    inner[log.first_row[:-1]] = False
    time = np.diff(log.time_s, prepend=np.nan)
    rolled = np.diff(log.path_m, prepend=np.nan)
    seen = 0.5 * (log.speed_m_s + np.concatenate(([np.nan], log.speed_m_s[:-1])))
    usable = inner & (rolled > 0.0) & (time > 0.0) & (seen > SLOWEST_M_S)
    if np.count_nonzero(usable) < FEWEST_STEPS:
        return None
    ratio = float(np.median(seen[usable] / (rolled[usable] / time[usable])))
    if 1.0 / USUAL_RATIO <= ratio <= USUAL_RATIO:
        return None
    known, column, remedy = min(UNIT_RATIOS, key=lambda entry: abs(math.log(ratio / entry[0])))
    if abs(math.log(ratio / known)) > math.log(USUAL_RATIO):
        column, remedy = "speed_m_s", "in another unit than m/s, or path_m than m: give their units in a mapping"
    what = f"the measured speed is {ratio:.3g} times the path in time; {column} seems to be {remedy}"
    return int(np.argmax(usable)), column, what


def pressure_unit_fault(log: PassLog) -> tuple[int, str, str] | None:
    """Where stages are commanded there is some pressure."""
    braking = np.isfinite(log.pressure_kpa) & (log.stage > 0)
    if np.count_nonzero(braking) < FEWEST_STEPS:
        return None
    highest = float(log.pressure_kpa[braking].max())
    if highest > LOWEST_PRESSURE_KPA:
        return None
    what = (
        f"never above {highest:.3g} kPa, though stages above 0 are commanded; if it is in bar, give [units] "
        'pressure_kpa = "bar" in a mapping, else look at the gauge'
    )
    return int(np.argmax(braking)), "pressure_kpa", what


def stage_fault(log: PassLog) -> tuple[int, str, str] | None:
    """The pressure follows the stage."""
    known = np.isfinite(log.pressure_kpa)
    stage, pressure = log.stage[known].astype(np.float64), log.pressure_kpa[known]
    if len(stage) < FEWEST_PRESSURES or np.ptp(stage) == 0.0:
        return None
    follows = 0.0 if np.ptp(pressure) == 0.0 else float(np.corrcoef(stage, pressure)[0, 1])
    if follows >= LEAST_CORRELATION:
        return None
    what = (
        f"the stage is without effect: the pressure does not follow it (correlation {follows:.2f}, at least "
        f"{LEAST_CORRELATION:g} is needed); look whether stage and gauge are of the same drive"
    )
    return int(np.argmax(known & (log.stage > 0))), "stage", what


def checked_log(columns: LogColumns, top_stage: int | None) -> tuple[PassLog | None, tuple[PassFault, ...]]:
    """The sound passes of a file, None where there are none, and why the others were left out.

    `InvalidLog` where something is wrong with the file as a whole (`file_checks`).
    """
    segments = segments_of(columns, top_stage)
    with np.errstate(invalid="ignore", over="ignore"):
        faults = pass_faults(segments)
    sound = np.setdiff1d(np.arange(len(segments.first_row) - 1), np.array(sorted(faults), dtype=np.int64))
    told = tuple(faults[number] for number in sorted(faults)) + cut_of_its_own(columns)
    if not len(sound):
        return None, told
    log = _log_of(segments, sound)
    if (fault := file_fault(log)) is not None:
        row, column, what = fault
        kept = np.flatnonzero(np.isin(segments.pass_of_row, sound))
        place = columns.first_number + int(kept[row])
        raise InvalidLog(f"{columns.source}: from row {place} on, column {column}: {what}.")
    return log, told


def pass_faults(segments: Segments) -> dict[int, PassFault]:
    """The first fault of each faulty pass, by its number."""
    faults: dict[int, PassFault] = {}
    for column, failing, tell in CHECKS:
        rows = np.flatnonzero(failing(segments))
        numbers, places = np.unique(segments.pass_of_row[rows], return_index=True)
        for number, place in zip(numbers.tolist(), places.tolist(), strict=True):
            if number not in faults:
                row = int(rows[place])
                faults[number] = _fault(segments, number, row, column, tell(segments, row))
    for number, earlier in _out_of_order(segments, faults):
        row = int(segments.first_row[number])
        time = segments["time_s"]
        what = f"begins at {time[row]:.3f} s, but the pass ahead ended at {time[earlier]:.3f} s; the clock must go on"
        faults[number] = _fault(segments, number, row, "time_s", what)
    seen: set[str] = set()
    for number, cut_id in enumerate(segments.columns.cut_id.value):
        if cut_id in seen and number not in faults:
            row = int(segments.first_row[number])
            what = "stands in an earlier pass of the file already; give each cut its own"
            faults[number] = _fault(segments, number, row, "cut_id", what)
        seen.add(cut_id)
    broken, last = segments.columns.broken_row, len(segments.first_row) - 2
    if broken is not None and last not in faults and broken.may_be_of(segments.columns.cut_id.value[last]):
        faults[last] = broken_off(segments.columns, broken, segments.columns.cut_id.value[last])
    return faults


def cut_of_its_own(columns: LogColumns) -> tuple[PassFault, ...]:
    """The fault of a broken row that is all there is of its cut."""
    broken = columns.broken_row
    if broken is None or broken.may_be_of(columns.cut_id.value[-1]):
        return ()
    return (broken_off(columns, broken, broken.cut_id),)


def broken_off(columns: LogColumns, broken: BrokenRow, cut_id: str) -> PassFault:
    """Of the cut whose row the file ends in the middle of."""
    where = f"{columns.source}: row {broken.row}, column {broken.column}, cut {excerpt(cut_id)}"
    sentence = f"{where}: the file ends in the middle of this row, so this pass is left out."
    return PassFault(columns.source, broken.row, broken.column, cut_id, sentence)


def _out_of_order(segments: Segments, faults: dict[int, PassFault]) -> list[tuple[int, int]]:
    """Sound passes that begin before the sound one ahead has ended, and the last row of that one."""
    sound = [number for number in range(len(segments.first_row) - 1) if number not in faults]
    time, first = segments["time_s"], segments.first_row
    pairs = zip(sound[1:], sound[:-1], strict=True)
    return [(now, int(first[ahead + 1]) - 1) for now, ahead in pairs if time[first[now]] <= time[first[ahead + 1] - 1]]


def _fault(segments: Segments, number: int, row: int, column: str, what: str) -> PassFault:
    columns = segments.columns
    cut_id, place = columns.cut_id.value[number], columns.first_number + row
    sentence = f"{columns.source}: row {place}, column {column}, cut {excerpt(cut_id)}: {column} {what}."
    return PassFault(columns.source, place, column, cut_id, sentence)


def _log_of(segments: Segments, sound: np.ndarray) -> PassLog:
    """The passes with the numbers `sound`."""
    columns, numbers = segments.columns, segments.columns.numbers
    first = segments.first_row[:-1][sound]
    counts = np.diff(segments.first_row)[sound]
    ends = np.concatenate(([0], np.cumsum(counts))).astype(np.int64)
    rows = np.repeat(first - ends[:-1], counts) + np.arange(ends[-1])
    runs = columns.category
    category = np.searchsorted(np.array(runs.first_row), first, side="right") - 1
    log = PassLog(
        time_s=numbers["time_s"][rows],
        path_m=numbers["path_m"][rows],
        speed_m_s=numbers["speed_m_s"][rows],
        pressure_kpa=numbers["pressure_kpa"][rows],
        stage=numbers["stage"][rows].astype(np.int64),
        first_row=ends,
        cut_id=tuple(columns.cut_id.value[number] for number in sound.tolist()),
        mass_t=numbers["mass_t"][first],
        axles=numbers["axles"][first].astype(np.int64),
        category=tuple(runs.value[run] for run in category.tolist()),
        target_m_s=numbers["target_m_s"][first],
        stopped_by_hand=numbers["stopped_by_hand"][first] == 1.0,
    )
    return replace(log, path_is_independent=columns.path_is_independent)
