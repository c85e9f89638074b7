"""The study of the control computer: failures on the hump, benefit of accuracy, and what it calls a fault."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from plant_models import PlantError
from plant_models.library.catalogue import load_car, load_position, load_weight_categories
from scripts.studies.control_computer.benefit import FIGURES, Benefit, Yard, regulator_benefit
from scripts.studies.control_computer.failed_hump import (
    ByHand,
    FailedPosition,
    StuckPosition,
    StuckReleased,
    WeakSupply,
    failed_trial,
)
from scripts.studies.control_computer.hump_runs import (
    ExtraFigure,
    difference_of_counts,
    failure_figures,
    other_track_with_frozen_points,
    paired_difference,
)
from scripts.studies.control_computer.published_speeds import published_speeds
from scripts.studies.control_computer.study import ControlComputer
from scripts.studies.documents import result_of
from synth.computer.economics.hump_day_change import change_of_trains
from synth.computer.economics.traffic import RATES, HumpRates, rates_after
from synth.frame.settings.settings_file import changed
from synth.hump.rolling.hump_position import LibraryBrake, NormalHumpPosition
from synth.hump.rolling.outcomes import TrainOutcomes
from synth.hump.trial.trial import HumpTrial
from tests.synth.computer.economics.made_cases import CHANGE, HANDLING, PRICES, TODAY, TRAFFIC, half95, made_outcomes
from tests.synth.hump.trains.made_trials import Day

TRAINS = 25
CATEGORIES, CAR = load_weight_categories(), load_car("gondola-4").car
BRAKES = tuple(
    LibraryBrake(load_position(name).position, CATEGORIES, CAR)
    for name in ("knp-5-bunch", "knp-5-bunch", "rnz-2m-park")
)


@cache
def sound_trial() -> HumpTrial:
    trial = Day().on("large")
    return replace(
        trial, positions=tuple(NormalHumpPosition(0.15, brake) for brake in BRAKES)
    )  # with the brakes that fail


@cache
def sound() -> TrainOutcomes:
    return sound_trial().batch(0, TRAINS)


@cache
def humped(*failed: FailedPosition) -> TrainOutcomes:
    return failed_trial(sound_trial(), BRAKES, failed).batch(0, TRAINS)


def told(found: TrainOutcomes) -> dict[str, ExtraFigure]:
    return {figure.name: figure for figure in failure_figures(sound(), found)}


def test_only_the_failed_positions_change() -> None:
    trial = sound_trial()
    failed = failed_trial(trial, BRAKES, [FailedPosition(3, StuckReleased()), FailedPosition(1, ByHand(0.4))])
    assert failed.positions[1] is trial.positions[1]
    assert failed.positions[0] == NormalHumpPosition(0.4, BRAKES[0])
    assert isinstance(failed.positions[2], StuckPosition)
    assert replace(failed, positions=trial.positions) == trial
    for number in (0, 4):
        with pytest.raises(PlantError, match=f"number is {number}; the hump has the positions 1 to 3"):
            failed_trial(trial, BRAKES, [FailedPosition(number, StuckReleased())])


def test_no_failure_adds_nothing() -> None:
    for figure in failure_figures(sound(), humped()):
        assert figure.sound == figure.failed
        value, low, high = figure.extra
        assert value == 0.0
        assert low <= 0.0 <= high
        assert (figure.trains, figure.cuts) == (TRAINS, 8 * TRAINS)


def test_a_last_position_that_is_stuck_released_makes_cuts_couple_fast() -> None:
    figures = told(humped(FailedPosition(3, StuckReleased())))
    for name in ("overspeed", "overspeed_above_2"):
        assert figures[name].extra[1] > 0.2, name
    assert figures["gap_per_cut"].extra[2] < 0.0


def test_a_refused_table_costs_less_than_a_stuck_brake_and_more_than_none() -> None:
    by_hand = told(humped(FailedPosition(3, ByHand(0.5))))["overspeed_above_2"]
    stuck = told(humped(FailedPosition(3, StuckReleased())))["overspeed_above_2"]
    assert 0.0 < by_hand.extra[0] < stuck.extra[0]


def test_a_weak_supply_lies_between_the_sound_brake_and_none() -> None:
    full, half, none = (humped(FailedPosition(2, WeakSupply(share, 0.15))) for share in (1.0, 0.4, 0.0))
    assert (full.overspeed == sound().overspeed).all()
    assert (none.overspeed == humped(FailedPosition(2, StuckReleased())).overspeed).all()
    above = [float(found.overspeed[:, 2].sum()) for found in (full, half, none)]
    assert above == sorted(above)
    assert above[0] < above[2]
    with pytest.raises(PlantError, match=r"weak supply: share is 1\.5"):
        WeakSupply(1.5, 0.15)


def test_extra_is_the_difference() -> None:
    """Also by an independent sum over all trains."""
    with_it = humped(FailedPosition(2, StuckReleased()))
    cuts = sound().cuts.sum()
    for figure in failure_figures(sound(), with_it):
        assert figure.extra[0] == pytest.approx(figure.failed[0] - figure.sound[0], abs=1e-12)
    above = with_it.overspeed[:, 2].sum() - sound().overspeed[:, 2].sum()
    assert told(with_it)["overspeed_above_2"].extra[0] == pytest.approx(above / cuts)
    caught = with_it.caught.sum() - sound().caught.sum()
    assert told(with_it)["catch_ups"].extra[0] == pytest.approx(caught / cuts)


def test_frozen_points_send_cuts_of_even_tracks_elsewhere() -> None:
    """All tracks as likely: 1 − 1/tracks of the cuts."""
    trial = sound_trial()
    tracks = len(trial.routes.routes)
    _, low, high = other_track_with_frozen_points(trial.source.trains(0, 400))
    assert low <= 1.0 - 1.0 / tracks <= high


@pytest.mark.parametrize(
    ("common", "more", "fewer"),
    [(0.05, 0.02, 0.01), (0.05, 0.0005, 0.0002), (0.0, 0.0, 0.001), (0.02, 0.0002, 0.0)],
    ids=["often", "rarely", "only better", "nearly never"],
)
def test_intervals_hold_the_difference_in_95_of_100_sets(common: float, more: float, fewer: float) -> None:
    """Events that both runs share, some of one run alone: 400 sets of 60 trains with 40 cuts."""
    rng, cuts, held = np.random.default_rng(1), np.full(60, 40.0), 0
    for _ in range(400):
        both = rng.binomial(40, common, 60)
        without, with_it = both + rng.binomial(40, fewer, 60), both + rng.binomial(40, more, 60)
        _, low, high = difference_of_counts(without.astype(float), with_it.astype(float), cuts)
        held += low <= more - fewer <= high
    assert held >= 0.92 * 400  # 95 % less 2.75 standard deviations of 400 sets


def test_pairing_tells_more_than_two_runs_alone() -> None:
    """Trains differ much, the failure adds one event to every third: the difference is known better than either."""
    rng, cuts = np.random.default_rng(2), np.full(200, 40.0)
    without = rng.integers(0, 20, 200).astype(float)
    extra = (np.arange(200) % 3 == 0).astype(float)
    _, low, high = paired_difference(without, without + extra, cuts)
    spread = 2.0 * 1.96 * without.std() * np.sqrt(2.0 / 200.0) / 40.0
    assert high - low < 0.2 * spread


def test_other_trains_cannot_be_compared() -> None:
    other = sound_trial().batch(1, TRAINS)
    with pytest.raises(PlantError, match="both runs must have the same trains"):
        failure_figures(sound(), other)


ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def kept() -> ControlComputer:
    found = result_of(ROOT, "control-computer").findings
    assert isinstance(found, ControlComputer)
    return found


def test_the_kept_study_has_no_fault_and_every_planted_one_is_told(kept: ControlComputer) -> None:
    assert kept.faults() == ()
    law = replace(kept.published.speeds.laws[0], long_share=0.01)
    row = replace(kept.controllers.rows[0], in_time=False)
    planted = replace(
        kept,
        published=replace(
            kept.published,
            speeds=replace(kept.published.speeds, laws=(law, *kept.published.speeds.laws[1:])),
        ),
        controllers=replace(kept.controllers, rows=(row, *kept.controllers.rows[1:])),
    )
    faults = planted.faults()
    assert len(faults) == 2
    assert faults[0].startswith("published claims")
    assert faults[1].startswith("PLC")


def test_the_rates_that_the_command_takes_are_there_and_changes_are_their_differences(kept: ControlComputer) -> None:
    variants, beside = kept.benefit.variants, kept.benefit.beside_today
    assert list(variants) == ["today", "asked", "new", "tables"]
    names = list(RATES)
    for name in ("today", "new"):
        HumpRates(**{field: variants[name].rates[field].value for field in names})
    for name in ("asked", "new"):
        assert variants[name].trains == variants["today"].trains
        for field in names:
            found = beside[name].change[field]
            difference = variants[name].rates[field].value - variants["today"].rates[field].value
            assert found.value == pytest.approx(difference, abs=1e-9), field
            assert found.low95 <= found.value <= found.high95


def test_constant_service_keeps_both_claims_and_the_fewest_stages_do() -> None:
    found = published_speeds()
    assert {law.law: law.kept for law in found.laws}["constant"] == (True, True)
    assert found.faults() == ()
    # an Erlang law of so many stages lies between constant and exponential service
    constant, exponential = found.laws[0].long_share, found.laws[2].long_share
    assert constant < 0.001 < exponential
    assert found.erlang_stages > 2


YARD = Yard(changed(TRAFFIC, cars_per_day=4000.0), HANDLING, PRICES)
BEFORE = changed(TODAY, catch_ups=0.03, misrouted=0.01)
AFTER = rates_after(BEFORE, CHANGE)


def pair(seed: int, trains: int) -> tuple[Benefit, ...]:
    """The benefit of two humps on the same drawn trains."""
    shared = np.random.default_rng(9000 + seed).gamma(100.0, 0.01, trains)
    today, new = made_outcomes(shared, BEFORE, seed), made_outcomes(shared, AFTER, 5000 + seed)
    return regulator_benefit(today, new, YARD, replicates=200, seed=seed)


def test_minutes_damages_and_locomotive_hours_follow_from_the_figures() -> None:
    shared = np.ones(200)
    today, new = made_outcomes(shared, BEFORE, 1), made_outcomes(shared, AFTER, 2)
    found = {each.name: each.less for each in regulator_benefit(today, new, YARD, replicates=100)}
    rate = [3600.0 * each.span_cars.sum() / each.span_s.sum() for each in (today, new)]
    assert found["humping of a train"].value == pytest.approx(60.0 * 60.0 * (1.0 / rate[0] - 1.0 / rate[1]))
    cuts = 4000.0 / 1.8
    above = [each.overspeed[:, 2].sum() / each.cuts.sum() for each in (today, new)]
    assert found["couplings above 2 m/s"].value == pytest.approx(cuts * (above[0] - above[1]))
    gaps = [each.gap_m.sum() / each.cuts.sum() for each in (today, new)]
    assert found["locomotive, pushing up gaps"].value == pytest.approx(cuts * (gaps[0] - gaps[1]) * 1e-4)


def test_intervals_are_those_of_paired_differences() -> None:
    """Gaps on their tracks are nearly linear in the figures: bootstrap and linearised interval agree."""
    shared = np.random.default_rng(4).gamma(100.0, 0.01, 400)
    today, new = made_outcomes(shared, BEFORE, 1), made_outcomes(shared, AFTER, 2)
    found = {each.name: each.less for each in regulator_benefit(today, new, YARD, replicates=1000)}
    linear = change_of_trains(today, new)["over_speeds_above_2"]
    on_track = 4000.0 / 1.8 * BEFORE.on_track
    assert half95(found["couplings above 2 m/s"]) == pytest.approx(on_track * half95(linear), rel=0.12)


def test_names_and_units() -> None:
    found = pair(1, 50)
    assert [each.name for each in found[-2:]] == ["running costs", "released capital"]
    assert found[-2].unit == "EUR a year"
    assert len(found) == len(FIGURES) + 2
    assert found == pair(1, 50), "the same seed, the same intervals"


def test_faults() -> None:
    shared = np.ones(20)
    today, new = made_outcomes(shared, BEFORE, 1), made_outcomes(shared, AFTER, 2)
    with pytest.raises(PlantError, match="replicates is 10"):
        regulator_benefit(today, new, YARD, replicates=10)
    full = replace(YARD, traffic=changed(TRAFFIC, cars_per_day=6000.0))
    with pytest.raises(PlantError, match="overloaded"):
        regulator_benefit(today, new, full)
    nearly = replace(YARD, traffic=changed(TRAFFIC, cars_per_day=24.0 / 0.2825 * 60.0 * 0.9995))
    with pytest.raises(PlantError, match="in a bootstrap sample of the trains the hump is overloaded"):
        regulator_benefit(made_outcomes(shared, TODAY, 3), new, nearly)
