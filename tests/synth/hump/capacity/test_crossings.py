"""Where a curve crosses a share, and what its bootstrap decides, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest

from synth.hump.capacity.crossings import REPLICATES, Sums, decided, drawn_weights, enough_for


def test_a_curve_crosses_a_limit_where_the_line_between_two_programs_does() -> None:
    share = np.array([[0.0, 0.002, 0.006], [0.002, 0.003, 0.004], [0.0, 0.0, 0.0005]])
    speed = np.array([[2.0, 2.2, 2.6]] * 3)
    crossed, cars = Sums(share, speed, 300.0 * speed).crossing(0.001)
    assert crossed.tolist() == pytest.approx([2.1, -np.inf, np.inf])
    assert cars.tolist() == pytest.approx([630.0, -np.inf, np.inf])
    assert Sums(share, speed, speed).crossing(0.004)[0][0] == pytest.approx(2.4)


def test_a_curve_is_read_at_a_speed_between_its_programs_and_nowhere_else() -> None:
    sums = Sums(np.array([[0.0, 0.1, 0.4]]), np.array([[2.0, 2.5, 3.0]]), np.zeros((1, 3)))
    assert sums.at_speed(2.25).tolist() == pytest.approx([0.05])
    assert sums.at_speed(3.0).tolist() == pytest.approx([0.4])
    assert np.isnan(sums.at_speed(1.9)).all()
    assert np.isnan(sums.at_speed(3.1)).all()


def test_bootstrap_intervals_are_those_of_a_mean_of_independent_trains() -> None:
    caught = np.random.default_rng(1).poisson(0.5, 400).astype(float)
    found = decided(drawn_weights(400, 2) @ caught / 400, 400)
    assert found is not None
    half = 1.96 * caught.std(ddof=1) / np.sqrt(400)
    assert found.value == pytest.approx(caught.mean())
    assert found.n == 400
    assert (found.low95, found.high95) == pytest.approx((caught.mean() - half, caught.mean() + half), abs=0.15 * half)
    assert decided(np.concatenate(([1.0], np.full(REPLICATES, np.inf))), 9) is None
    assert decided(np.concatenate(([np.nan], np.ones(REPLICATES))), 9) is None


def test_intervals_at_a_limit_hold_the_truth() -> None:
    """Trains whose catch-ups are Poisson numbers about a straight curve, common to all points of it as trains are.

    The truth is where the mean curve crosses 1 %: at 620 cars an hour. 95 of 100 are wanted; of 300 samples 91 to 98
    of 100 are within three standard deviations of that.
    """
    cars, mean = np.array([580.0, 620.0, 660.0]), np.array([0.002, 0.01, 0.018])
    held, samples, trains, cuts = 0, 300, 60, 40
    rng = np.random.default_rng(11)
    for sample in range(samples):
        worse = rng.gamma(8.0, 1.0 / 8.0, (trains, 1))  # some trains are worse than others at every point
        share = rng.poisson(cuts * mean * worse) / cuts
        weights = drawn_weights(trains, sample)
        caught = weights @ share / trains
        found = decided(Sums(caught, caught, np.tile(cars, (len(caught), 1))).crossing(0.01)[1], trains)
        held += found is None or found.low95 <= 620.0 <= found.high95
    assert 0.91 * samples <= held <= 0.985 * samples


def test_a_share_needs_enough_cuts() -> None:
    assert enough_for(0.002, 5000)
    assert not enough_for(0.002, 4999)
