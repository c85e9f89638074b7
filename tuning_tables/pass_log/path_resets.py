"""Where within a pass the path was set anew: a treadle corrects a path that was counted or summed up until there.

The cut did not move by that. The speed says how far it went; what the path says beyond it is the correction.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

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
