"""Aims that are tried: shares are kept, roots are found, intervals are those of Student, faults do what they say."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy import stats

from scripts.studies.aimed_braking.measuring import ByReadingAndWind, WindByAnemometer
from scripts.studies.aimed_braking.sensitivity import EXIT_STD_M_S, farther
from scripts.studies.aiming.cuts import (
    POINTS,
    AimedCuts,
    FreeDistance,
    FromCrest,
    large_hump,
    rolled_cuts,
    weight_category,
)
from scripts.studies.aiming.refinements import ByRegression, NearestRecord
from scripts.studies.aiming.trial import (
    BEYOND,
    BOUNDS_M_S,
    NEAR,
    Cuts,
    Draws,
    levelled,
    norm_distance,
    outcomes,
    root,
    tried,
    value_of,
)
from scripts.studies.yard_chain.chain import (
    CATEGORY,
    ESTIMATED,
    MEASURED,
    TODAY_EXIT,
    BookSize,
    Kind,
    Samples,
    chain_samples,
    practice,
    saved,
)
from scripts.studies.yard_chain.details import HandBraked, WithMissing
from synth.aim.knowledge import ByCategory, ByReading, Knowledge, Requirement, ResistanceByTwoSpeeds
from synth.aim.position_models import NormalPosition, PositionModel
from synth.aim.scene import SceneCuts

P = 0.1
TWO = ResistanceByTwoSpeeds(0.03)


@pytest.fixture(scope="module")
def drawn() -> SceneCuts:
    scene = large_hump()
    return scene.draw(weight_category(scene, "L"), 1, 3, 0, 2000)


@pytest.fixture(scope="module")
def design(drawn: SceneCuts) -> AimedCuts:
    return rolled_cuts(drawn, FreeDistance((200.0,))).at(NormalPosition(0.1, only_brakes=False))


KNOWN = (ByCategory(), ByRegression(TWO), ByReading(TWO), NearestRecord(POINTS, 200), WithMissing(ByReading(TWO), 0.3))


@pytest.mark.parametrize("knowledge", KNOWN, ids=lambda known: type(known).__name__)
def test_every_kind_of_knowledge_keeps_the_same_share(design: AimedCuts, knowledge: Knowledge) -> None:
    commands = levelled(knowledge, design, 0, P)
    assert commands is not None
    commanded = commands.of(design.cuts)
    recorded = knowledge.records if isinstance(knowledge, NearestRecord) else 0  # a record finds itself
    told = design.couplings(commanded.speed_m_s, 0).speed_m_s[recorded:] > design.cuts.scene.coupling_speed_m_s
    assert P - 5 * NEAR <= told.mean() <= P + 2 * NEAR
    assert commanded.speed_m_s.min() >= BOUNDS_M_S[0]


def test_where_every_command_is_too_fast_there_are_none(design: AimedCuts) -> None:
    hopeless = np.where(np.arange(2000) % 5 == 0, -np.inf, design.thresholds_m_s[:, 0])
    assert levelled(ByCategory(), replace(design, thresholds_m_s=hopeless[:, None]), 0, P) is None
    some = np.where(np.arange(2000) % 20 == 0, -np.inf, design.thresholds_m_s[:, 0])
    commands = levelled(ByReading(TWO), replace(design, thresholds_m_s=some[:, None]), 0, P)
    assert commands is not None
    over = commands.of(design.cuts).speed_m_s > some
    assert P - 10 * NEAR <= over.mean() <= P  # with few cuts the share jumps where a node begins to be served


def test_a_free_distance_is_counted_from_the_release(drawn: SceneCuts) -> None:
    assert FreeDistance((50.0,)).arrivals_m(drawn) == pytest.approx(drawn.release_m[:, None] + 50.0)
    near, far = FromCrest((340.0, 500.0)).arrivals_m(drawn).T
    assert near == pytest.approx(drawn.release_m)
    assert (far == 500.0).all()


def test_a_root_is_found_or_told_to_lie_outside() -> None:
    assert root(lambda x: (x - 412.3) ** 3, 337.0, 900.0) == pytest.approx(412.3, abs=BEYOND)
    assert root(lambda x: 1e3 if x > 600.0 else x - 555.0, 337.0, 900.0) == pytest.approx(555.0, abs=BEYOND)
    assert root(lambda x: x - 1000.0, 337.0, 900.0) == float("inf")
    assert root(lambda x: x, 337.0, 900.0) == 337.0


def test_a_position_farther_on_meets_the_norm_as_much_farther() -> None:
    """Nothing behind it is known of the way before it, so all shifts along with it."""
    scene, draws = large_hump(), Draws(2, 1000, 1000, 1)
    position = NormalPosition(EXIT_STD_M_S, only_brakes=False)
    here, there = (
        norm_distance(Cuts(s, weight_category(s, "L")), position, ByCategory(), P, draws, 600.0)
        for s in (scene, farther(20.0)(scene))
    )
    assert there - here == pytest.approx([20.0, 20.0], abs=2.0 * BEYOND)
    assert 390.0 < here.mean() < 440.0


def test_an_interval_is_that_of_student() -> None:
    values = np.array([1.0, 2.0, 4.0, 7.0])
    low, high = stats.t.interval(0.95, 3, loc=values.mean(), scale=stats.sem(values))
    assert value_of(values).ci95 == pytest.approx((low, high))


def test_a_place_without_commands_has_no_outcome() -> None:
    samples = np.ones((3, 2, 6))
    samples[1, 0] = np.nan
    first, second = outcomes(samples)
    assert first is None
    assert second is not None
    assert second.gap_m.ci95 == (1.0, 1.0)


def test_measured_resistance_leaves_less_gap_at_the_same_share() -> None:
    scene = large_hump()
    cuts, draws = Cuts(scene, weight_category(scene, "L")), Draws(3, 1500, 1500, 2)
    place, position = FreeDistance((200.0,)), NormalPosition(0.1, only_brakes=False)
    (category,), (measured,) = (
        tried(cuts, place, position, known, P, draws) for known in (ByCategory(), ByRegression(TWO))
    )
    assert category is not None
    assert measured is not None
    assert measured.gap_m.value < 0.5 * category.gap_m.value
    assert category.overspeed.value == pytest.approx(P, abs=0.02)
    assert measured.overspeed.value == pytest.approx(P, abs=0.02)


def test_a_chain_holds_what_each_pair_gives_alone() -> None:
    hump, draws = large_hump(), Draws(2, 400, 300, 4)
    cuts = Kind("T", 2).cuts(hump)
    positions: dict[str, PositionModel] = {"a": NormalPosition(0.0), "b": NormalPosition(0.3)}
    knowledge: dict[str, Knowledge] = {"x": ByCategory(), "y": ByRegression(TWO)}
    figures = chain_samples(cuts, (60.0, 150.0), positions, knowledge, P, draws)
    assert figures.shape == (2, 2, 2, 2, 6)
    alone = tried(cuts, FreeDistance((60.0, 150.0)), positions["b"], knowledge["y"], P, draws)
    assert outcomes(figures[:, 1, 1]) == alone


def test_a_park_book_is_for_the_cuts_that_come() -> None:
    cuts = Kind("T", 3).cuts(large_hump())
    book = BookSize(2, 3).book(cuts)
    assert book.targets_m_s == (1.0, 1.2, 2.6)
    assert all(3 * 72.0 < mass < 3 * 94.0 for mass in book.masses_t)
    assert book.masses_t[0] < book.masses_t[1]
    low, high = book.entry_m_s
    assert 2.0 < low < high < 4.5
    config = book.config(estimator=True)
    assert config.regulator.estimator
    assert [plant.cut.axles for _, plant in config.plants()] == [12, 12]


def test_cuts_braked_by_hand_leave_with_their_own_error(drawn: SceneCuts) -> None:
    exits = HandBraked(NormalPosition(0.0, only_brakes=False), 0.25, 0.5).exits(drawn)
    error = exits.at(np.full(2000, 3.0)) - 3.0
    assert exits.by_hand.mean() == pytest.approx(0.25, abs=0.03)
    assert (error[~exits.by_hand] == 0.0).all()
    assert error[exits.by_hand].std() == pytest.approx(0.5, rel=0.1)
    critical = np.full(2000, 2.0)
    limit = exits.threshold(critical)
    assert (exits.at(limit + 1e-6) > critical).all()
    assert (exits.at(limit - 1e-6) < critical).all()


def test_a_missed_passage_falls_back_to_the_category(drawn: SceneCuts, design: AimedCuts) -> None:
    asked = Requirement(P, (0.4, 7.0))
    by_category = ByCategory().commands(drawn, design.thresholds_m_s, asked).of(drawn)
    known = ByReading(TWO).commands(drawn, design.thresholds_m_s, asked).of(drawn)
    both = WithMissing(ByReading(TWO), 0.3).commands(drawn, design.thresholds_m_s, asked).of(drawn)
    missed = both == by_category
    assert missed.mean() == pytest.approx(0.3, abs=0.04)
    assert np.array_equal(both[~missed], known[~missed], equal_nan=True)


def test_a_blind_anemometer_adds_nothing_and_a_good_one_tells_head_from_tail_wind(
    drawn: SceneCuts, design: AimedCuts
) -> None:
    asked = Requirement(P, (0.4, 7.0))
    blind = ByReadingAndWind(TWO, WindByAnemometer(1e4), 9, 5).commands(drawn, design.thresholds_m_s, asked)
    alone = ByReading(TWO).commands_at(blind.readings, drawn, design.thresholds_m_s, asked)
    for row in blind.speeds_m_s:
        assert row == pytest.approx(alone.speeds_m_s[:, 0], abs=2e-3, nan_ok=True)
    good = ByReadingAndWind(TWO, WindByAnemometer(0.5), 9, 5).commands(drawn, design.thresholds_m_s, asked)
    assert abs(good.speeds_m_s[-1, 4] - good.speeds_m_s[0, 4]) > 0.1


def test_a_practice_is_the_mean_over_cuts_and_places_and_savings_are_paired() -> None:
    rng = np.random.default_rng(5)
    figures = rng.random((4, 2, 2, 3, 6))
    samples = Samples((CATEGORY, MEASURED), (TODAY_EXIT, ESTIMATED), figures)
    found = practice("x", (samples.of(CATEGORY, TODAY_EXIT), samples.of(MEASURED, ESTIMATED)))
    assert found.gap_m is not None
    assert found.couplings[2] is not None
    assert found.gap_m.value == pytest.approx(0.5 * (figures[:, 0, 0, :, 0].mean() + figures[:, 1, 1, :, 0].mean()))
    assert found.couplings[2].value == pytest.approx(
        1e3 * 0.5 * (figures[:, 0, 0, :, 3].mean() + figures[:, 1, 1, :, 3].mean())
    )
    second = saved(Kind("L", 1), samples, (100.0, 200.0, 300.0))[1]
    step = figures[:, 0, 0, 1, 0] - figures[:, 1, 1, 1, 0]
    low, high = stats.t.interval(0.95, 3, loc=step.mean(), scale=stats.sem(step))
    assert second.both_m is not None
    assert second.both_m.ci95 == pytest.approx((low, high))
    missing = figures.copy()
    missing[2, 0, 0, 1, 0] = np.nan
    none = saved(Kind("L", 1), Samples(samples.knowledge, samples.positions, missing), (100.0, 200.0, 300.0))
    assert [row.both_m is None for row in none] == [False, True, False]
