"""What the Python estimator, compiled by numba, answers to samples."""

from __future__ import annotations

from functools import cache
from typing import Any, Final

import numpy as np
from numba import njit
from numpy.typing import NDArray

from scripts.studies.in_the_loop.controller_process import ANSWER_WORDS, BEGIN, ESTIMATE_WORDS, GIVEN
from synth.kernels.compiled_rules import compiled_rule
from tuning_tables.programs.alarms import alarms
from tuning_tables.programs.observe import observe
from tuning_tables.table_book import TableBook

ONE_NAN: Final = np.uint32(0x7FC00000)


def observed(book: TableBook, samples: NDArray[np.void]) -> NDArray[np.uint32]:
    """For `samples`, dtype SAMPLE, (n,): the bits of the estimated speed and of the estimate after it, and the alarm
    word, (n, 18).

    Every track, which a sample with start BEGIN begins, must be of one table. NaN has the bits that it comes with.
    """
    answers = np.zeros((len(samples), ANSWER_WORDS), np.uint32)
    follow = _following()
    begins = np.flatnonzero(samples["start"] == BEGIN)
    for first, end in zip(begins, [*begins[1:], len(samples)], strict=True):
        part = samples[first:end]
        table = book.tables[part["table"][0]].held
        columns = [np.ascontiguousarray(part[name]) for name in ("start", "s_m", "v_m_s", "overpressure_kpa", "given")]
        follow(table, *columns, answers[first:end])
        if table.breaks == 0:  # a NaN keeps its bits, which numba does not promise
            answers[first:end, 0] = part["v_m_s"].view(np.uint32)
    return answers


def same_nan(words: NDArray[np.uint32]) -> NDArray[np.uint32]:
    """`words` of float32 numbers with one bit pattern for every NaN: which one results depends on the processor."""
    return np.where(np.isnan(words.view(np.float32)), ONE_NAN, words)


@cache
def _following() -> Any:
    """A function that lets the estimator follow one track; compiled anew in a process, so that no stale cache is asked.

    Words are copied one by one: numba takes seconds to compile the message for arrays that do not fit.
    """
    estimated_speed, alarm_word = compiled_rule(observe, fresh=True), compiled_rule(alarms, fresh=True)

    @njit(error_model="numpy")
    def follow(table, start, s_m, v_m_s, kpa, given, answers):  # type: ignore[no-untyped-def]  # numba infers the types
        state = np.zeros(ESTIMATE_WORDS, np.float32)
        words = state.view(np.uint32)
        speed = np.zeros(1, np.float32)
        for i in range(start.shape[0]):
            if start[i] == BEGIN:
                state[:] = 0.0
            elif start[i] == GIVEN:
                for k in range(ESTIMATE_WORDS):
                    words[k] = given[i, k]
            speed[0] = estimated_speed(table, state, s_m[i], v_m_s[i], kpa[i])
            answers[i, 0] = speed.view(np.uint32)[0]
            for k in range(ESTIMATE_WORDS):
                answers[i, 1 + k] = words[k]
            answers[i, 1 + ESTIMATE_WORDS] = alarm_word(table, state)

    return follow
