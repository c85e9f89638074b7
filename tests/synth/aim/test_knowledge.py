"""Commands keep the probability that was asked for, on other cuts than those that they were chosen on."""

from __future__ import annotations

import numpy as np
import pytest

from scripts.studies.aiming.readings import LightnessByWeigher, ResistanceByRadar
from scripts.studies.aiming.recorded_cuts import ControlPoints, NearestRecord, nearest
from scripts.studies.aiming.regression import ByRegression
from synth.aim.knowledge import ByCategory, ByReading, Knowledge, Requirement, not_falling
from synth.aim.outcome import couplings
from synth.aim.position_models import NormalPosition
from synth.aim.readings import ResistanceByTwoSpeeds
from synth.aim.scene import AimScene, SceneCuts
from synth.simulation.exit_statistics import clopper_pearson
from tests.synth.aim.conftest import LIGHT

DISTANCE_M = 80.0
REQUIREMENT = Requirement(0.1, (0.3, 7.0))
POSITION = NormalPosition(0.05, only_brakes=False)
POINTS = ControlPoints((200.0, 250.0, 305.0))
TWO_SPEEDS = ResistanceByTwoSpeeds(0.05)


def thresholds(cuts: SceneCuts) -> np.ndarray[tuple[int, ...], np.dtype[np.float64]]:
    critical = cuts.critical_speeds_m_s(cuts.release_m + DISTANCE_M)
    return POSITION.exits(cuts).threshold(critical)[:, None]


KNOWN: dict[str, Knowledge] = {
    "category": ByCategory(),
    "two speeds": ByReading(TWO_SPEEDS),
    "radar": ByReading(ResistanceByRadar(0.05, 50.0)),
    "weight": ByReading(LightnessByWeigher()),
    "regression": ByRegression(TWO_SPEEDS),
    "records": NearestRecord(POINTS, 300),
}


@pytest.fixture(scope="module")
def design(scene: AimScene) -> SceneCuts:
    return scene.draw(LIGHT, 1, 1, 0, 40_000)


@pytest.fixture(scope="module")
def report(scene: AimScene) -> SceneCuts:
    return scene.draw(LIGHT, 1, 1, 50_000, 20_000)


@pytest.mark.requirement("AIM-06")
@pytest.mark.parametrize("name", KNOWN)
def test_realised_share_is_the_one_asked_for(design: SceneCuts, report: SceneCuts, name: str) -> None:
    commanded = KNOWN[name].commands(design, thresholds(design), REQUIREMENT).of(report)[:, 0]
    told = np.isfinite(commanded)
    assert told.mean() > 0.96
    exits = POSITION.exits(report)
    met = couplings(report, exits, np.where(told, commanded, 0.3), report.release_m + DISTANCE_M).of(told)
    over = met.overspeed
    spread = 0.3 * np.sqrt(1.0 / 40_000 + 1.0 / 20_000)  # of both samples
    assert over.value == pytest.approx(0.1, abs=3.0 * spread + 0.005)


def test_a_reading_keeps_the_share_for_good_and_bad_runners_alike(design: SceneCuts, report: SceneCuts) -> None:
    commands = ByReading(TWO_SPEEDS).commands(design, thresholds(design), REQUIREMENT)
    reading = TWO_SPEEDS.of(report).with_error(report)
    exits, commanded = POSITION.exits(report), commands.at(reading)[:, 0]
    met = couplings(report, exits, np.where(np.isfinite(commanded), commanded, 0.3), report.release_m + DISTANCE_M)
    over = met.speed_m_s > met.limit_m_s
    for low, high in np.quantile(reading, [(0.1, 0.3), (0.4, 0.6), (0.7, 0.9)]):
        band = (reading >= low) & (reading < high)
        least, most = clopper_pearson(int(over[band].sum()), int(band.sum()))
        assert least - 0.01 < 0.1 < most + 0.01


def test_bayes_rule_is_what_throwing_away_other_readings_gives(scene: AimScene) -> None:
    """Brute force: of 400 000 cuts keep those whose noisy reading came out near 2.2 N/kN."""
    cuts = scene.draw(LIGHT, 1, 7, 0, 400_000)
    reading, threshold = TWO_SPEEDS.of(cuts).with_error(cuts), thresholds(cuts)
    near = np.abs(reading - 2.2) < 0.02
    by_force = np.quantile(threshold[near, 0], 0.1)
    by_bayes = ByReading(TWO_SPEEDS).commands_at(np.array([2.2]), cuts, threshold, REQUIREMENT).speeds_m_s[0, 0]
    assert near.sum() > 3000
    assert by_bayes == pytest.approx(by_force, abs=0.015)


def test_a_measured_resistance_leaves_less_gap_than_the_category(design: SceneCuts, report: SceneCuts) -> None:
    gaps = []
    for name in ("category", "two speeds"):
        commanded = KNOWN[name].commands(design, thresholds(design), REQUIREMENT).of(report)[:, 0]
        given = np.where(np.isfinite(commanded), commanded, 0.3)
        gaps.append(couplings(report, POSITION.exits(report), given, report.release_m + DISTANCE_M).gap_per_car_m)
    assert gaps[1].high95 < 0.6 * gaps[0].low95


def test_a_reading_is_the_mean_resistance_of_the_stretch(scene: AimScene) -> None:
    """Without wind, bend and speed terms the stretch takes w0 off the grade, so a perfect sensor reads w0 and air."""
    cuts = scene.draw(LIGHT, 2, 5, 0, 500)
    drawn, (v1, v2) = cuts.rolling.cuts, cuts.measured_speeds_m_s
    value = TWO_SPEEDS.of(cuts).value
    against = 0.5 * (v1 + v2) + drawn.head_wind_m_s
    bend = drawn.bend_v2_m_s2[:, 0] * (0.5 * (v1 + v2)) ** 2 * 1e3 / 138.0
    expected = drawn.resistance_n_per_kn + drawn.air_n_per_kn * against * np.abs(against) + bend
    assert value == pytest.approx(expected, abs=0.06)
    radar = ResistanceByRadar(0.05, 50.0).of(cuts)  # its 50 m have no bend
    against = v2 + drawn.head_wind_m_s
    expected = drawn.resistance_n_per_kn + drawn.air_n_per_kn * against * np.abs(against)
    assert radar.value == pytest.approx(expected, rel=0.04)


def test_commands_do_not_fall_with_the_reading_and_nothing_follows_nothing() -> None:
    rows = np.array([[1.0, 2.0], [np.nan, 1.0], [3.0, 4.0], [2.0, 5.0]])
    rising = not_falling(rows)
    assert np.isnan(rising[:2, 0]).all()
    assert rising[2:, 0].tolist() == [2.5, 2.5]
    assert rising[:, 1].tolist() == [1.5, 1.5, 4.0, 5.0]


def test_the_nearest_record_is_that_of_a_search() -> None:
    rng = np.random.default_rng(4)
    records, times = rng.normal(size=(50, 2)), rng.normal(size=(200, 2))
    search = ((records[None] - times[:, None]) ** 2).sum(axis=2).argmin(axis=1)
    assert (nearest(records, times) == search).all()


def test_wrong_records_cost_gap(design: SceneCuts, report: SceneCuts) -> None:
    gaps = []
    for wrong in (0.0, 0.3):
        commands = NearestRecord(POINTS, 300, wrong).commands(design, thresholds(design), REQUIREMENT)
        given = np.nan_to_num(commands.of(report)[:, 0], nan=0.3)
        gaps.append(couplings(report, POSITION.exits(report), given, report.release_m + DISTANCE_M).gap_per_car_m)
    assert gaps[1].low95 > gaps[0].high95
