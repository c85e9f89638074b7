"""Several logs as one, and the times of passes that come one after the other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from tuning_tables.errors import InvalidTable
from tuning_tables.pass_log.pass_log import PASSES, ROWS, PassLog


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
