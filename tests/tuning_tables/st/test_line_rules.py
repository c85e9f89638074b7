"""The rules of tables with lines, run from their parse tree, answer as the Python text that they were printed from."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from scripts.studies.in_the_loop.agreement import Questions, ask, observed
from scripts.studies.in_the_loop.controller_process import ANSWER_WORDS, held_words, places
from scripts.studies.in_the_loop.hard_questions import TRACK_SAMPLES, hard_samples
from tests.controller_code.sample_book import approaching_book, estimating_book, sample_book, surface_book
from tests.effort import MANY, sized
from tests.tuning_tables.st.conftest import shaped_book, texts_of
from tests.tuning_tables.st.evaluator import Program
from tests.tuning_tables.st.exported_forms import default_book
from tests.tuning_tables.st.storage import Frame
from tests.tuning_tables.st.syntax import ASKED_UNDER, Compiler, name_of
from tuning_tables.exports import TABLE_FILE
from tuning_tables.golden_tracks import golden_tracks
from tuning_tables.language.records import Kind, st_name
from tuning_tables.programs.held import ESTIMATE, LINE_TABLE
from tuning_tables.self_test_size import SMALL
from tuning_tables.table_book import Status, TableBook

BOOKS: Mapping[str, Callable[[], TableBook]] = {
    "measured": sample_book,
    "estimated": estimating_book,
    "approached": approaching_book,
    "surfaces": surface_book,
    "default": default_book,
    "smallest": lambda: shaped_book(2, 0),
}
READINGS, SAMPLES, COMMANDS = sized((100_000, 2_000, 3_000), (MANY // 2, 12_000, 3_000))


@pytest.fixture(scope="module", params=[*BOOKS.values()], ids=[*BOOKS])
def asked(request: pytest.FixtureRequest) -> Questions:
    """Hard readings and commands of a book, with the answers of Python."""
    return ask(request.param(), READINGS, COMMANDS, 20261126)


@pytest.fixture(scope="module", params=ASKED_UNDER, ids=name_of)
def program(request: pytest.FixtureRequest, asked: Questions) -> Program:
    """The text of the book, run as a compiler does."""
    compiler: Compiler = request.param
    return Program(texts_of(asked.book, SMALL)[TABLE_FILE], compiler)


def loaded(program: Program, number: int) -> Frame:
    """Table `number` as RETARDER_LOAD gives it."""
    loader, table = program.new("RETARDER_LOAD"), program.new("RETARDER_TABLE")
    program.call("RETARDER_LOAD", loader, TableNo=number, Table=table)
    assert loader["FOUND"].value
    return table


def decisions(program: Program, readings: npt.NDArray[np.void]) -> npt.NDArray[np.int64]:
    """What RETARDER_DECIDE answers to readings, dtype READING."""
    found = np.full(len(readings), -(2**31))
    for number in np.unique(readings["table"]).tolist():
        here, decider = readings["table"] == number, program.new("RETARDER_DECIDE")
        # An INT has 16 bits, so that a wider stage cannot reach the block.
        stage = readings["stage"][here]
        narrow = np.clip(stage, -32768, 32767)
        s, v, kpa = (readings[name][here] for name in ("s_m", "v_m_s", "pressure_kpa"))
        given = {"Stage": narrow, "Path_m": s, "Speed_m_s": v, "Pressure_kpa": kpa}
        program.call("RETARDER_DECIDE", decider, **given, Table=loaded(program, number))
        wanted = decider["WANTED"].value
        found[here] = np.where(wanted == narrow, stage, wanted)
    return found


@pytest.mark.requirement("CODE-02")
def test_hard_readings_are_decided_alike(asked: Questions, program: Program) -> None:
    """Readings on lines and beside them, far off, and no numbers."""
    found = decisions(program, asked.readings)
    assert np.count_nonzero(found != asked.decisions) == 0
    far = found - asked.readings["stage"]
    assert min(np.count_nonzero(far != 0), np.count_nonzero(far == 0)) > 0.02 * READINGS


def select(program: Program, commands: npt.NDArray[np.void]) -> tuple[npt.NDArray[np.int64], Mapping[str, Any]]:
    """Statuses of the commands, and of every member of the table chosen its numbers, a row a command."""
    selector, table = program.new("RETARDER_SELECT"), program.new("RETARDER_TABLE")
    category, axles = (commands[name].astype(np.int64) for name in ("category", "axles"))
    speed = commands["speed_m_s"]
    program.call("RETARDER_SELECT", selector, Category=category, Axles=axles, Commanded_m_s=speed, Table=table)
    cells = {name: row.data if hasattr(row, "data") else row.value for name, row in table.items()}
    return selector["STATUS"].value, cells


@pytest.mark.requirement("CODE-02")
def test_the_choice_is_that_of_python(asked: Questions, program: Program) -> None:
    """Every number of the chosen table: bits, except the sign of 0."""
    statuses, table = select(program, asked.commands)
    assert np.count_nonzero(statuses != asked.statuses) == 0
    chosen = statuses >= 0
    assert not table["STAGES"][~chosen].any()
    for name, place in places(asked.book).items():
        words = asked.chosen[chosen][:, place]
        due = words.view(np.float32) if LINE_TABLE.members[name].kind is Kind.REAL else words.view(np.int32)
        found = np.asarray(table[st_name(name).upper()])
        found = found[chosen] if found.ndim else np.full(np.count_nonzero(chosen), found)
        assert np.array_equal(found.reshape(due.shape), due), name


def test_every_status_occurs() -> None:
    found = {int(each) for make in BOOKS.values() for each in ask(make(), READINGS, COMMANDS, 1).statuses}
    assert found == {int(status) for status in Status}


@pytest.mark.requirement("CODE-02")
def test_hard_samples_are_estimated_alike(asked: Questions, program: Program) -> None:
    """Speed, alarms and every number of the estimate after each sample of tracks of 100."""
    book = asked.book
    samples = hard_samples(book, SAMPLES, 20261123)
    samples["start"] = np.where(samples["start"] == 2, 0, samples["start"])
    samples = samples[sum(map(len, golden_tracks(book))) :]  # the golden tracks come first, of other lengths
    answers = observed(book, samples).reshape(-1, TRACK_SAMPLES, ANSWER_WORDS)
    samples = samples.reshape(-1, TRACK_SAMPLES)
    for number in np.unique(samples["table"]).tolist():
        here = samples["table"][:, 0] == number
        found, alarms = followed(program, number, samples[here])
        due = answers[here][..., :-1].view(np.float32)
        assert ((found == due) | (np.isnan(found) & np.isnan(due))).all()
        assert np.array_equal(alarms, answers[here][..., -1])


def followed(
    program: Program, number: int, samples: npt.NDArray[np.void]
) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.int64]]:
    """Speed and estimate, (tracks, samples, 17), and alarms, (tracks, samples), of tracks of one table."""
    table, estimate = loaded(program, number), program.new("RETARDER_ESTIMATE")
    observer, beginner, alarmer = (program.new(f"RETARDER_{each}") for each in ("OBSERVE", "BEGIN", "ALARMS"))
    program.call("RETARDER_BEGIN", beginner, Estimate=estimate)
    found, alarms = [], []
    for now in samples.T:
        given = {"Path_m": now["s_m"], "Speed_m_s": now["v_m_s"], "Overpressure_kpa": now["overpressure_kpa"]}
        program.call("RETARDER_OBSERVE", observer, **given, Table=table, Estimate=estimate)
        program.call("RETARDER_ALARMS", alarmer, Table=table, Estimate=estimate)
        values = [observer["OBSERVED"].value, *(estimate[st_name(name).upper()].value for name in ESTIMATE.members)]
        found.append(np.stack([np.broadcast_to(value, now.shape).astype(np.float32) for value in values], axis=-1))
        alarms.append(np.broadcast_to(alarmer["RAISED"].value, now.shape))
    return np.stack(found, axis=1), np.stack(alarms, axis=1)


def test_a_loaded_table_has_every_number(asked: Questions, program: Program) -> None:
    for number in range(len(asked.book.tables)):
        table, words = loaded(program, number), held_words(asked.book, number)
        for name, place in places(asked.book).items():
            cell = table[st_name(name).upper()]
            found = cell.data.ravel() if hasattr(cell, "data") else np.atleast_1d(cell.value)
            is_real = LINE_TABLE.members[name].kind is Kind.REAL
            assert np.array_equal(found, words[place].view(np.float32 if is_real else np.int32)), name


@pytest.mark.requirement("CODE-07")
@pytest.mark.parametrize("stages", [-32768, -1, 0, 6, 32767])
@pytest.mark.parametrize("powers", [-32768, 0, 5, 32767])
def test_a_table_that_was_never_loaded_or_is_spoilt_holds(stages: int, powers: int) -> None:
    program = Program(texts_of(default_book(), SMALL)[TABLE_FILE])
    table, decider = program.new("RETARDER_TABLE"), program.new("RETARDER_DECIDE")
    for key, value in (("STAGES", stages), ("POWERS", powers)):
        table[key].store(value, None)
    table["HASLINE"].data[:] = 1
    stage = np.array([-32768, -1, 0, 4, 5, 6, 32766, 32767])
    given = {"Stage": stage, "Path_m": 10.0, "Speed_m_s": 100.0, "Pressure_kpa": 0.0}
    program.call("RETARDER_DECIDE", decider, **given, Table=table)
    assert np.array_equal(decider["WANTED"].value, stage)


def test_no_such_table_leaves_none_behind() -> None:
    program = Program(texts_of(default_book(), SMALL)[TABLE_FILE])
    for number in (-32768, -1, 6, 32767):
        loader, table = program.new("RETARDER_LOAD"), loaded(program, 0)
        assert table["STAGES"].value == 5
        program.call("RETARDER_LOAD", loader, TableNo=number, Table=table)
        assert not loader["FOUND"].value
        assert table["STAGES"].value == 0


@pytest.mark.parametrize("breaks", [-32768, -1, 1, 41, 32767])
def test_a_spoilt_number_of_breaks_is_not_followed(breaks: int) -> None:
    program = Program(texts_of(estimating_book(), SMALL)[TABLE_FILE])
    table, observer, estimate = loaded(program, 0), program.new("RETARDER_OBSERVE"), program.new("RETARDER_ESTIMATE")
    table["BREAKS"].store(breaks, None)
    given = {"Path_m": 1.0, "Speed_m_s": 3.0, "Overpressure_kpa": 100.0}
    program.call("RETARDER_OBSERVE", observer, **given, Table=table, Estimate=estimate)
    # A negative number is none: the reading is handed on.
    assert observer["OBSERVED"].value == (-1.0 if breaks > 0 else 3.0)
    assert estimate["UNSEEN"].value == (1.0 if breaks > 0 else 0.0)
