"""Tornado: bars of functions that can be followed by hand."""

from __future__ import annotations

import math
from collections.abc import Mapping

import pytest

from plant_models.errors import require
from synth.computer.economics.uncertainty.ranges import Constant, LogNormal, Range, Uniform
from synth.computer.economics.uncertainty.tornado import tornado

RANGES: dict[str, Range] = {
    "a": Uniform(0.0, 10.0),
    "b": Uniform(0.0, 1.0),
    "c": LogNormal(1.0, 100.0),
    "known": Constant(5.0),
}


def test_each_input_alone() -> None:
    found = tornado(lambda at: {"y": at["a"] - 20.0 * at["b"] + at["c"] + at["known"]}, RANGES, "y")
    assert found.at_medians == pytest.approx(5.0 - 10.0 + 10.0 + 5.0)
    assert [bar.input for bar in found.bars] == ["c", "b", "a"]
    c, b, a = found.bars
    assert (c.low_input, c.high_input) == pytest.approx((1.0, 100.0))
    assert (c.at_low, c.at_high) == pytest.approx((1.0, 100.0))
    assert (b.at_low, b.at_high, b.swing) == pytest.approx((19.0, 1.0, 18.0))
    assert (a.low_input, a.at_low, a.at_high) == pytest.approx((0.5, 5.5, 14.5))


def test_ends_that_are_impossible_or_never() -> None:
    def odd(at: Mapping[str, float]) -> dict[str, float]:
        require(at["b"] < 0.9, "b is too much")
        return {"y": math.inf if at["a"] < 1.0 else at["a"] + 0.0 * at["c"]}

    found = tornado(odd, RANGES, "y")
    assert [bar.input for bar in found.bars] == ["b", "a", "c"]
    b, a, c = found.bars
    assert math.isnan(b.at_high)
    assert math.isnan(b.swing)
    assert a.swing == math.inf
    assert c.swing == 0.0


def test_never_at_both_ends() -> None:
    found = tornado(lambda at: {"y": math.inf}, RANGES, "y")
    assert [bar.swing for bar in found.bars] == [0.0, 0.0, 0.0]
    assert [bar.input for bar in found.bars] == ["a", "b", "c"]
