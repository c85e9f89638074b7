"""Faults of single passes: what the rows of a pass cannot be if clock, path, sensor and controller are sound.

A check finds, over all rows of a file at once, rows that fail it, and says of one row what is wrong in a sentence's
end. The first fault of a pass is told, in the order of `CHECKS`.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from tuning_tables.pass_log.log_columns import (
    CONSTANT,
    FASTEST_M_S,
    MOST_STAGES,
    RANGES,
    Floats,
    Ints,
    LogColumns,
    TextRuns,
)
from tuning_tables.pass_log.pass_log import path_resets_m

Rows = npt.NDArray[np.bool_]

LONGEST_GAP_S: Final = 1.0
LARGEST_STEP_BACK_M: Final = 0.2
FEWEST_ROWS: Final = 5
LOOSE_PATH_M: Final = 5.0
FARTHEST: Final = 1e12
"""Seconds since 1970 are 2e9; a number of three hundred digits would fill the sentences below."""
"""How far a path that is known by passages may jump within a row."""


@dataclass(frozen=True, eq=False)
class Segments:
    """The rows of a file, by pass: `first_row` (m + 1,), `pass_of_row` (n,); `top_stage`, the highest there may be."""

    columns: LogColumns
    first_row: Ints
    pass_of_row: Ints
    top_stage: int

    def __post_init__(self) -> None:
        for array in (self.first_row, self.pass_of_row):
            array.setflags(write=False)

    def __getitem__(self, name: str) -> Floats:
        return self.columns.numbers[name]

    def step(self, values: Floats) -> Floats:
        """Change from the row before, (n,); 0 in the first row of a pass."""
        change = np.diff(values, prepend=values[:1])
        change[self.first_row[:-1]] = 0.0
        return change


Check = tuple[str, Callable[[Segments], Rows], Callable[[Segments, int], str]]
"""Column, rows that fail, and what to say of one of them."""


def segments_of(columns: LogColumns, top_stage: int | None) -> Segments:
    """The passes of a file: runs of one cut_id."""
    first = np.array([*columns.cut_id.first_row, columns.rows], dtype=np.int64)
    numbers = np.repeat(np.arange(len(first) - 1), np.diff(first))
    return Segments(columns, first, numbers, MOST_STAGES if top_stage is None else top_stage)


def missing(name: str) -> Check:
    """A number must be there."""
    return name, lambda s: ~np.isfinite(s[name]), lambda s, row: f"is {s[name][row]:g}; a number must stand there"


def within(name: str) -> Check:
    """A number, where there is one, lies in its range."""
    low, high, unit = RANGES[name]
    return (
        name,
        lambda s: ~(np.isnan(s[name]) | ((s[name] >= low) & (s[name] <= high))),
        lambda s, row: f"is {s[name][row]:g}{unit}; it must lie from {low:g} to {high:g}{unit}",
    )


def whole(name: str) -> Check:
    """A number is whole."""
    return name, lambda s: s[name] != np.rint(s[name]), lambda s, row: f"is {s[name][row]:g}; it must be a whole number"


def steady(name: str) -> Check:
    """All rows of a pass have the same number, or none has one."""

    def changes(s: Segments) -> Rows:
        first = s[name][s.first_row[:-1]][s.pass_of_row]
        same: Rows = (s[name] == first) | (np.isnan(s[name]) & np.isnan(first))
        return ~same

    return name, changes, lambda s, row: f"changes to {s[name][row]:g} within the pass; it must be one number"


def duplicated(s: Segments) -> Rows:
    """Rows that are the row before once more."""
    same: Rows = (s.step(s["time_s"]) == 0.0) & (s.step(s["path_m"]) == 0.0)
    speed = s["speed_m_s"]
    same &= (s.step(speed) == 0.0) | np.isnan(speed)
    same[s.first_row[:-1]] = False
    return same


def far_off(name: str) -> Check:
    """The column holds numbers of no clock and no track."""
    return (
        name,
        lambda s: np.abs(s[name]) > FARTHEST,
        lambda s, row: f"is {s[name][row]:g}; it must lie from {-FARTHEST:g} to {FARTHEST:g}",
    )


def clock_stands_or_goes_back(s: Segments) -> Rows:
    """Rows no later than the row before."""
    late: Rows = s.step(s["time_s"]) <= 0.0
    late[s.first_row[:-1]] = False
    return late


def expected_m(s: Segments) -> Floats:
    """How far the measured speeds go from the row before."""
    speed = np.nan_to_num(s["speed_m_s"], nan=0.0, posinf=0.0, neginf=0.0)
    return np.maximum(speed, speed + np.nan_to_num(-s.step(speed))) * s.step(s["time_s"])


def clock_jumps(s: Segments) -> Rows:
    """A long gap in time in which the path shows that less time has passed."""
    long = s.step(s["time_s"]) > LONGEST_GAP_S
    return long & (s.step(s["path_m"]) < 0.5 * expected_m(s))


def gap(s: Segments) -> Rows:
    """More than a second without a row."""
    return s.step(s["time_s"]) > LONGEST_GAP_S * (1.0 + 1e-9)


def path_goes_back(s: Segments) -> Rows:
    """Rows more than the tolerance behind the farthest row before, but for what the path was set anew."""
    reset = path_resets_m(s["time_s"], s["path_m"], s["speed_m_s"], s.first_row)
    path = s["path_m"] - np.cumsum(reset)
    back = s.step(path) < 0.0
    found = np.zeros(len(path), dtype=np.bool_)
    for number in np.unique(s.pass_of_row[back]).tolist():
        rows = slice(int(s.first_row[number]), int(s.first_row[number + 1]))
        found[rows] = path[rows] < np.maximum.accumulate(path[rows]) - LARGEST_STEP_BACK_M
    return found


def path_jumps(s: Segments) -> Rows:
    """Rows farther on than any car rolls."""
    farthest = FASTEST_M_S * np.maximum(0.0, s.step(s["time_s"])) + LOOSE_PATH_M
    far: Rows = s.step(s["path_m"]) > farthest
    return far


def category_changes(s: Segments) -> Rows:
    """Rows within a pass at which the category becomes another."""
    return starts(s.columns.category, s.columns.rows) & ~starts(s.columns.cut_id, s.columns.rows)


def starts(runs: TextRuns, rows: int) -> Rows:
    """Rows in which a run begins."""
    found = np.zeros(rows, dtype=np.bool_)
    found[np.array(runs.first_row)] = True
    return found


def too_short(s: Segments) -> Rows:
    """All rows of passes with too few."""
    return (np.diff(s.first_row) < FEWEST_ROWS)[s.pass_of_row]


CHECKS: Final[tuple[Check, ...]] = (
    missing("time_s"),
    missing("path_m"),
    missing("stage"),
    missing("mass_t"),
    missing("axles"),
    far_off("time_s"),
    far_off("path_m"),
    ("time_s", duplicated, lambda _, __: "and all others are those of the row before; take one of the two out"),
    (
        "time_s", clock_stands_or_goes_back,
        lambda s, row: f"is {s['time_s'][row]:.3f} s, {-s.step(s['time_s'])[row]:.3f} s back; the clock must go on",
    ),
    (
        "time_s", clock_jumps,
        lambda s, row: f"jumps by {s.step(s['time_s'])[row]:.3f} s, but the path goes on by "
        f"{s.step(s['path_m'])[row]:.2f} m only; set the clock between passes",
    ),
    (
        "time_s", gap,
        lambda s, row: f"is {s.step(s['time_s'])[row]:.2f} s after the row before; at most {LONGEST_GAP_S:g} s may be",
    ),
    (
        "path_m", path_goes_back,
        lambda s, row: f"is {s['path_m'][row]:.2f}, more than {LARGEST_STEP_BACK_M:g} m behind a row before it; a cut "
        "must not roll back",
    ),
    (
        "path_m", path_jumps,
        lambda s, row: f"jumps by {s.step(s['path_m'])[row]:.2f} m in {s.step(s['time_s'])[row]:.2f} s; no car does",
    ),
    within("speed_m_s"),
    whole("stage"),
    (
        "stage", lambda s: (s["stage"] < 0.0) | (s["stage"] > s.top_stage),
        lambda s, row: f"is {s['stage'][row]:g}; the position has stages 0 to {s.top_stage}",
    ),
    within("pressure_kpa"),
    within("mass_t"),
    whole("axles"),
    within("axles"),
    within("target_m_s"),
    ("stopped_by_hand", lambda s: (s["stopped_by_hand"] != 0.0) & (s["stopped_by_hand"] != 1.0),
     lambda s, row: f"is {s['stopped_by_hand'][row]:g}; it must be 0 or 1"),
    *(steady(name) for name in CONSTANT),
    ("category", category_changes, lambda _, __: "changes within the pass; it must be one category"),
    ("cut_id", too_short, lambda s, row: f"stands in too few rows: {np.diff(s.first_row)[s.pass_of_row[row]]}; a "
     f"pass has {FEWEST_ROWS} or more"),
)  # fmt: skip
"""In the order in which they are told; values that are not there come before all others."""
