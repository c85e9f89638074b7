"""Holm's rule against the closed test that it is a short way for: all sets of hypotheses, each by Bonferroni."""

from __future__ import annotations

from itertools import combinations

import numpy as np
import pytest

from synth.logs.holm import rejected


def by_closure(p_values: list[float], level: float) -> set[int]:
    """A hypothesis falls where every set that it is in falls."""
    numbers = range(len(p_values))
    sets = [each for size in range(1, len(p_values) + 1) for each in combinations(numbers, size)]
    falls = {each: min(p_values[i] for i in each) <= level / len(each) for each in sets}
    return {i for i in numbers if all(falls[each] for each in sets if i in each)}


@pytest.mark.parametrize("count", [1, 2, 3, 6])
def test_it_is_the_closed_test_of_bonferroni(count: int) -> None:
    rng = np.random.default_rng(count)
    sizes = set()
    for _ in range(300):
        ps = (rng.random(count) ** 4).tolist()
        found = rejected(ps, 0.1)
        assert set(found) == by_closure(ps, 0.1)
        assert [ps[i] for i in found] == sorted(ps[i] for i in found)
        sizes.add(len(found))
    assert sizes == set(range(count + 1)), "some answers were never asked for"


def test_what_is_not_known_does_not_pass_and_counts() -> None:
    assert rejected([float("nan"), 0.01], 0.02) == (1,)
    assert rejected([float("nan"), 0.011], 0.02) == ()
    assert rejected([], 0.05) == ()
