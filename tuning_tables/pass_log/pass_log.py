"""Measured passes of one retarder position, row by row, as its controller logs them: several logs as one, and
where within a pass the path was set anew.

Where within a pass the path was set anew: a treadle corrects a path that was counted or summed up until there. The cut
did not move by that. The speed says how far it went; what the path says beyond it is the correction.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from tuning_tables.errors import InvalidTable
from tuning_tables.pass_log.log_columns import Floats, Ints

LEAST_RESET_M: Final = 0.1
"""Smaller corrections are hardly told from noise, and do little."""

LARGEST_RESET_M: Final = 1.0
"""A path that was more wrong than this is not corrected, but wrong."""

CLEAR: Final = 6.0
"""How many standard deviations of the pass's other steps a correction must be."""

LONGEST_STEP: Final = 1.5
"""Steps in time that are longer than so many usual ones are not judged: the clock may have jumped."""


def path_resets_m(time_s: Floats, path_m: Floats, speed_m_s: Floats, first_row: Ints) -> Floats:
    """By how much the path of each row was set anew since the row before, (n,); 0 where it was not.

    Rows as in `PassLog`. The steps beside a correction must go as the speed says; so neither a wrong reading of the
    speed nor a path that goes on by jumps is taken for one.
    """
    found = np.zeros(len(time_s))
    with np.errstate(invalid="ignore", over="ignore"):
        ahead, back = speed_m_s[:-1], speed_m_s[1:]
        speed = 0.5 * (np.where(np.isnan(ahead), back, ahead) + np.where(np.isnan(back), ahead, back))
        step_s = np.diff(time_s)
        off = np.diff(path_m) - speed * step_s
        inner = np.ones(len(off), dtype=np.bool_)
        inner[first_row[1:-1] - 1] = False
        candidates = np.flatnonzero(inner & (np.abs(off) >= LEAST_RESET_M) & (np.abs(off) <= LARGEST_RESET_M))
        passes = np.searchsorted(first_row, candidates, side="right") - 1
        for number in np.unique(passes).tolist():
            begin, end = int(first_row[number]), int(first_row[number + 1]) - 1
            at = candidates[passes == number]
            for step in at[corrections(off[begin:end], step_s[begin:end], at - begin)].tolist():
                found[step + 1] = off[step]
    return found


def corrections(off_m: Floats, step_s: Floats, at: Ints) -> npt.NDArray[np.bool_]:
    """Which of the steps `at` of one pass are corrections; `off_m`: by how much its steps are longer than the speed
    says, `step_s`: how long they take."""
    known = off_m[np.isfinite(off_m)]
    spread = 1.4826 * float(np.median(np.abs(known - np.median(known))))
    least = max(LEAST_RESET_M, CLEAR * spread)
    wrong = np.abs(off_m) >= least
    beside = np.concatenate(([False], wrong, [False]))
    usual = step_s[at] <= LONGEST_STEP * float(np.median(step_s))
    return np.asarray(wrong[at] & ~beside[at] & ~beside[at + 2] & usual)


def path_set_right_m(path_m: Floats, reset_m: Floats, first_row: Ints) -> Floats:
    """The path without its jumps, (n,); `reset_m` as `path_resets_m` found them.

    Where it was set anew it is right. Ahead of the first such place of a pass it is shifted, so that its steps stay;
    between two of them it is stretched evenly, because it is right at both ends.
    """
    path = path_m.copy()
    rows = np.flatnonzero(reset_m)
    passes = np.searchsorted(first_row, rows, side="right") - 1
    for place, (row, number) in enumerate(zip(rows.tolist(), passes.tolist(), strict=True)):
        if place == 0 or passes[place - 1] != number:
            path[first_row[number] : row] += reset_m[row]
            continue
        part = slice(int(rows[place - 1]), row)
        gone = path_m[part] - path_m[part.start]
        path[part] += reset_m[row] * gone / max(float(gone[-1]), LEAST_RESET_M)
    return path


ROWS = ("time_s", "path_m", "speed_m_s", "pressure_kpa", "stage")
PASSES = ("cut_id", "mass_t", "axles", "category", "target_m_s", "stopped_by_hand")


@dataclass(frozen=True, eq=False)
class PassLog:
    """Passes in the order in which cuts came; rows of a pass in the order of time.

    Rows, arrays (n,): `time_s` of one clock for all passes; `path_m` of the first axle behind the entrance of the
    first retarder, negative ahead of it; `speed_m_s` as measured, NaN where there was no reading; `pressure_kpa` of a
    gauge on the drive, NaN where there is none; `stage` that is commanded from this row on.
    Passes, m of them: `first_row` (m + 1,), where the rows of each begin and the last end; `cut_id`; `mass_t` of the
    cut; `axles`; `category` of its weight; `target_m_s`, the commanded exit speed, NaN where none is known;
    `stopped_by_hand`: a person took part in it.
    `path_is_independent`: the path was not summed up from the measured speed, so one can be held against the other.

    Arrays are read-only. `InvalidTable` where lengths do not fit or a pass has fewer than two rows.

    Examples
    --------
    >>> import numpy as np
    >>> from tuning_tables.pass_log import PassLog
    >>> log = PassLog(
    ...     time_s=0.1 * np.arange(6),
    ...     path_m=0.5 * np.arange(6),
    ...     speed_m_s=np.full(6, 5.0),
    ...     pressure_kpa=np.zeros(6),
    ...     stage=np.array([0, 0, 1, 1, 1, 0]),
    ...     first_row=np.array([0, 6]),
    ...     cut_id=("17",),
    ...     mass_t=np.array([52.0]),
    ...     axles=np.array([4]),
    ...     category=("С",),
    ...     target_m_s=np.array([3.0]),
    ...     stopped_by_hand=np.array([False]),
    ... )
    >>> log, log.has_gauge, log.stage[log.rows(0)]
    (PassLog(1 passes, 6 rows), True, array([0, 0, 1, 1, 1, 0]))
    """

    time_s: Floats
    path_m: Floats
    speed_m_s: Floats
    pressure_kpa: Floats
    stage: Ints
    first_row: Ints
    cut_id: tuple[str, ...]
    mass_t: Floats
    axles: Ints
    category: tuple[str, ...]
    target_m_s: Floats
    stopped_by_hand: npt.NDArray[np.bool_]
    path_is_independent: bool = True

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if isinstance(value, np.ndarray):
                value = value.view()
                value.setflags(write=False)
                object.__setattr__(self, field.name, value)
        if any(len(getattr(self, name)) != len(self.time_s) for name in ROWS):
            raise InvalidTable(f"pass log: {', '.join(ROWS)} must have one entry a row.")
        if any(len(getattr(self, name)) != len(self) for name in PASSES):
            raise InvalidTable(f"pass log: {', '.join(PASSES)} must have one entry a pass.")
        ends = self.first_row
        if len(ends) < 1 or ends[0] != 0 or ends[-1] != len(self.time_s) or not (np.diff(ends) >= 2).all():
            raise InvalidTable("pass log: first_row must rise from 0 to the number of rows, by 2 at least.")

    def __repr__(self) -> str:
        return f"PassLog({len(self)} passes, {len(self.time_s)} rows)"

    def __len__(self) -> int:
        return len(self.first_row) - 1

    @property
    def pass_of_row(self) -> Ints:
        """Number of the pass that each row belongs to, (n,)."""
        return np.repeat(np.arange(len(self)), np.diff(self.first_row))

    @property
    def has_gauge(self) -> bool:
        """Whether any row has a pressure."""
        return bool(np.isfinite(self.pressure_kpa).any())

    def rows(self, number: int) -> slice:
        """The rows of pass `number`."""
        return slice(int(self.first_row[number]), int(self.first_row[number + 1]))

    def taken(self, numbers: npt.ArrayLike) -> PassLog:
        """The passes of these numbers, in this order."""
        chosen = np.asarray(numbers, dtype=np.int64)
        counts = np.diff(self.first_row)[chosen]
        ends = np.concatenate(([0], np.cumsum(counts)))
        rows = np.repeat(self.first_row[:-1][chosen] - ends[:-1], counts) + np.arange(ends[-1])
        parts = {name: getattr(self, name)[rows] for name in ROWS}
        for name in PASSES:
            value = getattr(self, name)
            parts[name] = tuple(value[i] for i in chosen) if isinstance(value, tuple) else value[chosen]
        return replace(self, first_row=ends, **parts)


def join_logs(logs: Sequence[PassLog]) -> PassLog:
    """The passes of all `logs` in the order given; the path is independent if it is so in every one.

    `InvalidTable` for no logs.
    """
    if not logs:
        raise InvalidTable("pass log: there is no log to join.")
    parts: dict[str, Any] = {name: np.concatenate([getattr(log, name) for log in logs]) for name in ROWS}
    for name in PASSES:
        values = [getattr(log, name) for log in logs]
        texts = isinstance(values[0], tuple)
        parts[name] = tuple(text for value in values for text in value) if texts else np.concatenate(values)
    counts = np.concatenate([np.diff(log.first_row) for log in logs])
    ends = np.concatenate(([0], np.cumsum(counts))).astype(np.int64)
    return PassLog(**parts, first_row=ends, path_is_independent=all(log.path_is_independent for log in logs))


def one_after_the_other(log: PassLog, gap_s: float) -> PassLog:
    """The same passes, each beginning `gap_s` after the last row of the one before, the first at 0.

    Beginnings are rounded to milliseconds, so that times are short in a file.
    """
    within = log.time_s - np.repeat(log.time_s[log.first_row[:-1]], np.diff(log.first_row))
    lasting = within[log.first_row[1:] - 1]
    starts = np.round(np.concatenate(([0.0], np.cumsum(lasting + gap_s)[:-1])), 3)
    return replace(log, time_s=np.round(starts[log.pass_of_row] + within, 9))
