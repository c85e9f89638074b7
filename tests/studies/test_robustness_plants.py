"""Perturbed plants: nothing changed is the same bits, equivalent plants leave at the same speeds, limits hold."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from plant_models import Friction, Plant, PlantError, WeightForce
from scripts.studies.changed_plants import aged_valves, friction
from scripts.studies.robustness.condition import at_value, conditions, out_of_service, sensible_ends, shifted_stages
from synth.retarder.configuration.config_file import load_config
from synth.retarder.configuration.cut_class import CutClass
from synth.retarder.configuration.plant_values import (
    NEARLY_SUPPLY,
    SLOPE_BY_AXLES,
    STAGE_PRESSURES,
    Parameter,
    assumed_keys,
    by_axles,
    parameters,
    with_values,
)
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.simulation.closed_loop import LineController, TableController, close_loop, simulate
from synth.simulation.random_passes import RandomPasses, random_passes
from synth.solver.switching_lines import SwitchingLines
from tests.synth.case_factory import make_plant, make_table

SUPPLY = "retarder.pneumatics.supply_pressure_kpa"


LEFT_OUT = {
    "retarder.zones_m": "surveyed with a tape; a table is refused for other zones",
    "retarder.max_entry_speed_m_s": "a limit of use, not part of the motion",
    "targets.exit_speeds_m_s": "commanded, not a property of the plant",
    "cut.car.length_m": "drawing of the car",
    "cut.car.pivot_base_m": "drawing of the car; a table is refused for other axles",
    "cut.car.bogie_axle_offsets_m": "drawing of the car; a table is refused for other axles",
    "cut.car.pivots_m": "drawing of the car; a table is refused for other axles",
    "cut.car.axle_offsets_m": "drawing of the car; a table is refused for other axles",
    "cut.allowed_stage": "a rule of the yard; a table is refused for another",
    "cut.entrance_stage": "a rule of the yard; a table is refused for another",
    "sensor.missed_share": "none is lost; what a third would do stands in the report of a tune",
    "sensor.missed_burst_s": "without effect while no reading is lost",
    "friction.mean_cv": "no property of a pass: what lines with an estimator are designed for",
    "retarder.pneumatics.day_spread": "no property of a pass: what lines with an estimator are designed for",
    "regulator.approach_m": "where the regulator acts; a table is refused for another (study approach)",
}
"""Assumed values that are not changed, and why."""


@pytest.fixture(scope="module")
def config() -> ResolvedConfig:
    return load_config(None)


@pytest.fixture(scope="module")
def cases(config: ResolvedConfig) -> list[tuple[CutClass, Plant, tuple[Parameter, ...]]]:
    """Every class of the default book with its plant and parameters at 3 m/s."""
    pairs = zip(config.cuts, config.plants(), strict=True)
    return [(cut, plant, parameters(config, cut, plant, 3.0)) for cut, (_, plant) in pairs]


@pytest.fixture(scope="module")
def passes() -> RandomPasses:
    return random_passes(seed=11, first_pass=0, count=500)


def constant_lines(plant: Plant, upper_m_s: list[float]) -> LineController:
    nodes = np.linspace(0.0, plant.exit_m, 2)
    upper = np.outer([*upper_m_s, np.inf], [1.0, 1.0])
    lower = np.vstack([np.full((1, 2), -np.inf), upper[:-1] - 0.3])
    return LineController(SwitchingLines(nodes, lower, upper))


# ------------------------------------------------------------------------------------- nothing changed


def test_no_perturbation_is_the_nominal_plant_to_the_bit(
    cases: list[tuple[CutClass, Plant, tuple[Parameter, ...]]], passes: RandomPasses
) -> None:
    for _, plant, every in cases:
        assert with_values(plant, {}) == plant
        assert with_values(plant, {p.key: p.nominal for p in every if p.nominal != 0.0}) == plant
        assert all(with_values(plant, {parameter.key: parameter.nominal}) == plant for parameter in every)
    plant = make_plant(36.0, 4)
    controller = TableController(make_table("test", plant, 3.0))
    one, other = (simulate(x, controller, passes) for x in (plant, with_values(plant, {})))
    assert all(np.array_equal(a, b) for a, b in zip(vars(one).values(), vars(other).values(), strict=True))


def test_every_assumed_value_is_studied_or_left_out_with_a_reason(
    config: ResolvedConfig, cases: list[tuple[CutClass, Plant, tuple[Parameter, ...]]]
) -> None:
    for cut, _, every in cases:
        assumed = set(assumed_keys(config, cut))
        studied = {parameter.key for parameter in every}
        assert assumed <= studied | set(LEFT_OUT)
        assert not studied & set(LEFT_OUT)
        assert {p.key for p in every if p.assumed} == assumed & studied
        assert len(assumed & studied) >= 20
    known = {re.sub(r"^cut\[\d+\]", "cut", value.key) for value in config.parameters}
    assert {p.key for _, _, every in cases for p in every} <= known


def test_every_parameter_changes_its_own_value_and_nothing_else(
    cases: list[tuple[CutClass, Plant, tuple[Parameter, ...]]],
) -> None:
    for _, plant, every in cases:
        for parameter in every:
            largest = 1.5 * parameter.nominal or (parameter.sensible or (0.0, 0.0))[1]
            for value in (0.5 * parameter.nominal, largest):
                clipped = min(max(value, parameter.low), parameter.high)
                changed = with_values(plant, {parameter.key: clipped})
                moved = [x for x in vars(plant) if getattr(plant, x) != getattr(changed, x)]
                assert len(moved) == (clipped != parameter.nominal), (parameter.key, value)


def test_a_parameter_has_the_limits_of_its_use(
    cases: list[tuple[CutClass, Plant, tuple[Parameter, ...]]],
) -> None:
    by_key = {p.key: p for p in cases[2][2]}
    low, mass = by_key["entry.low_m_s"], by_key["cut.mass_t"]
    assert (low.low, low.high) == (3.0, 6.5)  # the target; the highest entry speed
    assert (mass.low, mass.high) == (44.0, 60.0)  # the category С


def test_sensible_ends_are_those_of_the_library(
    cases: list[tuple[CutClass, Plant, tuple[Parameter, ...]]],
) -> None:
    _, plant, every = cases[2]
    by_key = {p.key: p for p in every}
    low, high = (end.change(plant) for end in sensible_ends(plant, by_key["sensor.noise_m_s"]))
    assert (low.sensor.noise_m_s, high.sensor.noise_m_s) == (0.02, 0.15)
    grades = [
        end.change(plant).profile.grades_permille[0] for end in sensible_ends(plant, by_key["track.grade_permille"])
    ]
    assert grades == pytest.approx([5.0, 12.0])
    assert by_key["track.grade_permille"].nominal == 1.0
    entry = sensible_ends(plant, by_key["entry.low_m_s"])[1].change(plant).entry
    assert (entry.low_m_s, entry.high_m_s) == (6.5, 6.5)  # the range ends at 7, above the highest entry speed
    with pytest.raises(ValueError, match="no sensible range"):
        sensible_ends(plant, by_key[STAGE_PRESSURES])


def test_an_unknown_value_and_an_impossible_plant_are_refused(plant_52t: Plant) -> None:
    with pytest.raises(ValueError, match="a plant has no such value"):
        with_values(plant_52t, {"retarder.colour": 1.0})
    with pytest.raises(PlantError, match="noise_m_s"):
        with_values(plant_52t, {"sensor.noise_m_s": -0.1})


# --------------------------------------------------------------------------------------- equivalent plants


def test_friction_scales_the_slope_of_a_weight_proportional_retarder(plant_52t: Plant) -> None:
    force = WeightForce(0.003, 50.0, (1.0, 0.9))
    plant = replace(plant_52t, position=replace(plant_52t.position, force=force))
    changed = friction(0.7, 2.0)(plant)
    assert changed.position.force == replace(force, slope_kn_per_kpa_per_t=0.7 * 0.003)
    assert changed.friction_cv == pytest.approx(2.0 * plant.friction_cv)


def test_last_retarder_out_of_service_is_a_position_with_one_zone(plant_52t: Plant, passes: RandomPasses) -> None:
    # Without noise along the path, so that cells of other lengths mean no other friction.
    plant = replace(plant_52t, friction=Friction(0.15, 0.0, 0.0, 2.0))
    alone = replace(plant, position=replace(plant.position, zones_m=plant.position.zones_m[:1]))
    dead = out_of_service(-1)(plant)
    assert dead.exit_m == plant.exit_m
    upper = [4.5, 4.7, 4.9, 5.1]
    first = simulate(alone, constant_lines(alone, upper), passes)
    through = simulate(dead, constant_lines(dead, upper), passes)
    assert first.stalled.sum() == through.stalled.sum() == 0
    resistance = close_loop(plant, 5).resistance_n_kn(passes.resistance_u)
    free = plant.cut.reduced_gravity_m_s2 * 1e-3 * (8.0 - resistance)
    coasted = np.sqrt(first.exit_speed_m_s**2 + 2.0 * free * (plant.exit_m - alone.exit_m))
    assert np.abs(through.exit_speed_m_s - coasted).max() < 1e-5  # the sliver works 1.5e-6 m²/s²
    both = simulate(plant, constant_lines(plant, upper), passes)
    assert through.exit_speed_m_s.mean() - both.exit_speed_m_s.mean() > 0.05


def test_first_retarder_out_of_service_only_coasts_up_to_the_second(plant_52t: Plant, passes: RandomPasses) -> None:
    dead = out_of_service(0)(plant_52t)
    path = close_loop(dead, 5).path
    work = path.brake_m_s2_per_kpa * np.diff(path.edges_m)
    start = dead.position.zones_m[1][0]
    assert work[path.edges_m[:-1] < start].sum() < 1e-6 * work.sum()
    one = replace(plant_52t, position=replace(plant_52t.position, zones_m=((0.0, 12.475),)))
    with pytest.raises(ValueError, match="one retarder"):
        out_of_service(0)(one)


# ------------------------------------------------------------------------------------------- drive


def test_stages_rest_where_the_supply_can_bring_them(plant_52t: Plant) -> None:
    for supply in (700.0, 630.0, 560.0, 350.0):
        plant = with_values(plant_52t, {SUPPLY: supply})
        drive = close_loop(plant, 5).drive
        resting = drive.mode_overpressure_kpa.max() + plant.position.force.touch_pressure_kpa
        assert resting == pytest.approx(min(585.0, NEARLY_SUPPLY * supply))
        reached = plant.position.stage_pressures_kpa
        assert all(p <= q for p, q in zip(reached, plant_52t.position.stage_pressures_kpa, strict=True))
        assert reached[:2] == plant_52t.position.stage_pressures_kpa[:2]
    note = at_value(plant_52t, Parameter(STAGE_PRESSURES, "stages", 1.0, True), 1.5, "stages + 50 %").note
    assert note == "out of reach of the supply: the top stage"


def test_named_conditions_are_all_different_plants(plant_52t: Plant) -> None:
    mass = Parameter("cut.mass_t", "mass", 52.0, False, 44.0, 60.0)
    named = conditions(plant_52t, mass)
    assert len({condition.name for condition in named}) == len(named)
    plants = [plant_52t, *(condition.change(plant_52t) for condition in named)]
    assert all(plant not in plants[:i] for i, plant in enumerate(plants))
    single = replace(plant_52t, position=replace(plant_52t.position, zones_m=((0.0, 12.475),)))
    assert len(conditions(single, mass)) == len(named) - 2  # no second retarder
    by_name = {condition.name: condition for condition in named}
    assert by_name["supply pressure −10 %"].note == ""
    assert by_name["supply pressure −20 %"].note == "out of reach of the supply: the top stage"
    aged = aged_valves(plant_52t).position.pneumatics
    assert (aged.brake_delay_s, aged.touch_delay_s, aged.release_delay_s) == (0.2, 0.4, 0.2)
    assert (aged.fill_time_constant_s, aged.exhaust_time_constant_s) == pytest.approx((0.45, 0.45))
    assert shifted_stages(-20.0)(plant_52t).position.stage_pressures_kpa == (0.0, 130.0, 280.0, 430.0, 580.0)


def test_slope_by_axles_is_linear_between_one_and_all() -> None:
    assert by_axles((1.0,), 0.5, 4) == pytest.approx((1.0, 5 / 6, 4 / 6, 0.5))
    assert by_axles((1.0, 0.8), 1.5, 3) == pytest.approx((1.0, 0.8 * 1.25, 0.8 * 1.5))
    assert by_axles((1.0, 0.8), 1.0, 3) == (1.0, 0.8)


def test_all_axles_inside_feel_the_changed_slope(plant_of: Callable[[float], Plant]) -> None:
    plant = plant_of(52.0)
    force = with_values(plant, {SLOPE_BY_AXLES: 0.5}).position.force
    nominal = plant.position.force
    ratio = [force.slope_kn_per_kpa(plant.cut, n) / nominal.slope_kn_per_kpa(plant.cut, n) for n in (1, 4)]
    assert ratio == pytest.approx([1.0, 0.5])
