"""A path that a treadle sets right within a pass: found where it was, and where nothing was, not found."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.tuning_tables.pass_log.sample_logs import sample_log
from tuning_tables.pass_log.log_columns import Floats
from tuning_tables.pass_log.log_files import read_logs, write_log
from tuning_tables.pass_log.pass_log import PassLog
from tuning_tables.pass_log.path_resets import path_resets_m, path_set_right_m

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
