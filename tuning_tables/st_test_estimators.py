"""The blocks of the Structured Text self-test for estimators: their constants once more, and their golden tracks."""

from __future__ import annotations

from string import Template

import numpy as np

from tuning_tables.category_names import comment_text
from tuning_tables.estimator import Estimator
from tuning_tables.golden_tracks import Floats, GoldenTrack, table_tracks
from tuning_tables.held_numbers import TOUCH_PLACE, held_numbers
from tuning_tables.st_estimator import ST_NUMBERS, padded_work, touch_kpa
from tuning_tables.st_literals import bool_array, int_array, is_portable, real, real_array
from tuning_tables.st_tables import constants
from tuning_tables.st_test_blocks import (
    ESTIMATOR_CHECK,
    ESTIMATOR_CONSTANTS,
    ESTIMATOR_HEAD,
    FOOT,
    RESET,
    TRACK_LOOP,
)
from tuning_tables.table_block import BlockSize, block_size
from tuning_tables.table_book import TableBook


def estimator_check(book: TableBook, number: int, estimator: int) -> str:
    """Whether table `number` has the number of its estimator and the touch pressure that it should have."""
    return Template(ESTIMATOR_CHECK).substitute(ESTIMATOR=estimator, TOUCH=real(touch_kpa(book, number)))


def estimator_test(book: TableBook, place: int, number: int) -> str:
    """RETARDER_TEST_ESTIMATOR_place: the estimator of table `number`, or that there is none."""
    table, size = book.tables[number], block_size(book)
    begins, samples = _portable_samples(table_tracks(number, table))
    declarations, statements, count = [], [], 0
    if table.estimator is not None:
        expected = _expected(table.estimator, size)
        declarations.append(real_array("Expected", expected))
        statements.append(_constants_check(table.estimator, size))
        count = len(expected)
    declarations.append(bool_array("Begins", begins))
    *numbers, alarms = samples
    for name, values in zip(("Path", "Speed", "Pressure", "Observed", "Unseen"), numbers, strict=True):
        declarations.append(real_array(name, values))
    declarations.append(int_array("Alarms", alarms.astype(np.int64)))
    statements.append(Template(TRACK_LOOP).substitute(LAST=len(begins) - 1, FIRST=count))
    name = "no estimator" if table.estimator is None else f"the estimator of {comment_text(table.id)}"
    head = Template(ESTIMATOR_HEAD).substitute(
        PLACE=place, NAME=name.capitalize(), NUMBER=number, CONSTANTS=count, SAMPLES=len(begins)
    )
    return "".join([head, constants(declarations), RESET, *statements, FOOT])


def _expected(estimator: Estimator, size: BlockSize) -> Floats:
    numbers = np.delete(held_numbers(estimator), TOUCH_PLACE)
    return np.concatenate([numbers, padded_work(estimator, size).ravel()])


def _constants_check(estimator: Estimator, size: BlockSize) -> str:
    first = len(ST_NUMBERS)
    differs = (f"\n    OR (Table.{each.st} <> Expected[{place}])" for place, each in enumerate(ST_NUMBERS))
    return Template(ESTIMATOR_CONSTANTS).substitute(
        BREAKS=len(estimator.s_m), LAST_BREAK=size.breaks - 1, DIFFERS="".join(differs), PATH=first,
        DRIVE=first + size.breaks, BRAKE=first + 2 * size.breaks,
    )  # fmt: skip


def _portable_samples(tracks: tuple[GoldenTrack, ...]) -> tuple[list[bool], tuple[Floats, ...]]:
    """Of the tracks of which all numbers are portable: whether each sample begins a cut, and `GoldenTrack.samples`."""
    kept = [track.samples for track in tracks if all(is_portable(values).all() for values in track.samples)]
    begins = [index == 0 for samples in kept for index in range(len(samples[0]))]
    return begins, tuple(np.concatenate(columns) for columns in zip(*kept, strict=True))
