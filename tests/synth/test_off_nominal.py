"""Tables off nominal: each changed plant built by hand, the figures of its passes anew, and what is told of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from plant_models import Plant, PressingForce, WeightForce
from synth.retarder.case_result import CaseResult
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.off_nominal_trials import CONDITIONS, Trials, trials
from synth.retarder.shown.checks import worst_of
from synth.simulation.closed_loop import TableController, simulate
from synth.simulation.common_passes import CommonPasses, common_passes
from synth.simulation.exit_statistics import exit_statistics, rms_ratio
from synth.simulation.passes import ExitSample
from synth.simulation.stratified_passes import stratified_passes
from tests.synth.case_factory import make_case, make_table
from tuning_tables import ControllerTable

SEED, VALIDATED, TRIED, TARGET = 5, 1500, 1000, 3.0


def weaker(plant: Plant) -> Plant:
    """Seven tenths of the force at every pressure: what a factor on ξ and its floor does to all cuts."""
    force = plant.position.force
    if isinstance(force, PressingForce):
        force = replace(force, slope_kn_per_kpa_per_pair=0.7 * force.slope_kn_per_kpa_per_pair)
    else:
        assert isinstance(force, WeightForce)
        force = replace(force, slope_kn_per_kpa_per_t=0.7 * force.slope_kn_per_kpa_per_t)
    return replace(plant, position=replace(plant.position, force=force))


def slower(plant: Plant) -> Plant:
    air = plant.position.pneumatics
    later = replace(
        air,
        brake_delay_s=1.5 * air.brake_delay_s,
        touch_delay_s=1.5 * air.touch_delay_s,
        release_delay_s=1.5 * air.release_delay_s,
        closing_delay_s=1.5 * air.closing_delay_s,
        fill_time_constant_s=1.5 * air.fill_time_constant_s,
        exhaust_time_constant_s=1.5 * air.exhaust_time_constant_s,
    )
    return replace(plant, position=replace(plant.position, pneumatics=later))


def deafer(plant: Plant) -> Plant:
    return replace(plant, sensor=replace(plant.sensor, missed_share=1.0 / 3.0, missed_burst_s=0.6))


def weighing(factor: float) -> Callable[[Plant], Plant]:
    def changed(plant: Plant) -> Plant:
        return replace(plant, cut=replace(plant.cut, mass_t=factor * plant.cut.mass_t))

    return changed


BY_HAND: dict[str, list[Callable[[Plant], Plant]]] = {
    "low_friction": [weaker],
    "slow_valves": [slower],
    "lost_readings": [deafer],
    "wrong_weight": [weighing(0.9), weighing(1.1)],
}


def plant_at(position: str) -> Plant:
    [(_, plant)] = parse_config(
        f'[position]\nname = "{position}"\n[[cut]]\ncar = "gondola-4"\nmass_t = 52\n', "x.toml"
    ).plants()
    return plant


@pytest.mark.parametrize("position", ["knp-5-bunch", "kv-3-bunch", "rnz-2m-park"])
def test_every_condition_is_the_plant_that_one_would_build_by_hand(position: str) -> None:
    plant = plant_at(position)
    assert [each.key for each in CONDITIONS] == list(BY_HAND)
    for condition in CONDITIONS:
        by_hand = BY_HAND[condition.key]
        for change, other in zip(condition.changes.values(), by_hand, strict=True):
            assert change(plant) == other(plant), condition.key


def test_friction_times_0_7_brakes_every_cut_by_seven_tenths(plant_52t: Plant) -> None:
    """By the loop's own decelerations, with ξ's floor of the plant far below."""
    changed = CONDITIONS[0].changes["friction × 0.7"](plant_52t)
    few = stratified_passes(SEED, 0, 200)
    one, other = (common_passes(plant, few).draws.brake_m_s2_per_kpa for plant in (plant_52t, changed))
    assert np.allclose(0.7 * one, other, rtol=1e-12)


def test_bursts_last_one_reading_at_least(plant_52t: Plant) -> None:
    rare = replace(plant_52t, sensor=replace(plant_52t.sensor, sample_period_s=1.0))
    [change] = CONDITIONS[2].changes.values()
    assert change(rare).sensor.missed_burst_s == 1.0


@pytest.fixture(scope="module")
def validation(plant_52t: Plant) -> CommonPasses:
    return common_passes(plant_52t, stratified_passes(SEED, 0, VALIDATED))


@pytest.fixture(scope="module")
def tried(validation: CommonPasses) -> Trials:
    return trials(validation, TRIED)


@pytest.fixture(scope="module")
def table(plant_52t: Plant) -> ControllerTable:
    return make_table("52t", plant_52t, TARGET)


def test_the_figures_are_those_of_fresh_passes_on_the_changed_plant(
    tried: Trials, validation: CommonPasses, table: ControllerTable
) -> None:
    nominal = validation.run(TableController(table))
    first = ExitSample(**{name: array[:TRIED] for name, array in vars(nominal).items()})
    for found in tried.of(table, nominal):
        assert found.outcome is not None
        samples = [
            simulate(change(validation.plant), TableController(table), stratified_passes(SEED, 0, TRIED))
            for change in BY_HAND[found.key]
        ]
        worse = max(samples, key=lambda sample: exit_statistics(sample, TARGET).rms_m_s)
        figures, outcome = exit_statistics(worse, TARGET), found.outcome
        assert (outcome.passes, outcome.rms_m_s, outcome.rms_ci95_m_s) == (
            TRIED,
            figures.rms_m_s,
            figures.rms_ci95_m_s,
        )
        assert (outcome.overspeed, outcome.overspeed_ci95) == (figures.overspeed, figures.overspeed_ci95)
        assert (outcome.stalled, outcome.stalled_ci95) == (figures.stalled, figures.stalled_ci95)
        assert (outcome.ratio, outcome.ratio_ci95) == rms_ratio(worse, first, TARGET)
    changes = [each.outcome.change for each in tried.of(table, nominal) if each.outcome]
    assert changes[-1] in ("the cut 10 % lighter", "the cut 10 % heavier")


def test_no_more_passes_than_the_validation_has(validation: CommonPasses, table: ControllerTable) -> None:
    few = common_passes(validation.plant, stratified_passes(SEED, 0, 300))
    for each in trials(few).of(table, few.run(TableController(table))):
        assert each.outcome is not None
        assert each.outcome.passes == 300


def test_a_plant_that_cannot_be_is_told_of(table: ControllerTable, plant_52t: Plant) -> None:
    """A cut as heavy as can be cannot be 10 % heavier."""
    heaviest = replace(plant_52t, cut=replace(plant_52t.cut, mass_t=19_900.0))
    few = common_passes(heaviest, stratified_passes(SEED, 0, 200))
    *others, weight = trials(few).of(table, few.run(TableController(table)))
    assert all(each.outcome is not None for each in others)
    assert weight.outcome is None
    assert "mass_t" in weight.impossible


def test_the_worst_is_the_largest_ratio() -> None:
    one, other = make_case("gondola-22t", 2.0), make_case("gondola-85t", 4.0)
    (first, *rest) = other.off_nominal
    assert first.outcome is not None
    bad = replace(first.outcome, ratio=9.5, rms_m_s=0.38, rms_ci95_m_s=(0.37, 0.39))
    other = replace(other, off_nominal=(replace(first, outcome=bad), *rest))
    worst = worst_of([one, other])
    assert worst is not None
    assert (worst.case, worst.key, worst.ratio) == (other, "low_friction", 9.5)
    assert worst.told.endswith(
        "the worst is gondola-85t, target 4 m/s with friction × 0.7: rms 0.3800 [0.3700, 0.3900] m/s, "
        "9.5 times the nominal."
    )


def without_ratios(case: CaseResult) -> CaseResult:
    changes: dict[str, Any] = {"ratio": None, "ratio_ci95": None}
    kept = (replace(each, outcome=each.outcome and replace(each.outcome, **changes)) for each in case.off_nominal)
    return replace(case, off_nominal=tuple(kept))


def test_without_ratios_nothing_is_the_worst() -> None:
    assert worst_of([without_ratios(make_case())]) is None
    assert worst_of([replace(make_case(), off_nominal=())]) is None
