"""Rules for the interval, by hand on a few choices."""

from __future__ import annotations

import numpy as np
import pytest

from synth.hump.trains.forecast import Compared
from synth.hump.trains.interval import NEARLY_M_S, centred, early, possible

INF = np.inf


def compared(**changes: list[float] | list[bool]) -> Compared:
    """One cut with four choices."""
    values = {
        "ahead_s": [0.1, 1.0, 2.0, 3.0],
        "behind_s": [4.0, 2.5, 1.9, 0.5],
        "able": [True] * 4,
        "beyond_m_s": [0.0] * 4,
        "arrival_s": [90.0, 91.0, 92.0, 93.0],
        "speeds_m_s": [12.0, 11.0, 10.0, 9.0],
    } | changes
    return Compared(**{name: np.array([value]) for name, value in values.items()})


@pytest.mark.parametrize(
    ("changes", "place"),
    [
        ({}, 2),
        ({"able": [True, True, False, True]}, 1),
        ({"arrival_s": [90.0, INF, INF, 93.0]}, 3),
        ({"ahead_s": [INF] * 4}, 0),
        ({"ahead_s": [INF] * 4, "behind_s": [INF] * 4}, 3),
        ({"ahead_s": [-INF] * 4, "able": [False, True, False, False]}, 1),
        ({"ahead_s": [-INF] * 4}, 3),
        ({"beyond_m_s": [0.0, 0.0, 0.05, 0.0]}, 1),
        ({"beyond_m_s": [0.5, 0.45, 0.41, 0.9]}, 2),
        ({"able": [False] * 4}, 2),
    ],
)
def test_a_centred_cut_is_in_the_middle_of_what_it_can(changes: dict[str, list[float]], place: int) -> None:
    """min(ahead, behind) is 0.1, 1, 1.9, 0.5; more than 5 s is not asked for, and the slowest then; among choices of
    which no one can be kept apart, one that the cut can have."""
    assert centred(compared(**changes)).tolist() == [place]


@pytest.mark.parametrize(
    ("changes", "place"),
    [
        ({}, 1),
        ({"ahead_s": [0.1, 0.2, 0.7, 0.3]}, 2),
        ({"ahead_s": [0.1, 0.2, 0.4, 0.3]}, 2),
        ({"ahead_s": [-INF] * 4, "able": [False, False, True, True]}, 2),
        ({"ahead_s": [0.9, 1.0, 2.0, 3.0], "able": [False, False, True, True]}, 2),
        ({"ahead_s": [INF] * 4}, 0),
    ],
)
def test_an_early_cut_is_as_early_as_its_margin_allows(changes: dict[str, list[float]], place: int) -> None:
    assert early(compared(**changes), 0.5).tolist() == [place]


def test_limits_of_entry_are_kept_or_missed_by_as_little_as_can_be() -> None:
    within = compared(beyond_m_s=[0.0, 0.05, 0.0, 1.0])
    assert possible(within).tolist() == [[True, False, True, False]]
    beyond = compared(beyond_m_s=[0.3, 0.3 + 0.9 * NEARLY_M_S, 0.3 + 1.1 * NEARLY_M_S, 1.0])
    assert possible(beyond).tolist() == [[True, True, False, False]]
