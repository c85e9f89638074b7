"""From the rows of a file to its sound passes, with a sentence for each pass that is left out."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from tuning_tables.errors import InvalidLog
from tuning_tables.excerpt import excerpt
from tuning_tables.pass_log.file_checks import file_fault
from tuning_tables.pass_log.log_columns import BrokenRow, LogColumns, PassFault
from tuning_tables.pass_log.pass_checks import CHECKS, Segments, segments_of
from tuning_tables.pass_log.pass_log import PassLog


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
