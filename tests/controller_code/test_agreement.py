"""Compiled C decides as the Python rule does, for every compiler, level and processor, and in the loop of the
simulator.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from scripts.studies.in_the_loop.agreement import Questions, Tracks, ask, decisions_of, differences, follow
from scripts.studies.in_the_loop.controller_process import Build, BuildError, build_controller
from scripts.studies.in_the_loop.loop_study import PipeLine, closed_loop_with_process
from synth.retarder.estimation.estimator_design import estimator_of
from synth.simulation.random_passes import random_passes
from tests.controller_code.building import FEW_WAYS, WAYS
from tests.controller_code.conftest import BOOKS, Tool
from tests.controller_code.sample_book import with_slopes
from tests.effort import MANY, sized
from tests.synth.case_factory import make_case, make_plant
from tuning_tables import Decisions, decide_for, speed_for
from tuning_tables.estimator import begin
from tuning_tables.table_book import Status, TableBook

EVERY_WAY = ("measured", "surfaces")
"""The book of which most of the code is left out, and the one of which all of it is compiled. The code of the others is
between them, without one definition or another, so they are compiled in few ways."""

PROVED = [
    pytest.param(book, build, id=f"{name}-{build}")
    for name, book in BOOKS.items()
    for build in (WAYS if name in EVERY_WAY else FEW_WAYS)
]

READINGS, COMMANDS, SAMPLES = sized((100_000, 5_000, 20_000), (MANY, 20_000, MANY // 2))


@pytest.fixture(scope="session")
def questions(book: TableBook) -> Questions:
    return ask(book, READINGS, COMMANDS, 20261121)


@pytest.fixture(scope="session")
def tracks(book: TableBook) -> Tracks:
    return follow(book, SAMPLES, 20261122)


@pytest.mark.requirement("CODE-01")
@pytest.mark.parametrize(("book", "build"), PROVED, indirect=["book"], scope="session")
def test_c_decides_chooses_and_estimates_as_python(
    build: Build, questions: Questions, tracks: Tracks, tmp_path: Path, tool: Tool
) -> None:
    for name in build.missing():
        tool(name)
    assert differences(build.controller(questions.book, tmp_path), questions, tracks).none


def test_the_readings_reach_every_answer_and_many_ties(questions: Questions) -> None:
    readings, decisions = questions.readings, questions.decisions
    assert len(readings) == READINGS
    tiny = np.finfo(np.float32).smallest_normal
    for key in ("s_m", "v_m_s"):
        values = readings[key]
        assert np.count_nonzero(np.isnan(values)) > 0.001 * READINGS
        assert np.count_nonzero(np.isinf(values)) > 0.001 * READINGS
        assert np.count_nonzero((values != 0) & (np.abs(values) < tiny)) > 0.001 * READINGS
    far = decisions - readings["stage"]
    assert min(np.count_nonzero(far < 0), np.count_nonzero(far == 0), np.count_nonzero(far > 0)) > 0.05 * READINGS
    assert np.count_nonzero(abs(far) > 1) > 0.02 * READINGS
    stepped = readings.copy()
    with np.errstate(over="ignore", invalid="ignore"):
        stepped["v_m_s"] = np.nextafter(readings["v_m_s"], np.float32(np.inf))
    # One step of float32 changes the answer: these lie on a line, or just beside it.
    assert np.count_nonzero(decisions_of(questions.book, stepped) != decisions) > 0.05 * READINGS


def test_the_commands_reach_every_status(questions: Questions) -> None:
    assert {int(status) for status in Status} == set(questions.statuses.tolist())
    assert all(np.count_nonzero(questions.statuses == status) > 20 for status in Status)


def test_one_reading_at_a_time_is_decided_as_many(questions: Questions) -> None:
    for place in np.random.default_rng(5).integers(0, READINGS, sized(1000, 5000)):
        table, stage, *reading = questions.readings[place]
        assert decide_for(questions.book.tables[table], int(stage), *reading) == questions.decisions[place]


@pytest.mark.requirement("CODE-08")
@pytest.mark.parametrize("flag", ["-ffast-math", "-ffinite-math-only"])
@pytest.mark.parametrize("compiler", ["gcc", "clang"])
def test_switches_that_break_the_rule_are_refused(
    compiler: str, flag: str, book: TableBook, tmp_path: Path, tool: Tool
) -> None:
    with pytest.raises(BuildError, match="compile without -ffast-math"):
        build_controller(book, tmp_path, tool(compiler), (flag,))


def test_the_samples_reach_every_branch_of_the_estimator(tracks: Tracks, book: TableBook) -> None:
    samples, speeds = tracks.samples, tracks.estimates[:, 0].view(np.float32)
    assert len(samples) >= SAMPLES
    if all(table.estimator is None for table in book.tables):
        assert np.array_equal(tracks.estimates[:, 0], samples["v_m_s"].view(np.uint32))
        return
    factors = tracks.estimates[:, 4].view(np.float32)
    for count in (speeds == -1.0, speeds == np.float32(0.2), factors == np.float32(0.3), factors == np.float32(1.9)):
        assert np.count_nonzero(count) > 0.0004 * SAMPLES
    # Most of what is compared are numbers, and no two of them alike.
    assert np.count_nonzero(np.isnan(speeds)) < 0.1 * len(speeds)
    assert len(np.unique(tracks.estimates[:, 0])) > 0.6 * len(speeds)
    for name in ("s_m", "v_m_s", "overpressure_kpa"):
        assert np.count_nonzero(~np.isfinite(samples[name])) > 0.002 * SAMPLES
    assert np.count_nonzero(samples["start"] == 2) > 0.002 * SAMPLES


def test_one_sample_at_a_time_is_observed_as_compiled(tracks: Tracks, book: TableBook) -> None:
    """The estimates of the golden tracks, and those of the first tracks of others, by the interpreted text."""
    begins = np.flatnonzero(tracks.samples["start"] == 1)
    for first in begins[np.linspace(0, len(begins) - 2, 40).astype(np.int64)].tolist():
        state, table = begin(), book.tables[tracks.samples["table"][first]]
        starts = np.flatnonzero(tracks.samples["start"][first + 1 :])
        end = first + 1 + int(starts[0]) if len(starts) else len(tracks.samples)
        for sample, words in zip(tracks.samples[first:end], tracks.estimates[first:end], strict=True):
            with np.errstate(all="ignore"):
                speed = speed_for(table, state, *(float(sample[name]) for name in ("s_m", "v_m_s", "overpressure_kpa")))
            assert np.array_equal(np.float32(speed), words[:1].view(np.float32)[0], equal_nan=True)


@pytest.mark.requirement("CODE-11")
def test_a_process_controls_as_the_rule_in_the_simulator(tmp_path: Path, tool: Tool) -> None:
    tool("gcc")
    first = make_case().table
    plant = make_plant(36.0, len(first.stages))
    other = replace(make_case(target=4.0).table, id="other")
    observing = replace(first, id="observing", target_speed_m_s=2.0, estimator=estimator_of(plant))
    book = TableBook((first, other, observing))
    controller = build_controller(book, tmp_path)
    passes, line = random_passes(3, 0, 50), PipeLine()
    exits = []
    for number, table in enumerate(book.tables):
        found = closed_loop_with_process(plant, table, number, controller, passes, line)
        assert found.differing == 0
        assert found.process.switchings.sum() > 50  # it did decide something
        exits.append(found.process.exit_speed_m_s)
    # The same lines, asked with the estimated speed, are another controller.
    assert np.count_nonzero(exits[0] != exits[2]) > 10
    # The wrong table in the process is seen at once, and so is one that does not estimate.
    assert closed_loop_with_process(plant, first, 1, controller, passes, line).differing > 40
    assert closed_loop_with_process(plant, observing, 0, controller, passes, line).differing > 10


@pytest.mark.requirement("CODE-11")
@pytest.mark.long
def test_a_process_decides_at_any_time_as_the_rule_in_the_simulator(tmp_path: Path, tool: Tool) -> None:
    tool("gcc")
    first = make_case().table
    plant = make_plant(36.0, len(first.stages))
    timed = replace(first, id="timed", decisions=Decisions.AT_ANY_TIME)
    sloped = replace(with_slopes(first, -0.003, -0.003), id="sloped", target_speed_m_s=2.0)
    observing = replace(sloped, id="observing", target_speed_m_s=4.0, estimator=estimator_of(plant))
    book = TableBook((first, timed, sloped, observing))
    controller = build_controller(book, tmp_path)
    passes, line = random_passes(3, 0, 50), PipeLine()
    exits = []
    for number, table in enumerate(book.tables):
        found = closed_loop_with_process(plant, table, number, controller, passes, line)
        assert found.differing == 0
        assert found.process.switchings.sum() > 50
        exits.append(found.process.exit_speed_m_s)
    for one, other in pairwise(exits):
        assert np.count_nonzero(one != other) > 10
    # Without the slopes, and so without the pressure, the process answers otherwise.
    assert closed_loop_with_process(plant, sloped, 1, controller, passes, line).differing > 10
