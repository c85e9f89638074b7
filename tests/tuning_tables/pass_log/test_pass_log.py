"""Passes as a value: parts of a log are what they were in it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from tuning_tables.errors import InvalidTable
from tuning_tables.pass_log.join_logs import join_logs
from tuning_tables.pass_log.pass_log import PassLog


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
