"""Passes side by side with commands at any time are, to the bit, the passes one after the other."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from plant_models import Plant, RollingResistance, TrackProfile
from synth.kernels.any_time.any_time_law import AnyTimeLaw
from synth.kernels.any_time.closed_loop import run_any_time_passes
from synth.kernels.any_time.played_periods import PlayedPeriods
from synth.kernels.loop.lane_places import LANES
from synth.kernels.loop.passes import LONGEST_PASS_S, Draws
from synth.retarder.comparison.baselines import energy_rule, relay
from synth.simulation.closed_loop import (
    ClosedLoop,
    LineController,
    TableController,
    close_loop,
    empty_exits,
    empty_observed,
    empty_trace,
    lane_memory,
    sample_of,
)
from synth.simulation.controllers import Regulator, fixed
from synth.simulation.passes import ExitSample
from synth.simulation.path_and_drive import STATES, empty_periods
from synth.simulation.random_passes import RandomPasses, random_passes
from synth.solver.switching_lines import SwitchingLines
from tests.oracles.passes_one_by_one import one_by_one
from tests.synth.simulation.passage_cases import with_approach
from tests.synth.test_closed_loop_lanes import (
    assert_same_trace,
    few_exits,
    rough_estimator,
    wavy_table,
    with_gaps,
    without_compiler,
)
from tuning_tables import Approach, ControllerTable, Decisions

PASSES = 3 * LANES + 7


@pytest.fixture(scope="module")
def passes() -> RandomPasses:
    return random_passes(seed=11, first_pass=0, count=PASSES)


def assert_same(loop: ClosedLoop, controller: Regulator, draws: Draws) -> ExitSample:
    by_lanes = loop.run(controller, draws)
    assert_equal(by_lanes, one_by_one(loop, controller, draws))
    for i in range(0, len(by_lanes), 30):
        assert_same_trace(loop, controller, draws.part(i, i + 1))
    return by_lanes


def assert_equal(by_lanes: ExitSample, apart: ExitSample) -> None:
    for name, array in vars(apart).items():
        assert getattr(by_lanes, name).tobytes() == array.tobytes(), name


def unlocked(controller: LineController) -> LineController:
    return replace(controller, decisions=Decisions.AT_ANY_TIME)


def sloping(plant: Plant, target_m_s: float, slopes: tuple[float, float] = (0.0004, 0.0005)) -> TableController:
    """The table of many commands, at any time, with slopes of both lines in m/s per kPa."""
    lower, upper = (float(np.float32(slope)) for slope in slopes)
    table = wavy_table(plant, target_m_s)
    stages = tuple(
        replace(
            stage,
            lower_slope_m_s_per_kpa=None if stage.lower is None else lower,
            upper_slope_m_s_per_kpa=None if stage.upper is None else upper,
        )
        for stage in table.stages
    )
    return TableController(replace(table, stages=stages, decisions=Decisions.AT_ANY_TIME))


@pytest.mark.parametrize("gauge_factor", [1.0, 0.85, math.nan])
@pytest.mark.parametrize("target_m_s", [2.0, 4.0])
def test_tables_with_slopes(plant_52t: Plant, passes: RandomPasses, target_m_s: float, gauge_factor: float) -> None:
    loop = close_loop(plant_52t, 5)
    controller = replace(sloping(plant_52t, target_m_s), gauge_factor=gauge_factor)
    sample = assert_same(loop, controller, loop.draws(passes))
    assert sample.switchings.mean() > 5.0


def test_slopes_and_gauge_have_a_say(plant_52t: Plant, passes: RandomPasses) -> None:
    loop = close_loop(plant_52t, 5)
    draws, controller = loop.draws(passes), sloping(plant_52t, 3.0)
    flat = sloping(plant_52t, 3.0, (0.0, 0.0))
    others = flat, replace(controller, gauge_factor=0.85), replace(controller, gauge_factor=math.nan)
    exits = [loop.run(each, draws).exit_speed_m_s for each in (controller, *others)]
    for other in exits[1:]:
        assert np.mean(other != exits[0]) > 0.5
    silent = exits[-1]
    assert silent.tobytes() == exits[1].tobytes()  # a silent gauge is at the pressure of the stage: no slope counts


@pytest.mark.parametrize(("lead_s", "farthest"), [(0.0, 1), (0.0, 4), (0.3, 4)])
def test_lines(plant_52t: Plant, passes: RandomPasses, lead_s: float, farthest: int) -> None:
    loop = close_loop(plant_52t, 5)
    rule = energy_rule(loop, 3.0, 4, 0.8, 0.15, lead_s, 0.15)
    sample = assert_same(loop, unlocked(replace(rule, farthest=farthest)), loop.draws(passes))
    assert sample.switchings.mean() > 3.0


@pytest.mark.parametrize("count", [1, LANES - 1, LANES, LANES + 1])
def test_any_number_of_passes(plant_52t: Plant, passes: RandomPasses, count: int) -> None:
    loop = close_loop(plant_52t, 5)
    controller = sloping(plant_52t, 3.0)
    few = assert_same(loop, controller, loop.draws(passes.part(0, count)))
    many = loop.run(controller, loop.draws(passes))
    assert few.exit_speed_m_s.tobytes() == many.exit_speed_m_s[:count].tobytes()


@pytest.mark.parametrize(("entrance_stage", "initial_stage"), [(1, 0), (3, 2)])
def test_an_approach(plant_52t: Plant, passes: RandomPasses, entrance_stage: int, initial_stage: int) -> None:
    plant = with_approach(plant_52t, 6.0, entrance_stage, initial_stage)
    loop, table = close_loop(plant, 5), sloping(plant, 3.0)
    assert isinstance(table.table, ControllerTable)
    approach, valid = Approach(6.0, entrance_stage), replace(table.table.valid, s_m=(-6.0, plant.exit_m - 2.0))
    gated = replace(table, table=replace(table.table, approach=approach, valid=valid))
    for controller in (table, gated, unlocked(replace(relay(loop, 3.0, 3, 0.1, 0.0), lead_s=0.2))):
        assert_same(loop, controller, loop.draws(passes))


def test_missing_readings_and_a_sensor_without_steps(plant_52t: Plant, passes: RandomPasses) -> None:
    loop = close_loop(replace(plant_52t, sensor=replace(plant_52t.sensor, resolution_m_s=0.0)), 5)
    noise = np.where(np.arange(passes.noise_z.shape[1]) % 5 == 3, np.float32(np.nan), passes.noise_z)
    draws = loop.draws(replace(passes, noise_z=noise))
    assert_same(loop, sloping(plant_52t, 3.0), draws)
    for lead_s in (0.0, 0.4):
        assert_same(loop, unlocked(energy_rule(loop, 3.0, 4, 0.8, 0.15, lead_s, 0.15)), draws)


@pytest.mark.parametrize(("period_s", "delay_s", "substeps"), [(0.07, 0.0, 4), (0.1, 0.05, 1), (0.03, 0.02, 7)])
def test_other_periods_and_parts(
    plant_52t: Plant, passes: RandomPasses, period_s: float, delay_s: float, substeps: int
) -> None:
    sensor = replace(plant_52t.sensor, sample_period_s=period_s, computing_delay_s=delay_s)
    plant = replace(plant_52t, sensor=sensor)
    loop = close_loop(plant, 5, substeps)
    assert_same(loop, sloping(plant, 3.0), loop.draws(passes))


def constant_lines(plant: Plant, lower: list[float], upper: list[float], lead_s: float) -> LineController:
    lines = SwitchingLines(np.array([0.0, plant.exit_m]), np.outer(lower, [1.0, 1.0]), np.outer(upper, [1.0, 1.0]))
    return LineController(lines, lead_s=lead_s, decisions=Decisions.AT_ANY_TIME)


@pytest.mark.parametrize("lead_s", [0.0, 0.2])
def test_stalls_and_passes_longer_than_their_noise(plant_22t: Plant, passes: RandomPasses, lead_s: float) -> None:
    level = replace(plant_22t, profile=TrackProfile.uniform(1.5), resistance=RollingResistance(1.4, 0.2))
    loop = close_loop(level, 3)
    draws = loop.draws(passes)
    stopped = assert_same(loop, constant_lines(level, [-math.inf] * 3, [0.0, 0.0, math.inf], lead_s), draws)
    assert stopped.stalled.all()
    slow = draws._replace(entry_m_s=fixed(np.linspace(0.5, 3.0, len(passes)), np.float64))
    sample = assert_same(loop, constant_lines(level, [-math.inf, 0.6, 0.6], [0.8, 0.8, math.inf], lead_s), slow)
    assert 0 < sample.stalled.sum() < len(passes)
    assert sample.transit_time_s.max() > 0.1 * passes.noise_z.shape[1]


@pytest.mark.parametrize("period_s", [0.1, 0.07])
def test_a_creeping_cut_is_given_up(plant_22t: Plant, passes: RandomPasses, period_s: float) -> None:
    sensor = replace(plant_22t.sensor, sample_period_s=period_s)
    crawl = replace(plant_22t, profile=TrackProfile.uniform(1.4), resistance=RollingResistance(1.4, 0.0), sensor=sensor)
    loop = close_loop(crawl, 3)
    draws = loop.draws(passes)
    draws = draws._replace(entry_m_s=fixed(np.full(len(passes), 0.1), np.float64))
    sample = assert_same(loop, constant_lines(crawl, [-math.inf] * 3, [math.inf] * 3, 0.0), draws)
    assert sample.stalled.all()
    assert not sample.exit_speed_m_s.any()
    assert np.all(np.abs(sample.transit_time_s - LONGEST_PASS_S) <= period_s)


def observing(plant: Plant, target_m_s: float) -> TableController:
    """The same table with an estimator that knows the plant roughly."""
    controller = sloping(plant, target_m_s)
    return replace(controller, table=replace(controller.table, estimator=rough_estimator(plant)))


@pytest.mark.parametrize(("gaps", "period_s"), [(False, 0.1), (True, 0.1), (False, 0.4)])
def test_an_estimator(plant_52t: Plant, passes: RandomPasses, gaps: bool, period_s: float) -> None:
    sensor = replace(plant_52t.sensor, sample_period_s=period_s)
    loop, controller = close_loop(replace(plant_52t, sensor=sensor), 5), observing(plant_52t, 3.0)
    draws = loop.draws(with_gaps(passes) if gaps else passes)
    sample = assert_same(loop, controller, draws)
    assert np.mean(sample.exit_speed_m_s != loop.run(sloping(plant_52t, 3.0), draws).exit_speed_m_s) > 0.5
    by_lines = unlocked(energy_rule(loop, 3.0, 4, 0.8, 0.15, 0.0, 0.15))
    for lead_s in (0.0, 0.2):
        assert_same(loop, replace(by_lines, lead_s=lead_s, estimator=controller.table.estimator), draws)


def in_lanes(loop: ClosedLoop, controller: Regulator, draws: Draws, played: PlayedPeriods) -> None:
    """The passes of `draws` with this memory for the drive are those one after the other."""
    law, n = controller.law(), len(draws.cut_factor)
    assert isinstance(law, AnyTimeLaw)
    exits, memory = empty_exits(n), (empty_trace(0), lane_memory(), played, empty_observed(law.rule, n))
    run_any_time_passes(loop.path, loop.sampled, loop.sensor, law, draws, exits, *memory)
    assert_equal(sample_of(exits, draws), one_by_one(loop, controller, draws))


@pytest.mark.parametrize("states", [2, 3, 30, 100])
def test_a_full_memory_changes_nothing(plant_52t: Plant, passes: RandomPasses, states: int) -> None:
    loop = close_loop(plant_52t, 5)
    for controller in (sloping(plant_52t, 3.0), observing(plant_52t, 3.0)):
        played = empty_periods(loop.sampled, states)
        in_lanes(loop, controller, loop.draws(passes), played)
        assert played.taken[0] == states  # all of them are taken


def test_room_for_states_but_not_for_pieces_changes_nothing(plant_52t: Plant, passes: RandomPasses) -> None:
    loop = close_loop(plant_52t, 5)
    played = empty_periods(loop.sampled)
    for few in (0, 1, 40, 400):
        pieces, kept = played.pieces, played.pieces.sampled + few + LANES * loop.sampled.parts
        short = pieces._replace(kpa=pieces.kpa[:kept])
        in_lanes(loop, sloping(plant_52t, 3.0), loop.draws(passes), played._replace(pieces=short))
        assert short.sampled + few - loop.sampled.parts < played.taken[1] <= short.sampled + few


def test_a_memory_serves_again_and_is_large_enough(plant_52t: Plant) -> None:
    loop = close_loop(plant_52t, 5)
    draws, played = loop.draws(random_passes(12, 0, 2000)), empty_periods(loop.sampled)
    for gauge_factor in (1.0, 0.85):
        in_lanes(loop, replace(sloping(plant_52t, 3.0), gauge_factor=gauge_factor), draws, played)
        assert played.taken[0] < STATES
        assert played.taken[1] < len(played.pieces.kpa) - (LANES + 1) * loop.sampled.parts


def laws_at_any_time(loop: ClosedLoop) -> tuple[Regulator, ...]:
    rules = relay(loop, 3.0, 3, 0.1, 0.0), energy_rule(loop, 3.0, 4, 0.8, 0.15, 0.3, 0.15)
    return sloping(loop.plant, 3.0), observing(loop.plant, 3.0), *map(unlocked, rules)


def test_the_kernels_mean_the_same_without_the_compiler() -> None:
    assert without_compiler("any_time.test_loop_lanes.laws_at_any_time") == few_exits(laws_at_any_time)
