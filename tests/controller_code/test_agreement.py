"""Compiled C decides as the Python rule does, for every compiler, level and processor there is."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from synth.in_the_loop.agreement import Questions, ask, decisions_of, differences
from synth.in_the_loop.builds import BUILDS, Build
from synth.in_the_loop.controller_process import BuildError, build_controller
from tests.controller_code.conftest import Tool
from tuning_tables import decide_for
from tuning_tables.table_book import Status, TableBook

READINGS, COMMANDS = 1_000_000, 20_000


@pytest.fixture(scope="session")
def questions(book: TableBook) -> Questions:
    return ask(book, READINGS, COMMANDS, 20261121)


@pytest.mark.parametrize("build", BUILDS, ids=str)
def test_c_decides_and_chooses_as_python(build: Build, questions: Questions, tmp_path: Path, tool: Tool) -> None:
    for name in build.missing():
        tool(name)
    assert differences(build.controller(questions.book, tmp_path), questions).none


def test_the_readings_reach_every_answer_and_many_ties(questions: Questions) -> None:
    readings, decisions = questions.readings, questions.decisions
    assert len(readings) == READINGS
    tiny = np.finfo(np.float32).smallest_normal
    for key in ("s_m", "v_m_s"):
        values = readings[key]
        assert np.count_nonzero(np.isnan(values)) > 1000
        assert np.count_nonzero(np.isinf(values)) > 1000
        assert np.count_nonzero((values != 0) & (np.abs(values) < tiny)) > 1000
    assert all(np.count_nonzero(decisions == answer) > 50_000 for answer in (-1, 0, 1))
    stepped = readings.copy()
    with np.errstate(over="ignore", invalid="ignore"):
        stepped["v_m_s"] = np.nextafter(readings["v_m_s"], np.float32(np.inf))
    # One step of float32 changes the answer: these lie on a line, or just beside it.
    assert np.count_nonzero(decisions_of(questions.book, stepped) != decisions) > 50_000


def test_the_commands_reach_every_status(questions: Questions) -> None:
    assert {int(status) for status in Status} == set(questions.statuses.tolist())
    assert all(np.count_nonzero(questions.statuses == status) > 20 for status in Status)


def test_one_reading_at_a_time_is_decided_as_many(questions: Questions) -> None:
    for place in np.random.default_rng(5).integers(0, READINGS, 5000):
        table, stage, s, v = questions.readings[place]
        assert decide_for(questions.book.tables[table], int(stage), s, v) == questions.decisions[place]


@pytest.mark.parametrize("flag", ["-ffast-math", "-ffinite-math-only"])
@pytest.mark.parametrize("compiler", ["gcc", "clang"])
def test_switches_that_break_the_rule_are_refused(
    compiler: str, flag: str, book: TableBook, tmp_path: Path, tool: Tool
) -> None:
    with pytest.raises(BuildError, match="compile without -ffast-math"):
        build_controller(book, tmp_path, tool(compiler), (flag,))
