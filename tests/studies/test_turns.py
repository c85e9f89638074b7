"""Times taken in turns: their order, their rounds, and ratios of one moment."""

from __future__ import annotations

import time

from scripts.studies.timing.turns import Ratio, Times, in_turns, speed_against, timed


def test_calls_take_turns_after_one_round_that_counts_for_nothing() -> None:
    order: list[str] = []
    times = in_turns({"a": lambda: order.append("a"), "b": lambda: order.append("b")}, 3, {"b": 1})
    assert order == ["a", "b", "a", "b", "a", "a"]
    assert len(times["a"].wall_s) == len(times["a"].processor_s) == 3
    assert len(times["b"].wall_s) == 1


def test_a_call_that_waits_takes_wall_time_and_no_processor_time() -> None:
    wall, processor = timed(lambda: time.sleep(0.05))
    assert wall >= 0.05
    assert processor < 0.5 * wall


def test_ratios_are_of_one_round() -> None:
    """The machine is four times as slow in the second round; the ratio does not see it."""
    base, other = Times((2.0, 8.0, 3.0), (0.0,) * 3), Times((1.0, 4.0), (0.0,) * 2)
    assert speed_against(base, other) == Ratio(2.0, 2.0, 2.0, 2)
    assert Ratio(17.46, 15.8, 123.4, 15).cell == "17.5 (15.8 to 123, n = 15)"
