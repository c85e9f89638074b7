"""Common random numbers: pass i is the same whatever else is drawn, and the numbers follow their laws."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from synth.kernels.loop.normal_numbers import normal_pairs
from synth.simulation.random_passes import NOISE_SAMPLES, PATH_CELLS, RandomPasses, random_passes
from tests.effort import sized


@pytest.fixture(scope="module")
def row() -> RandomPasses:
    return random_passes(seed=7, first_pass=0, count=3000)


@settings(max_examples=sized(5, 15), deadline=None)
@given(first=st.integers(0, 2999), count=st.integers(0, 1500))
def test_pass_has_the_same_numbers_however_it_is_asked_for(row: RandomPasses, first: int, count: int) -> None:
    count = min(count, 3000 - first)
    drawn = random_passes(seed=7, first_pass=first, count=count)
    assert len(drawn) == count
    for name, array in vars(row.part(first, first + count)).items():
        assert getattr(drawn, name).tobytes() == array.tobytes()


def test_seeds_and_blocks_differ(row: RandomPasses) -> None:
    assert not np.any(row.cut_z == random_passes(8, 0, 3000).cut_z)
    assert np.unique(row.path_z[:, 0]).size > 2990


def test_shapes_laws_and_read_only(row: RandomPasses) -> None:
    assert row.path_z.shape == (3000, PATH_CELLS)
    assert row.noise_z.shape == (3000, NOISE_SAMPLES)
    for z in (row.cut_z, row.path_z, row.noise_z):
        allowed = 5.0 / np.sqrt(z.size)
        assert abs(z.mean()) < allowed
        assert abs(z.std() - 1.0) < allowed
    for u in (row.entry_u, row.phase_u, row.resistance_u):
        assert 0.0 <= u.min() < 0.01
        assert 0.99 < u.max() < 1.0
    with pytest.raises(ValueError, match="read-only"):
        row.cut_z[0] = 0.0


def test_arrays_are_independent_of_each_other(row: RandomPasses) -> None:
    columns: list[NDArray[np.floating]] = [
        row.cut_z,
        row.entry_u,
        row.phase_u,
        row.resistance_u,
        row.path_z[:, 0],
        row.noise_z[:, 0],
    ]
    correlation = np.corrcoef(columns)
    assert np.abs(correlation - np.eye(len(columns))).max() < 0.08


def test_negative_request_is_refused() -> None:
    with pytest.raises(ValueError, match="must not be negative"):
        random_passes(1, -1, 5)


def test_fewer_path_cells_are_the_first_of_all(row: RandomPasses) -> None:
    few = random_passes(seed=7, first_pass=900, count=300, path_cells=89)
    assert few.path_z.shape == (300, 89)
    for name, array in vars(row.part(900, 1200)).items():
        wanted = array[:, :89] if name == "path_z" else array
        assert np.array_equal(getattr(few, name), wanted)
    with pytest.raises(ValueError, match="1 to 512"):
        random_passes(7, 0, 5, PATH_CELLS + 1)


def test_words_become_numbers_by_the_formula_of_box_and_muller() -> None:
    words = np.random.default_rng(1).integers(0, 2**64, 200_001, dtype=np.uint64)
    words[:4] = (0, 2**64 - 1, 2**63, 2**31)  # the ends of both halves
    found = np.empty((2, words.size), dtype=np.float32)
    normal_pairs(words, found[0], found[1])
    uniform = ((words >> np.uint64(32)).astype(np.float64) + 0.5) / 2.0**32
    angle = (words & np.uint64(2**32 - 1)).astype(np.uint32).view(np.int32).astype(np.int64)
    within = (angle << 2).astype(np.uint32).view(np.int32) / 2.0**32  # of a quarter turn
    turn = 0.5 * np.pi * ((angle >> 30) + within)
    radius = np.sqrt(-2.0 * np.log(uniform))
    exact = radius * np.stack([np.cos(turn), np.sin(turn)])
    # Where u is within 2^-24 of 1, the radius is below 4e-4, and float32 has no more of it.
    assert np.abs(found - exact).max() < 4e-4
    assert np.abs(found - exact)[:, radius > 0.01].max() < 4e-6
    assert radius.max() > 6.7


def test_numbers_are_normal_and_independent() -> None:
    from scipy.stats import kstest, norm

    z = random_passes(3, 0, 6000).path_z.astype(np.float64)
    n = z.size
    for power, mean, variance in ((1, 0.0, 1.0), (2, 1.0, 2.0), (3, 0.0, 15.0), (4, 3.0, 96.0)):
        assert abs((z**power).mean() - mean) < 4.5 * np.sqrt(variance / n)
    assert kstest(z.ravel()[::7], "norm").pvalue > 1e-4
    for limit in (3.0, 4.0, 5.0):
        expected = 2.0 * n * norm.sf(limit)
        assert abs((np.abs(z) > limit).sum() - expected) < 4.5 * np.sqrt(expected) + 1.0
    # Two numbers of one word, of two words of a pass, and of the same word in the next pass.
    for one, other in ((z[:, ::2], z[:, 1::2]), (z[:, 1:-1:2], z[:, 2::2]), (z[:-1], z[1:])):
        assert abs((one * other).mean()) < 4.5 / np.sqrt(one.size)
        assert abs((one**2 * other**2).mean() - 1.0) < 4.5 * np.sqrt(8.0 / one.size)
