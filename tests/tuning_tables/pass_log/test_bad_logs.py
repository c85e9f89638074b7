"""Bad logs: each fault is told in one sentence and costs no sound pass; of one that breaks off the last pass is
lost.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.tuning_tables.pass_log.sample_logs import sample_log
from tuning_tables.errors import InvalidLog
from tuning_tables.pass_log.log_files import LoadedLogs, read_logs, write_log

ROWS = 40
FIRST = 3 + 2 * ROWS
"""Row in a spreadsheet of the first row of pass 2: after a comment and a header."""

Table = list[list[str]]


def table_of(path: Path) -> Table:
    return [line.split(",") for line in path.read_text(encoding="utf-8").splitlines()]


def put(column: int, value: str, row: int = FIRST + 5) -> Callable[[Table], None]:
    def change(table: Table) -> None:
        table[row - 1][column] = value

    return change


def shift(column: int, by: float, row: int = FIRST + 5, last: int = FIRST + ROWS) -> Callable[[Table], None]:
    def change(table: Table) -> None:
        for place in range(row - 1, last - 1):
            table[place][column] = repr(float(table[place][column]) + by)

    return change


def follow_at_once(table: Table) -> None:
    """The second pass begins at the moment at which the first ends."""
    ended = table[FIRST - 2][1]
    shift(1, float(ended) - float(table[FIRST - 1][1]), FIRST)(table)
    table[FIRST - 1][1] = ended


def drop(first: int, last: int) -> Callable[[Table], None]:
    def change(table: Table) -> None:
        del table[first - 1 : last - 1]

    return change


def twice(table: Table) -> None:
    table.insert(FIRST + 5, table[FIRST + 4])


def same_cut(table: Table) -> None:
    for place in range(FIRST - 1, FIRST - 1 + ROWS):
        table[place][0] = "cut-00000"


@pytest.mark.requirement("LOG-01")
@pytest.mark.parametrize(
    ("change", "row", "column", "words"),
    [
        (put(1, "nan"), FIRST + 5, "time_s", "a number must stand there"),
        (put(2, ""), FIRST + 5, "path_m", "a number must stand there"),
        (put(1, "-1e300"), FIRST + 5, "time_s", "time_s is -1e+300; it must lie from -1e+12 to 1e+12"),
        (put(2, "1e300"), FIRST + 5, "path_m", "path_m is 1e+300; it must lie from -1e+12 to 1e+12"),
        (twice, FIRST + 6, "time_s", "all others are those of the row before"),
        (shift(1, -0.5), FIRST + 5, "time_s", "0.400 s back"),
        (shift(1, 3.0), FIRST + 5, "time_s", "jumps by 3.100 s"),
        (drop(FIRST + 5, FIRST + 20), FIRST + 5, "time_s", "1.60 s after the row before"),
        (shift(2, -1.5), FIRST + 5, "path_m", "more than 0.2 m behind"),
        (shift(2, 50.0), FIRST + 5, "path_m", "no car does"),
        (put(3, "-0.5"), FIRST + 5, "speed_m_s", "from 0 to 40 m/s"),
        (put(3, "41"), FIRST + 5, "speed_m_s", "from 0 to 40 m/s"),
        (put(5, "1.5"), FIRST + 5, "stage", "whole number"),
        (put(5, "3"), FIRST + 5, "stage", "stages 0 to 2"),
        (put(6, "99"), FIRST + 5, "mass_t", "changes to 99 within the pass"),
        (put(6, "30000"), FIRST + 5, "mass_t", "from 1 to 20000 t"),
        (put(7, "0"), FIRST + 5, "axles", "from 1 to 1000"),
        (put(8, "X"), FIRST + 5, "category", "changes within the pass"),
        (put(10, "2"), FIRST + 5, "stopped_by_hand", "must be 0 or 1"),
        (drop(FIRST + 4, FIRST + ROWS), FIRST, "cut_id", "too few rows: 4"),
        (shift(1, -50.0, FIRST), FIRST, "time_s", "but the pass ahead ended"),
        (follow_at_once, FIRST, "time_s", "but the pass ahead ended"),
        (same_cut, FIRST, "cut_id", "stands in an earlier pass"),
    ],
)
def test_a_faulty_pass_is_left_out_and_named(
    tmp_path: Path, change: Callable[[Table], None], row: int, column: str, words: str
) -> None:
    path = tmp_path / "log.csv"
    write_log(sample_log(passes=6, rows=ROWS), path)
    table = table_of(path)
    change(table)
    path.write_text("\n".join(",".join(cells) for cells in table), encoding="utf-8")
    loaded = read_logs([path], None, 2)
    (fault,) = loaded.faults
    assert (fault.file, fault.row, fault.column) == (str(path), row, column)
    assert fault.sentence.startswith(f"{path}: row {row}, column {column}, cut {fault.cut_id}: ")
    assert words in fault.sentence
    assert len(loaded.log) == 5


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (put(3, "fast"), f"row {FIRST + 5}, column speed_m_s: 'fast' is no number"),
        (put(5, "x" * 200_000), f"row {FIRST + 5}, column stage: 'xxx"),
        (put(0, ""), f"row {FIRST + 5}, column cut_id: the cell is empty"),
        (put(0, "cut\x1b[31m"), f"row {FIRST + 5}, column cut_id: 'cut\\x1b[31m' is no name"),
        (put(2, "way", row=2), "row 2: there is no column path_m"),
        (put(4, "time_s", row=2), "row 2: the column time_s stands there twice"),
        (lambda table: table.insert(FIRST + 4, [""]), f"row {FIRST + 5}: the line is empty"),
        (lambda table: table[FIRST + 4].__delitem__(slice(4, None)), "pressure_kpa: the row ends after 4 of its cells"),
        (lambda table: table.__delitem__(slice(2, None)), "no rows under a header line"),
    ],
)  # fmt: skip
def test_a_file_that_is_no_table_is_refused(tmp_path: Path, change: Callable[[Table], None], words: str) -> None:
    path = tmp_path / "log.csv"
    write_log(sample_log(passes=6, rows=ROWS), path)
    table = table_of(path)
    change(table)
    path.write_text("\n".join(",".join(cells) for cells in table), encoding="utf-8")
    with pytest.raises(InvalidLog) as refused:
        read_logs([path], None, 2)
    assert words in str(refused.value)
    assert str(path) in str(refused.value)


def test_cells_that_stand_apart_by_another_sign_are_told(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    write_log(sample_log(passes=2, rows=ROWS), path)
    path.write_text(path.read_text(encoding="utf-8").replace(",", ";"), encoding="utf-8")
    with pytest.raises(InvalidLog, match=r"only cut_id;time_s;.*; give delimiter = ';' in a mapping"):
        read_logs([path], None, 2)


@pytest.mark.requirement("LOG-02")
@pytest.mark.parametrize(
    ("column", "factor", "words"),
    [
        ("speed_m_s", 3.6, 'column speed_m_s: the measured speed is 3.6 times the path in time; speed_m_s seems'),
        ("speed_m_s", 1 / 3.6, "divided by 3.6 once too often"),
        ("path_m", 1 / 0.3048, "path_m seems to be in feet"),
        ("time_s", 0.001, "time_s seems to be divided by 1000 once too often"),
        ("pressure_kpa", 0.01, "if it is in bar"),
    ],
)  # fmt: skip
def test_a_file_in_other_units_is_refused(tmp_path: Path, column: str, factor: float, words: str) -> None:
    log = sample_log()
    write_log(replace(log, **{column: getattr(log, column) * factor}), tmp_path / "log.h5")
    with pytest.raises(InvalidLog) as refused:
        read_logs([tmp_path / "log.h5"], None, 2)
    assert words in str(refused.value)


def test_a_stage_without_effect_is_told(tmp_path: Path) -> None:
    log = sample_log()
    other = np.random.default_rng(3).permutation(log.pressure_kpa)
    for pressure in (other, np.full(len(other), 150.0)):
        write_log(replace(log, pressure_kpa=pressure), tmp_path / "log.csv")
        with pytest.raises(InvalidLog, match=r"log\.csv: from row 13 on, column stage: the stage is without effect"):
            read_logs([tmp_path / "log.csv"], None, 2)


PASSES, ROWS_A_PASS = 4, 8
LAST_ROW = 2 + PASSES * ROWS_A_PASS
"""Of a spreadsheet: after a comment and a header."""


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A sound log."""
    write_log(sample_log(PASSES, ROWS_A_PASS), tmp_path / "log.csv")
    return tmp_path / "log.csv"


def read_after(path: Path, content: bytes) -> LoadedLogs:
    path.write_bytes(content)
    return read_logs([path], None, 2)


def assert_only_the_last_pass_is_left_out(loaded: LoadedLogs, row: int, *columns: str) -> None:
    sound = sample_log(PASSES, ROWS_A_PASS).taken(np.arange(PASSES - 1))
    assert loaded.log.cut_id == sound.cut_id
    assert np.array_equal(loaded.log.speed_m_s, sound.speed_m_s)
    (fault,) = loaded.faults
    assert (fault.row, fault.cut_id) == (row, f"cut-{PASSES - 1:05d}")
    assert fault.column in columns or not columns
    assert fault.sentence.startswith(f"{loaded.files[0]}: row {row}, column {fault.column}, cut {fault.cut_id}: ")


def test_wherever_the_last_row_ends_only_its_pass_is_lost(path: Path) -> None:
    """At each byte of it, in the middle of Cyrillic letters too."""
    sound = path.read_bytes()
    begin = sound.rindex(b"\n", 0, -1) + 1
    assert not sound[begin:].isascii()
    for end in range(begin + 1, len(sound) - 1):
        loaded = read_after(path, sound[:end])
        assert_only_the_last_pass_is_left_out(loaded, LAST_ROW)
    for whole in (sound, sound[:-1], sound[:-1] + b"\r\n", sound[:-1] + b"\r"):
        assert read_after(path, whole).faults == ()
    assert len(read_after(path, sound[:begin]).log) == PASSES


@pytest.mark.parametrize(
    ("end", "column"), [(b"cut-00003,11", "path_m"), (b"cut-00003,11.2,1.5,4.3,-", "pressure_kpa"), (b'"cut', "time_s")]
)
def test_the_sentence_names_the_column_that_the_file_ends_in(path: Path, end: bytes, column: str) -> None:
    loaded = read_after(path, path.read_bytes() + end)
    assert_only_the_last_pass_is_left_out(loaded, LAST_ROW + 1, column)
    assert loaded.faults[0].sentence.endswith("the file ends in the middle of this row, so this pass is left out.")


def test_zero_bytes_at_the_end_are_what_was_never_written(path: Path) -> None:
    """File systems leave them after a loss of power. In the middle they are no CSV."""
    sound = path.read_bytes()
    assert_only_the_last_pass_is_left_out(read_after(path, sound[:-4] + bytes(500)), LAST_ROW)
    assert_only_the_last_pass_is_left_out(read_after(path, sound + bytes(500)), LAST_ROW + 1)
    with pytest.raises(InvalidLog, match="zero byte"):
        read_after(path, sound[:-4] + bytes(500) + sound[-4:])


def test_a_cut_that_only_begins_costs_no_other(path: Path) -> None:
    loaded = read_after(path, path.read_bytes() + b"cut-00004,99.1,0.2")
    assert len(loaded.log) == PASSES
    (fault,) = loaded.faults
    assert (fault.row, fault.column, fault.cut_id) == (LAST_ROW + 1, "speed_m_s", "cut-00004")


def test_a_broken_row_that_goes_on_is_refused(path: Path) -> None:
    """A line feed behind it, or further rows: that is no end of a file."""
    sound = path.read_bytes()
    lines = sound.split(b"\n")
    for content in (sound[:-9] + b"\n", b"\n".join([*lines[:-6], lines[-6][:20], *lines[-5:]])):
        with pytest.raises(InvalidLog, match="the row ends after"):
            read_after(path, content)


def test_a_log_of_one_broken_pass_is_no_log(path: Path) -> None:
    lines = path.read_bytes().split(b"\n")
    header = b"\n".join(lines[:2])
    for content in (header, header + b"\n", header + b"\ncut-1,4"):
        with pytest.raises(InvalidLog, match="no rows under a header line"):
            read_after(path, content)
    with pytest.raises(InvalidLog, match=r"no pass of it is sound; .*the file ends in the middle of this row"):
        read_after(path, b"\n".join(lines[:9]) + b"\ncut-00000,4")
