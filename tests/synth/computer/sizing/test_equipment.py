"""Controllers, words, memory and channels.

Which controller carries how many positions: against a schedule, the kept counts, and the search for the largest.
Word lengths by counting, memory by adding up, inputs and outputs by going through a hump by hand.
"""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

import synth
from plant_models.hump import HumpGraph, Signal
from scripts.studies.control_computer.published_sizes import bits_of_source
from synth.computer.sizing.carried_positions import MOST_POSITIONS, PositionTimes, carried, most_positions
from synth.computer.sizing.counted_needs import (
    ChannelRules,
    Channels,
    ControllerCounts,
    Memory,
    Quantity,
    common_word_bits,
    controller_memory,
    counted_channels,
    source_channels,
    total_channels,
)
from synth.computer.sizing.trackside_controllers import (
    TracksideController,
    c_costs,
    cortex_m4,
    industrial_pc,
    plc,
    st_costs,
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


@example(3, 1, 1.0)
@example(0, 64, 0.1)
@example(0, 255, 0.25)
@given(st.integers(0, 5000), st.integers(1, 400), st.sampled_from([0.01, 0.1, 0.25, 1.0, 2.0, 30.0]))
def test_the_digits_tell_all_steps_apart_and_no_digit_is_too_many(least: int, steps: int, step: float) -> None:
    quantity = Quantity("x", least * step, (least + steps) * step, step)
    values = steps + 1
    assert 2**quantity.bits >= values
    assert quantity.bits == 1 or 2 ** (quantity.bits - 1) < values
    assert bits_of_source(quantity) >= quantity.bits
    if step >= 1.0:
        assert bits_of_source(quantity) == quantity.bits


def test_the_published_form_depends_on_the_unit() -> None:
    metres, centimetres = Quantity("s", 0.0, 1.0, 0.01), Quantity("s", 0.0, 100.0, 1.0)
    assert metres.bits == centimetres.bits == 7
    assert bits_of_source(metres) == 8
    assert bits_of_source(centimetres) == 7


def test_words_hold_the_widest() -> None:
    assert common_word_bits((Quantity("a", 0, 1, 1), Quantity("b", 0, 255, 1), Quantity("c", 0, 3, 1))) == 8


def test_the_memory_of_our_controller_is_the_sum_of_its_parts() -> None:
    counts = ControllerCounts(
        positions=38, tables_a_book=15, books=2, aim_tables=6, switches=31, tracks=32, cuts=60, code_bytes=2652,
        table_bytes=448, aim_table_bytes=1024,
    )  # fmt: skip
    memory = controller_memory(counts)
    fixed = 2652 + 2 * 15 * 448 + 6 * 1024 + 31 * 32 * 2 / 8
    working = 38 * 448 + 38 * 64 + 60 * 53 / 8 + 60
    assert memory.kibibytes(Memory.FIXED) == pytest.approx(fixed / 1024)
    assert memory.kibibytes(Memory.WORKING) == pytest.approx(working / 1024)


@pytest.fixture(scope="module")
def dumper() -> HumpGraph:
    return synth.load_hump("dumper").graph


def test_the_channels_of_a_hump_counted_by_hand(dumper: HumpGraph) -> None:
    # 7 switches, 8 tracks with a retarder of 3 zones each and two radars, one crest signal, 8 last sections
    counted = {row.kind: row.count for row in counted_channels(dumper, ChannelRules())}
    assert counted == {
        "switch": 7,
        "section": 7 + 8 + 8,
        "zone": 24,
        "retarder": 8,
        "radar": 16,
        "point_sensor": 0,
        "axle_counter": 7 * 3 + 8 * 2 + 8,
        "crest_signal": 1,
        "signal": 0,
    }
    total = total_channels(counted_channels(dumper, ChannelRules()))
    assert total.digital_in == 3 * 7 + 23 + 8 + 2 * 45 + 1
    assert total.analog_in == 24 + 16
    assert total.digital_out == 2 * 7 + 5 * 24 + 4
    assert total.analog_out == 0


@pytest.mark.parametrize("name", ["dumper", "medium", "large", "large-two-leads"])
def test_channels_add_up_and_follow_the_rules(name: str) -> None:
    hump = synth.load_hump(name).graph
    nothing = ChannelRules(**{kind: Channels() for kind, _ in ChannelRules().sources})  # type: ignore[arg-type]
    assert total_channels(counted_channels(hump, nothing)) == Channels()
    one = replace(nothing, zone=Channels(analog_out=1))
    zones = sum(len(retarder.zones_m) for retarder in hump.retarders)
    assert total_channels(counted_channels(hump, one)) == Channels(analog_out=zones)


def test_without_axle_counters_there_are_no_channels_for_them(dumper: HumpGraph) -> None:
    bare = HumpGraph(
        tuple(v if isinstance(v, Signal) else replace(v, axle_counters=False) for v in dumper.vertices),
        dumper.leads,
    )
    assert {row.kind: row.count for row in counted_channels(bare, ChannelRules())}["axle_counter"] == 0


def test_every_rule_has_its_source() -> None:
    rules = ChannelRules()
    kinds = {row.kind for row in counted_channels(synth.load_hump("medium").graph, rules)}
    assert kinds == {kind for kind, _ in rules.sources}
    assert all(len(words) > 5 for _, words in rules.sources)


def test_the_published_hump_is_between_the_small_and_the_large_one() -> None:
    source = source_channels()
    small, medium = (total_channels(counted_channels(synth.load_hump(n).graph, ChannelRules())) for n in
                     ("dumper", "medium"))  # fmt: skip
    assert small.digital_in < source.digital_in < medium.digital_in
    assert math.isclose(source.digital_in, 150)
