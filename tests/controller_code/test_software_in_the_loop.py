"""The compiled controller in closed loop with the simulator: the same passes, bit by bit."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from synth.in_the_loop.controller_process import build_controller
from synth.in_the_loop.software_in_the_loop import PipeLine, closed_loop_with_process
from synth.random_passes import random_passes
from tests.controller_code.conftest import Tool
from tests.synth.case_factory import make_case, make_plant
from tuning_tables.table_book import TableBook


@pytest.mark.slow
def test_a_process_controls_as_the_rule_in_the_simulator(tmp_path: Path, tool: Tool) -> None:
    tool("gcc")
    first = make_case().table
    other = replace(make_case(target=4.0).table, id="other")
    book = TableBook((first, other))
    controller = build_controller(book, tmp_path)
    plant, passes, line = make_plant(36.0, len(first.stages)), random_passes(3, 0, 50), PipeLine()
    for number, table in enumerate(book.tables):
        found = closed_loop_with_process(plant, table, number, controller, passes, line)
        assert found.differing == 0
        assert found.process.switchings.sum() > 50  # it did decide something
    # The wrong table in the process is seen at once.
    assert closed_loop_with_process(plant, first, 1, controller, passes, line).differing > 40
