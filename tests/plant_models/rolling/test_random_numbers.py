"""Random numbers are uniform, and those of one cut are the same whatever else is drawn."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from plant_models.rolling.random_numbers import BLOCK, Purpose, uniform_numbers

WHOLE = uniform_numbers(7, Purpose.CARS, 0, 3 * BLOCK, 6)


@given(first=st.integers(0, 2 * BLOCK), count=st.integers(0, BLOCK), columns=st.integers(0, 6))
def test_a_row_is_the_same_whatever_is_asked_for(first: int, count: int, columns: int) -> None:
    part = uniform_numbers(7, Purpose.CARS, first, count, columns)
    np.testing.assert_array_equal(part, WHOLE[first : first + count, :columns])


def test_purposes_and_seeds_have_numbers_of_their_own() -> None:
    drawn = [uniform_numbers(seed, purpose, 0, 2000, 1)[:, 0] for seed in (1, 2) for purpose in Purpose]
    between = np.corrcoef(drawn) - np.eye(len(drawn))
    assert np.abs(between).max() < 5.0 / np.sqrt(2000)


def test_purposes_keep_their_numbers() -> None:
    """A new number for an old purpose would move every study that names a seed."""
    assert {p.name: int(p) for p in Purpose}.items() >= {
        ("CARS", 1), ("WIND", 2), ("BENDS", 3), ("BUNCH_EXIT", 4), ("SPEED_NOISE", 5), ("EXIT_ERROR", 6)
    }  # fmt: skip
    assert len({int(p) for p in Purpose}) == len(Purpose)


def test_numbers_are_uniform_in_every_column_and_across_blocks() -> None:
    numbers = uniform_numbers(11, Purpose.WIND, 500, 20_000, 3)
    for column in numbers.T:
        assert stats.kstest(column, "uniform").pvalue > 0.001
    assert 0.0 < numbers.min() < numbers.max() < 1.0
    assert abs(np.corrcoef(numbers[:-BLOCK, 0], numbers[BLOCK:, 0])[0, 1]) < 5.0 / np.sqrt(20_000)


def test_neither_0_nor_1_can_come_out() -> None:
    """The generator gives multiples of 2⁻⁵³ below 1; both ends have finite quantiles after the shift."""
    ends = np.array([0.0, 1.0 - 2.0**-53]) * (1.0 - 2.0**-52) + 2.0**-53
    assert 0.0 < ends[0] < ends[1] < 1.0


@pytest.mark.parametrize(
    ("first", "count", "columns", "seed"), [(-1, 1, 1, 1), (0, -1, 1, 1), (0, 1, -1, 1), (0, 1, 1, -1)]
)
def test_negative_numbers_are_refused(first: int, count: int, columns: int, seed: int) -> None:
    with pytest.raises(ValueError, match="must not be negative"):
        uniform_numbers(seed, Purpose.CARS, first, count, columns)
