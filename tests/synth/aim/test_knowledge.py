"""What commands know of cuts, and positions whose cuts go through the closed loop.

Commands keep the probability that was asked for, on other cuts than those that they were chosen on.
A position of regulators: each cut goes through the closed loop as through a plant of its own.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from plant_models import Plant, PlantError
from scripts.studies.aiming.refinements import (
    ByRegression,
    ControlPoints,
    LightnessByWeigher,
    NearestRecord,
    ResistanceByRadar,
    nearest,
)
from synth.aim.knowledge import ByCategory, ByReading, Knowledge, Requirement, ResistanceByTwoSpeeds, not_falling
from synth.aim.position_models import NormalPosition, SampledExits, couplings
from synth.aim.scene import AimScene, SceneCuts
from synth.aim.table_position import TablePosition, entry_speeds_m_s
from synth.retarder.comparison.baselines import energy_rule
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.table_class import TableClass
from synth.simulation.closed_loop import close_loop
from synth.simulation.exit_statistics import clopper_pearson
from synth.simulation.random_passes import random_passes
from tests.synth.aim.conftest import HEAVY, LIGHT

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


TARGETS = (1.5, 2.0, 3.0)
PARK = """\
position.name = "rnz-2m-park"
entry.low_m_s = 3.2
entry.high_m_s = 5.0
targets.exit_speeds_m_s = [1.5]
cut = [{ car = "gondola-4", mass_t = 23 }, { car = "gondola-4", mass_t = 27 }]
"""


def regulated(plant: Plant) -> TableClass:
    """The energy rule at every target."""
    loop = close_loop(plant, plant.top_stage + 1)
    rules = tuple(energy_rule(loop, target, plant.top_stage, 0.9, -0.03, 0.4, 0.1) for target in TARGETS)
    return TableClass(plant, TARGETS, rules)


@pytest.fixture(scope="module")
def position() -> TablePosition:
    return TablePosition(tuple(regulated(plant) for _, plant in parse_config(PARK, "park.toml").plants()))


def test_each_cut_is_as_in_a_plant_of_its_own(scene: AimScene, position: TablePosition) -> None:
    """The plant is built anew with the mass of the cut; the position scales the work of the brake instead.

    A relay may decide otherwise at one sample for a difference of a millimetre a second: so not every cut is as near.
    """
    cuts = scene.draw(LIGHT, 1, 5, 0, 40)
    exits, entry = position.exits(cuts).exits_m_s, entry_speeds_m_s(cuts)
    passes, masses = random_passes(5, 0, 40), cuts.rolling.cuts.cut_mass_t
    apart = np.empty((40, len(TARGETS)))
    for i in range(40):
        of_class = position.classes[0 if masses[i] < 25.0 else 1]
        own = replace(of_class.plant, cut=replace(of_class.plant.cut, mass_t=float(masses[i])))
        for k, target in enumerate(TARGETS):
            loop = close_loop(own, own.top_stage + 1)
            resistance = cuts.resistance_at(0.5 * (entry[i : i + 1] + target), np.array([i]))
            drawn = loop.draws(passes.part(i, i + 1))._replace(
                resistance_n_kn=resistance, entry_m_s=own.start_speed_m_s(entry[i : i + 1], resistance)
            )
            alone = loop.run(of_class.controllers[k], drawn).exit_speed_m_s[0]
            apart[i, k] = exits[i, k] - alone
    assert np.median(np.abs(apart)) < 0.001
    assert np.quantile(np.abs(apart), 0.85) < 0.02
    assert abs(apart.mean()) < 0.005


def test_exits_of_a_cut_do_not_depend_on_the_others(scene: AimScene, position: TablePosition) -> None:
    together = position.exits(scene.draw(LIGHT, 1, 5, 0, 2500)).exits_m_s
    alone = position.exits(scene.draw(LIGHT, 1, 5, 2100, 30)).exits_m_s
    assert (together[2100:2130] == alone).all()


def test_cuts_without_a_class_are_named(scene: AimScene, position: TablePosition) -> None:
    for category, cars in ((HEAVY, 1), (LIGHT, 2)):
        with pytest.raises(PlantError, match=f"none for {cars} cars of category {category.name}"):
            position.exits(scene.draw(category, cars, 5, 0, 10))


def test_one_target_is_no_choice(position: TablePosition) -> None:
    first = position.classes[0]
    with pytest.raises(PlantError, match="1 targets; a position that is commanded needs two or more"):
        TableClass(first.plant, (1.5,), first.controllers[:1])


def test_between_two_targets_exits_are_linear_and_thresholds_their_inverse() -> None:
    rng = np.random.default_rng(1)
    commands = np.array([1.0, 1.5, 2.5, 4.0])
    sampled = SampledExits(commands, np.sort(commands + rng.normal(0.0, 0.1, (300, 4)), axis=1))
    asked = rng.uniform(1.0, 4.0, 300)
    expected = [np.interp(v, commands, row) for v, row in zip(asked, sampled.exits_m_s, strict=True)]
    assert sampled.at(asked) == pytest.approx(expected)
    assert sampled.threshold(sampled.at(asked)) == pytest.approx(asked, abs=1e-9)


def test_a_cut_that_no_command_holds_has_no_threshold_and_a_slow_one_none_that_binds() -> None:
    sampled = SampledExits(np.array([1.0, 2.0]), np.array([[3.0, 3.1], [1.0, 1.4]]))
    threshold = sampled.threshold(np.array([2.0, 1.9]))
    assert threshold[0] == -np.inf
    assert threshold[1] == pytest.approx(2.5)


def test_noise_that_lets_an_exit_fall_does_not_lower_the_threshold_after_it() -> None:
    sampled = SampledExits(np.array([1.0, 2.0, 3.0]), np.array([[1.0, 2.2, 2.1]]))
    assert sampled.at(np.array([3.0]))[0] == 2.2
    assert sampled.threshold(np.array([2.15]))[0] < 2.0
