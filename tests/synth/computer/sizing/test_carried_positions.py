"""Which controller carries how many positions: against a schedule, the kept counts, and the search for the largest."""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace
from pathlib import Path

import pytest

from synth.computer.sizing.call_costs import c_costs, st_costs
from synth.computer.sizing.carried_positions import (
    MOST_POSITIONS,
    PositionTimes,
    carried,
    most_positions,
)
from synth.computer.sizing.trackside_controllers import (
    TracksideController,
    cortex_m4,
    industrial_pc,
    plc,
    usual_controllers,
)

DOCS = Path(__file__).parents[4] / "docs"


def test_the_counts_of_c_are_those_of_the_kept_study() -> None:
    found = json.loads((DOCS / "studies" / "controller-cost.json").read_text("utf-8"))["findings"]["dearest"]
    (small,) = [row["estimated"] for row in found if row["level"] == "-Os"]
    costs = c_costs()
    assert {"observe": costs.observe, "decide": costs.decide, "select": costs.select, "intact": costs.intact} == small


def test_the_counts_of_structured_text_are_those_of_its_page() -> None:
    page, costs = (DOCS / "reference" / "structured-text.md").read_text("utf-8"), st_costs()

    def stated(call: str) -> int:
        (row,) = re.findall(rf"^\| {re.escape(call)} *\| *([\d ]+)\|", page, re.MULTILINE)
        return int(row.replace(" ", ""))

    assert costs.decide == stated("`RETARDER_DECIDE`, at rest")
    assert costs.observe == stated("`RETARDER_OBSERVE`, 16 breaks")
    copy = stated("`RETARDER_LOAD`, book with estimators") - stated("`RETARDER_LOAD`, plain book")
    further = stated("`RETARDER_SELECT`, each further table")
    assert costs.select == stated("`RETARDER_SELECT`, between two tables") + 9 * further + copy
    questions = ("`AIM_SELECT`, 19 tables", "`AIM_LOAD`, 7 × 7 × 8 nodes", "`AIM_EXIT_SPEED`, 7 × 7 × 8 nodes")
    assert costs.aim == sum(stated(question) for question in questions)


def served_one_by_one(controller: TracksideController, positions: int) -> tuple[float, float]:
    """Longest answer and table where all come at once, just after the choice for one cut was begun, added up."""
    answer_s = controller.latency_s + controller.cut_s + positions * controller.sample_s
    table_s = controller.latency_s + positions * (controller.sample_s + controller.cut_s)
    return answer_s, table_s


@pytest.mark.parametrize("positions", [1, 8, 38, 50])
def test_without_a_scan_the_last_position_waits_for_all_others(positions: int) -> None:
    # as long as all is done before the next sample
    for controller in (cortex_m4(), industrial_pc()):
        found = carried(controller, PositionTimes(), positions)
        answer_s, table_s = served_one_by_one(controller, positions)
        assert table_s < 0.1
        assert found.answer_s == pytest.approx(answer_s, rel=1e-12)
        assert found.table_s == pytest.approx(table_s, rel=1e-12)


def test_a_new_sample_interrupts_the_choice_of_tables() -> None:
    controller = replace(cortex_m4(), latency_s=0.0)
    found = carried(controller, PositionTimes(), 80)
    work_s = 80 * controller.cut_s  # 0.15 s: two rounds of samples come before it is done
    assert found.table_s == pytest.approx(work_s + 2 * 80 * controller.sample_s, rel=1e-12)


@pytest.mark.parametrize("controller", usual_controllers(), ids=lambda each: each.name)
def test_the_largest_number_is_in_time_and_one_more_is_not(controller: TracksideController) -> None:
    times = PositionTimes()
    most = most_positions(controller, times)
    assert carried(controller, times, most).in_time
    assert not carried(controller, times, most + 1).in_time
    longest = [carried(controller, times, count).answer_s for count in (1, 2, most, most + 1)]
    assert longest == sorted(longest)


def test_the_largest_numbers_by_division() -> None:
    times = PositionTimes()
    for controller in usual_controllers():
        work_s = controller.sample_s + controller.cut_s
        if controller.scan is not None:
            spare_s = times.answer_s - controller.scan.longest_response_s(0.0)
        else:  # here the tables are late before the answers are
            spare_s = times.table_s - controller.latency_s
        assert most_positions(controller, times) == math.floor(spare_s / work_s)


def test_a_scan_that_is_full_never_answers() -> None:
    found = carried(plc(), PositionTimes(), 38)
    assert found.answer_s == math.inf
    assert found.used_share > 1.0
    assert not found.in_time
    slow = replace(plc(), clock_hz=1e4)
    assert most_positions(slow, PositionTimes()) == 0


def test_an_overloaded_processor_never_answers() -> None:
    found = carried(cortex_m4(), PositionTimes(), 20_000)
    assert found.answer_s == math.inf
    assert found.used_share > 1.0


def test_a_very_fast_controller_stops_the_search() -> None:
    fast = replace(industrial_pc(), clock_hz=1e15, latency_s=0.0)
    assert most_positions(fast, PositionTimes()) == MOST_POSITIONS
