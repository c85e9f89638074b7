"""Word lengths by counting, memory by adding up, inputs and outputs by going through a hump by hand."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

import synth
from plant_models.hump import HumpGraph, Signal
from scripts.studies.control_computer.published_sizes import bits_of_source
from synth.computer.sizing.inputs_outputs import (
    ChannelRules,
    Channels,
    counted_channels,
    source_channels,
    total_channels,
)
from synth.computer.sizing.memory_need import (
    ControllerCounts,
    Memory,
    controller_memory,
)
from synth.computer.sizing.word_length import Quantity, common_word_bits


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
