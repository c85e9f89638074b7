"""Whether a compiled controller decides, chooses and estimates as the Python rule does, and as the Python
estimator, compiled by numba.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import Any, Final

import numpy as np
from numba import njit
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from scripts.studies.in_the_loop.controller_process import (
    ANSWER_WORDS,
    BEGIN,
    ESTIMATE_WORDS,
    GIVEN,
    Controller,
    held_words,
    table_words,
)
from scripts.studies.in_the_loop.hard_questions import hard_commands, hard_readings, hard_samples
from synth.kernels.compiled_rules import compiled_rule
from tuning_tables import decide_many
from tuning_tables.programs.decide import alarms
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


@frozen_arrays
class Questions:
    """Readings and commands, and what the Python rule answers: stages (n,), statuses (m,), words (m, words)."""

    book: TableBook
    readings: NDArray[np.void]
    decisions: NDArray[np.int32]
    commands: NDArray[np.void]
    statuses: NDArray[np.int32]
    chosen: NDArray[np.uint32]


@frozen_arrays
class Tracks:
    """Samples, dtype SAMPLE, (n,), and what the Python estimator answers to each: speed, estimate, alarms, (n, 18)."""

    samples: NDArray[np.void]
    estimates: NDArray[np.uint32]


@dataclass(frozen=True)
class Differences:
    """How many answers of a controller are others, words of tables that are others, and what its self-test says.

    `estimates`: samples after which the speed or anything in the estimate has another bit; a NaN is as good as any.
    """

    decisions: int
    choices: int
    estimates: int
    tables: int
    self_test: str

    @property
    def none(self) -> bool:
        """Whether the controller agrees in everything."""
        wrong = self.decisions + self.choices + self.estimates + self.tables
        return wrong == 0 and self.self_test == "fault 0 at 0"


def ask(book: TableBook, readings: int, commands: int, seed: int) -> Questions:
    """`readings` hard readings and at least `commands` commands of `seed`, answered by the Python rule."""
    asked, commanded = hard_readings(book, readings, seed), hard_commands(book, commands, seed + 1)
    return Questions(book, asked, decisions_of(book, asked), commanded, *choices_of(book, commanded))


def follow(book: TableBook, samples: int, seed: int) -> Tracks:
    """At least `samples` hard samples of `seed`, followed by the Python estimator."""
    given = hard_samples(book, samples, seed)
    return Tracks(given, observed(book, given))


def differences(controller: Controller, questions: Questions, tracks: Tracks) -> Differences:
    """Put the same questions and tracks to `controller`."""
    book = questions.book
    statuses, chosen = controller.select(questions.commands)
    wrong = (statuses != questions.statuses) | (chosen != questions.chosen).any(axis=1)
    astray = (same_nan(controller.observe(tracks.samples)) != same_nan(tracks.estimates)).any(axis=1)
    words = np.array([held_words(book, number) for number in range(len(book.tables))])
    return Differences(
        decisions=int(np.count_nonzero(controller.decide(questions.readings) != questions.decisions)),
        choices=int(np.count_nonzero(wrong)),
        estimates=int(np.count_nonzero(astray)),
        tables=int(np.count_nonzero(controller.dump() != words)),
        self_test=controller.self_test(),
    )


def decisions_of(book: TableBook, readings: NDArray[np.void]) -> NDArray[np.int32]:
    """The stages to command by the Python rule, table by table."""
    found = np.empty(len(readings), np.int32)
    for number, table in enumerate(book.tables):
        of_table = readings["table"] == number
        now = readings[of_table]
        found[of_table] = decide_many(table, now["stage"], now["s_m"], now["v_m_s"], now["pressure_kpa"])
    return found


def choices_of(book: TableBook, commands: NDArray[np.void]) -> tuple[NDArray[np.int32], NDArray[np.uint32]]:
    """What `TableBook.choose` answers, as the controller writes it: words of no table are 0."""
    chosen = np.zeros((len(commands), table_words(book)), np.uint32)
    statuses = np.empty(len(commands), np.int32)
    names = {number: name for name, number in book.category_numbers.items()}
    for place, (category, axles, speed) in enumerate(commands.tolist()):
        choice = book.choose(names.get(category, "no category"), axles, speed)
        statuses[place] = choice.status
        if choice.table is not None:
            chosen[place] = held_words(book, choice.numbers[0], choice.table)
    return statuses, chosen
