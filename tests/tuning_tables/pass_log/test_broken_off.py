"""A CSV log whose writer lost its power: the pass that it was writing is left out and named, all others are used."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from tests.tuning_tables.pass_log.sample_logs import sample_log
from tuning_tables.errors import InvalidLog
from tuning_tables.pass_log.log_files import LoadedLogs, read_logs, write_log

PASSES, ROWS = 4, 8
LAST_ROW = 2 + PASSES * ROWS
"""Of a spreadsheet: after a comment and a header."""


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A sound log."""
    write_log(sample_log(PASSES, ROWS), tmp_path / "log.csv")
    return tmp_path / "log.csv"


def read_after(path: Path, content: bytes) -> LoadedLogs:
    path.write_bytes(content)
    return read_logs([path], None, 2)


def assert_only_the_last_pass_is_left_out(loaded: LoadedLogs, row: int, *columns: str) -> None:
    sound = sample_log(PASSES, ROWS).taken(np.arange(PASSES - 1))
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
