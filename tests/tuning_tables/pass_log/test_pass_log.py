"""Passes as a value, the page that tells their format, and a path that a treadle sets right within a pass."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.tuning_tables.pass_log.sample_logs import sample_log
from tuning_tables.errors import InvalidTable
from tuning_tables.pass_log.csv_log import FIRST_LINE, read_csv_log
from tuning_tables.pass_log.hdf5_child import FORMAT
from tuning_tables.pass_log.log_columns import COLUMNS, Floats
from tuning_tables.pass_log.log_files import read_logs, write_log
from tuning_tables.pass_log.log_mapping import PATHS, UNITS, LogMapping, read_mapping
from tuning_tables.pass_log.pass_log import PassLog, join_logs, path_resets_m, path_set_right_m


def small_log() -> PassLog:
    rows = np.arange(7.0)
    return PassLog(
        rows, rows, rows + 1.0, np.full(7, np.nan), np.zeros(7, np.int64), np.array([0, 2, 5, 7]), ("a", "b", "c"),
        np.array([22.0, 50.0, 80.0]), np.array([4, 4, 8]), ("Л", "С", "Т"), np.array([2.0, 3.0, np.nan]),
        np.array([False, True, False]),
    )  # fmt: skip


def test_a_part_has_the_rows_of_its_passes() -> None:
    part = small_log().taken([2, 0])
    assert part.cut_id == ("c", "a")
    assert part.time_s.tolist() == [5.0, 6.0, 0.0, 1.0]
    assert part.first_row.tolist() == [0, 2, 4]
    assert part.pass_of_row.tolist() == [0, 0, 1, 1]
    assert part.time_s[part.rows(1)].tolist() == [0.0, 1.0]
    assert part.mass_t.tolist() == [80.0, 22.0]


def test_nothing_of_a_log_may_be_written() -> None:
    with pytest.raises(ValueError, match="read-only"):
        small_log().speed_m_s[0] = 3.0


@pytest.mark.parametrize("ends", [[0, 2, 5, 6], [0, 1, 5, 7], [1, 2, 5, 7], [0, 2, 7]])
def test_rows_and_passes_must_fit(ends: list[int]) -> None:
    log = small_log()
    values = {name: getattr(log, name) for name in log.__dataclass_fields__} | {"first_row": np.array(ends)}
    with pytest.raises(InvalidTable):
        PassLog(**values)


@pytest.mark.parametrize("independent", [(True, True), (True, False), (False, True)])
def test_a_joined_path_is_independent_where_each_one_is(independent: tuple[bool, ...]) -> None:
    joined = join_logs([replace(small_log(), path_is_independent=each) for each in independent])
    assert joined.cut_id == 2 * small_log().cut_id
    assert joined.path_is_independent is all(independent)


PAGE = (Path(__file__).parents[3] / "docs" / "reference" / "pass-log.md").read_text(encoding="utf-8")


def block(language: str) -> str:
    """The only block of the page in `language`."""
    (found,) = re.findall(rf"```{language}\n(.*?)```", PAGE, re.DOTALL)
    return str(found)


def test_every_column_is_named_with_what_it_is() -> None:
    section = PAGE.split("## Columns\n")[1].split("\n## ")[0]
    assert tuple(re.findall(r"^\| `(\w+)` \|", section, re.MULTILINE)) == COLUMNS
    stored = PAGE.split("## HDF5\n")[1].split("\n## ")[0]
    assert {*COLUMNS, "first_row", FORMAT} <= set(re.findall(r"`([\w-]+)`", stored))
    assert f"`{FIRST_LINE}independent`" in PAGE


def test_every_unit_is_named() -> None:
    mapping = block("toml")
    for units in UNITS.values():
        assert ", ".join(units) in mapping
    for word in PATHS:
        assert f'"{word}"' in mapping


def test_the_examples_are_read(tmp_path: Path) -> None:
    (tmp_path / "log.csv").write_text(block("text"), encoding="utf-8")
    columns = read_csv_log(tmp_path / "log.csv", LogMapping())
    assert (columns.rows, columns.cut_id.value, columns.category.value) == (3, ("2026-03-02/117",), ("СТ",))
    assert np.array_equal(columns.numbers["speed_m_s"], [5.31, 5.32, np.nan], equal_nan=True)
    (tmp_path / "mapping.toml").write_text(block("toml"), encoding="utf-8")
    foreign = "Nr;t [ms];Weg;v;Stufe;Gewicht\n117;1500,0;-10,0;36,0;1;66000\n"
    (tmp_path / "foreign.csv").write_text(foreign, encoding="utf-8")
    read = read_csv_log(tmp_path / "foreign.csv", read_mapping(tmp_path / "mapping.toml"))
    values = {name: float(column[0]) for name, column in read.numbers.items()}
    expected = {"time_s": 1.5, "path_m": -3.048, "speed_m_s": 10.0, "stage": 1.0, "mass_t": 66.0, "axles": 4.0}
    assert {name: round(values[name], 9) for name in expected} == expected
    assert (read.category.value, read.path_is_independent) == (("Т",), False)


ROW = 95
"""In the middle of the third pass."""


def resets_of(log: PassLog) -> Floats:
    return path_resets_m(log.time_s, log.path_m, log.speed_m_s, log.first_row)


def set_anew(log: PassLog, by_m: float, row: int = ROW) -> PassLog:
    """The path of the pass of `row` is off by −`by_m` until `row`, where it is set right."""
    path = log.path_m.copy()
    path[log.rows(int(log.pass_of_row[row])).start : row] -= by_m
    return replace(log, path_m=path)


@pytest.mark.parametrize("by_m", [-0.6, -0.2, 0.15, 0.4])
def test_a_reset_is_found_with_its_size(by_m: float) -> None:
    found = resets_of(set_anew(sample_log(), by_m))
    assert np.flatnonzero(found).tolist() == [ROW]
    assert found[ROW] == pytest.approx(by_m, abs=0.03)


@pytest.mark.parametrize("by_m", [-0.8, -0.2, 0.2])
def test_no_pass_is_lost_by_a_reset(by_m: float, tmp_path: Path) -> None:
    log = set_anew(sample_log(), by_m)
    write_log(log, tmp_path / "log.csv")
    loaded = read_logs([tmp_path / "log.csv"], None, None)
    assert loaded.faults == ()
    assert loaded.log.path_m.tolist() == log.path_m.tolist()


def one_speed_wrong(log: PassLog) -> PassLog:
    speed = log.speed_m_s.copy()
    speed[ROW] += 6.0
    return replace(log, speed_m_s=speed)


def path_in_jumps(log: PassLog) -> PassLog:
    return replace(log, path_m=2.0 * np.floor(log.path_m / 2.0))


def coarse_path(log: PassLog) -> PassLog:
    return replace(log, path_m=np.round(log.path_m, 1))


def clock_jumps(log: PassLog) -> PassLog:
    time = log.time_s.copy()
    time[ROW : log.rows(2).stop] += 0.1
    return replace(log, time_s=time)


def lost_readings(log: PassLog) -> PassLog:
    speed = log.speed_m_s.copy()
    speed[85:100] = np.nan
    return replace(log, speed_m_s=speed)


def far_off(log: PassLog) -> PassLog:
    return set_anew(log, -1.5)


@pytest.mark.parametrize(
    "change", [one_speed_wrong, path_in_jumps, coarse_path, clock_jumps, lost_readings, far_off, lambda log: log]
)
def test_what_is_no_reset_is_not_taken_for_one(change: Callable[[PassLog], PassLog]) -> None:
    assert not resets_of(change(sample_log())).any()


def test_a_path_that_was_off_until_the_treadle_becomes_the_true_one() -> None:
    log = sample_log()
    off = set_anew(log, -0.4)
    right = path_set_right_m(off.path_m, resets_of(off), off.first_row)
    assert np.max(np.abs(right - log.path_m)) < 0.03


def test_a_path_that_drifts_between_treadles_is_stretched() -> None:
    """It counts 3 % too much from each treadle on."""
    log = sample_log(rows=80)
    path, treadles, rows = log.path_m.copy(), (0, 30, 60), log.rows(2)
    true = log.path_m[rows]
    for begin, end in zip(treadles, (*treadles[1:], 80), strict=True):
        path[rows][begin:end] = true[begin] + 1.03 * (true[begin:end] - true[begin])
    drifting = replace(log, path_m=path)
    found = resets_of(drifting)
    assert (np.flatnonzero(found) - rows.start).tolist() == [30, 60]
    right = path_set_right_m(path, found, log.first_row)
    assert np.max(np.abs(right - log.path_m)[rows][30:61]) < 0.03
    assert np.max(np.abs(path - log.path_m)[rows][30:61]) > 0.3
    elsewhere = np.delete(np.arange(len(path)), np.arange(rows.start, rows.stop))
    assert right[elsewhere].tolist() == path[elsewhere].tolist()
