"""Whether a compiled controller decides, chooses and estimates as the Python rule does."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from scripts.studies.in_the_loop.controller_process import Controller
from scripts.studies.in_the_loop.hard_readings import hard_commands, hard_readings
from scripts.studies.in_the_loop.hard_samples import hard_samples
from scripts.studies.in_the_loop.held_words import held_words, table_words
from scripts.studies.in_the_loop.observed import observed, same_nan
from tuning_tables import decide_many
from tuning_tables.table_book import TableBook


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
