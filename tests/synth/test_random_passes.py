"""Common random numbers: pass i is the same whatever else is drawn, and the numbers follow their laws."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from synth.random_passes import NOISE_SAMPLES, PATH_CELLS, RandomPasses, random_passes


@pytest.fixture(scope="module")
def row() -> RandomPasses:
    return random_passes(seed=7, first_pass=0, count=3000)


@settings(max_examples=15, deadline=None)
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
    columns = [row.cut_z, row.entry_u, row.phase_u, row.resistance_u, row.path_z[:, 0], row.noise_z[:, 0]]
    correlation = np.corrcoef(columns)
    assert np.abs(correlation - np.eye(len(columns))).max() < 0.08


def test_negative_request_is_refused() -> None:
    with pytest.raises(ValueError, match="must not be negative"):
        random_passes(1, -1, 5)
