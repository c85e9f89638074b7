"""Numbers by key: the same for a cut wherever it is asked for, and as random as others."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from plant_models.rolling.keyed_numbers import GOLDEN, keyed_uniform, keyed_words, mixed
from plant_models.rolling.random_numbers import Purpose


def test_the_sequence_is_splitmix64() -> None:
    """The first numbers for the seed 1234567, as the authors' reference code prints them."""
    words = mixed(np.uint64(1234567) + GOLDEN * np.arange(1, 4, dtype=np.uint64))
    assert words.tolist() == [6457827717110365317, 3203168211198807973, 9817491932198370423]


def test_a_cut_has_its_numbers_whoever_is_beside_it() -> None:
    train, cut = (np.ravel(a) for a in np.meshgrid(np.arange(30), np.arange(40)))
    whole = keyed_words(7, Purpose.PASS_NOISE, (train, cut), 12)
    order = np.random.default_rng(0).permutation(len(train))[:100]
    assert (keyed_words(7, Purpose.PASS_NOISE, (train[order], cut[order]), 5) == whole[:5, order]).all()


def test_no_two_keys_share_numbers() -> None:
    train, cut = (np.ravel(a) for a in np.meshgrid(np.arange(300), np.arange(40)))
    words = np.concatenate(
        [
            keyed_words(seed, purpose, keys, 3)
            for seed in (7, 8)
            for purpose in (Purpose.PASS_NOISE, Purpose.CUT_FRICTION)
            for keys in ((train, cut), (train, cut, np.zeros_like(cut)), (train, cut, np.ones_like(cut)))
        ]
    )
    assert len(np.unique(words)) == words.size


def test_numbers_are_uniform_and_neighbours_do_not_correlate() -> None:
    """n = 120 000; limits are crossed by chance once in ten thousand seeds."""
    train, cut = (np.ravel(a) for a in np.meshgrid(np.arange(3000), np.arange(40), indexing="ij"))
    u = keyed_uniform(1, Purpose.POSITION_ERROR, (train, cut), 2)
    assert u.min() > 0.0
    assert u.max() < 1.0
    assert stats.kstest(u[0], "uniform").pvalue > 1e-4
    for one, other in ((u[0, :-1], u[0, 1:]), (u[0, :-40], u[0, 40:]), (u[0], u[1])):
        assert abs(np.corrcoef(one, other)[0, 1]) * np.sqrt(len(one)) < 3.9


def test_negative_numbers_are_refused() -> None:
    for seed, key in ((-1, 0), (1, -1)):
        with pytest.raises(ValueError, match="must not be negative"):
            keyed_words(seed, Purpose.PASS_NOISE, (np.array([key]),), 1)
