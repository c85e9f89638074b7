"""Hump speeds, intervals, and what is known of cuts.

Hump speeds from headways: beside brute force over all sequences of steps, and by hand.
Rules for the interval, by hand on a few choices.
What is known of cuts before they roll: good and bad runners beside drawn ones.
"""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from numpy.typing import NDArray

from plant_models.rolling.resistance_law import HumpNormLaw, ResistanceLaw, Tb10062Law
from synth.hump.planning.forecast import Compared
from synth.hump.planning.speed_rules import (
    NEARLY_M_S,
    HumpSpeedLimits,
    SpeedMethod,
    centred,
    early,
    pair_by_pair,
    possible,
    whole_train,
)
from synth.hump.trial.trial import reduced_gravity_m_s2
from tests.synth.hump.trains.made_trials import Day

Floats = NDArray[np.float64]
STEPS = (1.0, 1.6, 2.4)
LIMITS = HumpSpeedLimits(STEPS, 0.03)
METHODS: tuple[SpeedMethod, ...] = (whole_train, pair_by_pair)


def times_s(apart_m: Floats, speeds_m_s: Floats) -> Floats:
    """When cuts (…, cuts) are at the crest."""
    took = apart_m[..., 1:] / (0.5 * (speeds_m_s[..., 1:] + speeds_m_s[..., :-1]))
    return np.concatenate((np.zeros((*took.shape[:-1], 1)), np.cumsum(took, axis=-1)), axis=-1)


def keeps(apart_m: Floats, headway_s: Floats, speeds_m_s: Floats) -> bool:
    """Whether one train keeps all headways and the limits of its locomotive."""
    time, change = times_s(apart_m, speeds_m_s), np.abs(np.diff(speeds_m_s**2))
    near = np.abs(np.diff(np.searchsorted(STEPS, speeds_m_s))) <= 1
    if not np.all(near | (change <= 2.0 * LIMITS.acceleration_m_s2 * apart_m[1:])):
        return False
    cuts, leaders = headway_s.shape
    return all(
        time[cut] - time[cut - leader] >= headway_s[cut, leader - 1] - 1e-9
        for cut in range(cuts)
        for leader in range(1, min(leaders, cut) + 1)
    )


def soonest_s(apart_m: Floats, headway_s: Floats) -> float:
    """Least time of the train over all sequences of steps that keep everything; infinite where none does."""
    all_ways = (np.array(way) for way in itertools.product(STEPS, repeat=len(apart_m)))
    good = [way for way in all_ways if keeps(apart_m, headway_s, way)]
    return min((float(times_s(apart_m, way)[-1]) for way in good), default=np.inf)


def random_needs(trains: int, cuts: int, leaders: int, seed: int) -> tuple[Floats, Floats]:
    """Distances, and headways that some pairs of steps keep."""
    random = np.random.default_rng(seed)
    apart = random.uniform(12.0, 40.0, (trains, cuts))
    headway = np.full((trains, cuts, leaders), -np.inf)
    for leader in range(1, leaders + 1):
        gone = np.stack([apart[:, cut - leader + 1 : cut + 1].sum(axis=1) for cut in range(leader, cuts)], axis=1)
        headway[:, leader:, leader - 1] = gone / random.uniform(1.05, 3.0, gone.shape)
    return apart, headway


def test_a_whole_train_is_as_soon_as_brute_force_finds() -> None:
    """Headways behind the next cut only: the speed alone is the state, so the programme is exact."""
    apart, headway = random_needs(60, 6, 1, 1)
    speeds = whole_train(apart, headway, LIMITS)
    found = [soonest_s(*train) for train in zip(apart, headway, strict=True)]
    assert np.isfinite(found).mean() > 0.9
    for train, best in enumerate(found):
        if np.isfinite(best):
            assert keeps(apart[train], headway[train], speeds[train])
            assert times_s(apart[train], speeds[train])[-1] == pytest.approx(best, abs=1e-9)


def test_behind_more_leaders_a_whole_train_is_near_the_soonest() -> None:
    """The speed alone is no longer enough of a state. Of hard random trains, all of which can keep their headways
    behind three leaders, 74 % do (n = 120), and these are 0.9 % later than the soonest, 12 % at the most."""
    apart, headway = random_needs(120, 6, 3, 2)
    speeds = whole_train(apart, headway, LIMITS)
    found = np.array([soonest_s(*train) for train in zip(apart, headway, strict=True)])
    kept = np.array([keeps(*train) for train in zip(apart, headway, speeds, strict=True)])
    late = times_s(apart, speeds)[:, -1] / found - 1.0
    assert np.isfinite(found).all()
    assert kept.mean() > 0.7
    assert late[kept].min() >= -1e-12
    assert late[kept].mean() < 0.01
    assert late[kept].max() < 0.13


@pytest.mark.parametrize("method", METHODS, ids=["whole train", "pairs"])
def test_trains_do_not_depend_on_each_other_and_keep_the_locomotive(method: SpeedMethod) -> None:
    apart, headway = random_needs(40, 9, 4, 3)
    together = method(apart, headway, LIMITS)
    for train in (0, 17, 39):
        np.testing.assert_array_equal(method(apart[train, None], headway[train, None], LIMITS)[0], together[train])
    change = np.abs(np.diff(together**2, axis=1))
    steps = np.abs(np.diff(np.searchsorted(STEPS, together), axis=1))
    assert np.all((steps <= 1) | (change <= 0.06 * apart[:, 1:] + 1e-12))


def test_a_pair_is_as_fast_as_its_headway_allows() -> None:
    """30 m apart, first cut at 2.4 m/s: 30/((2.4 + v)/2) is 12.5, 15 and 17.6 s for the three steps."""
    apart = np.full((4, 2), 30.0)
    headway = np.full((4, 2, 1), -np.inf)
    headway[:, 1, 0] = (12.0, 14.0, 17.0, 99.0)
    limits = HumpSpeedLimits(STEPS, 1.0)
    assert pair_by_pair(apart, headway, limits).tolist() == [[2.4, 2.4], [2.4, 1.6], [2.4, 1.0], [2.4, 1.0]]


def test_a_pair_slows_down_what_is_pushed_before_it() -> None:
    """From 2.4 to 1 m/s takes 2.38 m²/s² · 2 = 4.76 m²/s² = 2·a·s: 79 m at 0.03 m/s², so the step between is needed."""
    apart = np.full((1, 4), 30.0)
    headway = np.full((1, 4, 1), -np.inf)
    headway[0, 3, 0] = 25.0
    assert pair_by_pair(apart, headway, LIMITS).tolist() == [[2.4, 2.4, 1.6, 1.0]]
    far = np.array([[30.0, 30.0, 30.0, 80.0]])
    headway[0, 3, 0] = 60.0
    assert pair_by_pair(far, headway, LIMITS).tolist() == [[2.4, 2.4, 2.4, 1.0]]


def test_the_second_leader_counts() -> None:
    """Two gaps of 20 m at 2.4 m/s take 16.7 s; 20 s behind the cut before the last one needs a slower one."""
    apart, headway = np.full((1, 3), 20.0), np.full((1, 3, 2), -np.inf)
    headway[0, 2, 1] = 20.0
    assert pair_by_pair(apart, headway, HumpSpeedLimits(STEPS, 1.0)).tolist() == [[2.4, 2.4, 1.0]]
    speeds = whole_train(apart, headway, HumpSpeedLimits(STEPS, 1.0))
    assert times_s(apart, speeds)[0, -1] == pytest.approx(soonest_s(apart[0], headway[0]))


def test_what_cannot_be_kept_is_missed_by_as_little_as_can_be() -> None:
    apart, headway = np.full((1, 3), 20.0), np.full((1, 3, 1), -np.inf)
    headway[0, 1, 0] = 50.0
    assert whole_train(apart, headway, HumpSpeedLimits(STEPS, 1.0)).tolist() == [[1.0, 1.0, 2.4]]


def test_one_cut_and_one_step() -> None:
    limits = HumpSpeedLimits((1.7,))
    for method in METHODS:
        assert method(np.full((2, 1), 14.0), np.full((2, 1, 4), -np.inf), limits).tolist() == [[1.7], [1.7]]


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


@pytest.mark.parametrize("law", [HumpNormLaw(), Tb10062Law()], ids=["norm", "tb 10062"])
def test_good_and_bad_runners_are_those_quantiles_of_drawn_cuts(law: ResistanceLaw) -> None:
    """2.3 % of single cars are below and above; of longer cuts, whose law is not that of a car, 1 to 4 %."""
    trial = Day(cuts=40, most_cars=6, cars_mean=2.0, law=law).on()
    trains = trial.source.trains(0, 300)
    known = trial.known(trains, np.tile(trial.routes.length_m, (300, 1)))
    resistance = trains.drawn.resistance_n_per_kn
    for cars in (1, 2, 4):
        own = trains.cars == cars
        below, above = (resistance < known.good_n_per_kn)[own].mean(), (resistance > known.bad_n_per_kn)[own].mean()
        chance = 4.0 * np.sqrt(0.023 / own.sum())
        if cars == 1:
            assert below == pytest.approx(0.023, abs=chance)
            assert above == pytest.approx(0.023, abs=chance)
        else:
            assert 0.0 <= below < 0.04 + chance
            assert 0.01 - chance < above < 0.04 + chance
    assert (known.good_n_per_kn < known.mean_n_per_kn).all()
    assert (known.mean_n_per_kn < known.bad_n_per_kn).all()


def test_rows_of_a_cut_are_those_of_its_train() -> None:
    trial = Day(cuts=7).on()
    trains = trial.source.trains(3, 5)
    known = trial.known(trains, np.tile(trial.routes.length_m, (5, 1)))
    rows = known.of_cut(2)
    assert rows.tolist() == [2, 9, 16, 23, 30]
    expected = known.expected(rows, known.route[rows], known.mean_n_per_kn[rows])
    np.testing.assert_array_equal(expected.first_axle_m, trains.first_axle_m[rows])
    np.testing.assert_array_equal(expected.cars.routes, trains.route[rows])
    gravity = reduced_gravity_m_s2(trains)
    np.testing.assert_allclose(known.braked_m2_s2, 2.0 * gravity[:, None] * 0.8 * np.array([2.4, 2.4, 1.5]))
    aim = known.aim_of(rows)
    np.testing.assert_allclose(aim.speed_m_s, 1.4, rtol=1e-6)
    np.testing.assert_allclose(np.asarray(aim.most_entry_m_s) ** 2, aim.speed_m_s**2 + known.braked_m2_s2[rows, -1])
