"""The compiled controller in closed loop with the simulator: the same passes, bit by bit."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from scripts.studies.in_the_loop.controller_process import build_controller
from scripts.studies.in_the_loop.software_in_the_loop import PipeLine, closed_loop_with_process
from synth.retarder.estimation.estimator_design import estimator_of
from synth.simulation.random_passes import random_passes
from tests.controller_code.conftest import Tool
from tests.controller_code.sample_book import with_slopes
from tests.synth.case_factory import make_case, make_plant
from tuning_tables import Decisions
from tuning_tables.table_book import TableBook


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
