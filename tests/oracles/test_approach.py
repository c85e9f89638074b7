"""A start before the entrance: what nothing brakes there means, and what may be commanded."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from plant_models import Approach, DopplerSensor, EntrySpeed, Friction, Plant, PlantError, PressingForce, TrackProfile
from synth.problem.problem import Aim
from synth.problem.resolution import Resolution
from synth.simulation.closed_loop import LineController, close_loop, simulate
from synth.simulation.controllers import full_brake
from synth.simulation.nominal_response import nominal_pass, nominal_plant
from synth.simulation.random_passes import random_passes
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import persistent_chain
from synth.solver.evaluation import Evaluation, exit_density
from synth.solver.switching_lines import SwitchingLines
from tests.oracles.test_monte_carlo import GRID

AHEAD = Approach(4.0, 1)
PASSES = 4000


@pytest.fixture
def plant(plant_with: Callable[..., Plant]) -> Plant:
    """A 12 m retarder just strong enough, everything random in it; the grade changes before the entrance."""
    return plant_with(
        zones_m=((0.0, 12.0),),
        force=PressingForce(0.022, 50.0, (1.0, 0.9)),
        friction=Friction(0.10, 0.0, 0.10, 2.0),
        sensor=DopplerSensor(0.05, 0.04, 0.1, 0.02),
        entry=EntrySpeed(4.0, 5.0),
        profile=TrackProfile((-2.5, 1.0), (12.0, 4.0)),
    )


def braking_lines(plant: Plant, speed_m_s: float) -> LineController:
    """One stage up above `speed_m_s`, anywhere; one down 1 m/s below it."""
    stages, ends = plant.top_stage + 1, np.array([plant.start_m, plant.exit_m])
    lower, upper = np.full((stages, 2), speed_m_s - 1.0), np.full((stages, 2), speed_m_s)
    lower[0], upper[-1] = -np.inf, np.inf
    return LineController(SwitchingLines(ends, lower, upper))


def test_a_cut_reaches_the_entrance_at_its_entry_speed(plant: Plant) -> None:
    """Energy by hand, on one grade and over the change to another; resistance takes its part."""
    begin = replace(plant, approach=AHEAD)
    entrance, w = 4.6, 1.9
    work = plant.cut.reduced_gravity_m_s2 * 1e-3 * 4.0 * (12.0 - w)  # both axles are on 12 permille all the way
    speed = float(begin.start_speed_m_s(np.array(entrance), w))
    assert 0.5 * entrance**2 - 0.5 * speed**2 == pytest.approx(work, rel=1e-6)
    assert float(plant.start_speed_m_s(np.array(entrance), w)) == entrance
    steep = replace(begin, profile=TrackProfile((-9.0, -3.0), (12.0, -8.0)))
    mean = 0.5 * (1.0 * 12.0 + 3.0 * -8.0) + 0.5 * (2.5 * 12.0 + 1.5 * -8.0)  # the second axle comes 1.5 m later
    work = plant.cut.reduced_gravity_m_s2 * 1e-3 * (mean - 4.0 * w)
    speed = float(steep.start_speed_m_s(np.array(entrance), w))
    assert 0.5 * entrance**2 - 0.5 * speed**2 == pytest.approx(work, rel=1e-6)


def test_no_cut_is_slower_at_the_entrance_than_the_grade_lets_it_be(plant: Plant) -> None:
    """The longest approach by hand, where the slowest cut begins with 0.3 m/s; 1 % more is refused."""
    profile = TrackProfile.uniform(20.0)
    pull = plant.cut.reduced_gravity_m_s2 * 1e-3 * (20.0 - plant.resistance.mean_n_per_kn)
    longest = (plant.entry.low_m_s**2 - 0.3**2) / (2.0 * pull)
    near = replace(plant, profile=profile, approach=Approach(0.99 * longest))
    slowest = float(near.start_speed_m_s(np.array(plant.entry.low_m_s), plant.resistance.mean_n_per_kn))
    assert slowest == pytest.approx(math.sqrt(0.3**2 + 2.0 * pull * 0.01 * longest), rel=1e-6)
    with pytest.raises(PlantError, match=r"approach_m is .*lowest entry speed is 4: shorten the approach"):
        replace(near, approach=Approach(1.01 * longest))
    replace(near, profile=TrackProfile.uniform(-20.0), approach=Approach(100.0))


def test_released_before_the_entrance_is_as_from_the_entrance(plant: Plant) -> None:
    """With no stage allowed before it, the pass behind the entrance is the same, once samples fall on the same path."""
    quiet = nominal_plant(replace(plant, sensor=replace(plant.sensor, resolution_m_s=0.0)))
    ahead = replace(quiet, approach=Approach(4.0, 0))
    period, lines = plant.sensor.sample_period_s, braking_lines(ahead, 3.0)
    far = nominal_pass(ahead, lines, 0.4, 0.3)
    free = nominal_pass(ahead, braking_lines(ahead, 99.0), 0.4, 0.3)
    arrival_s = float(np.interp(0.0, free.path_m, free.time_s))
    samples = 0.3 * period + period * np.arange(1000)
    first = float(samples[samples > arrival_s][0]) - arrival_s
    near = nominal_pass(quiet, braking_lines(quiet, 3.0), 0.4, first / period)
    assert far.exit_speed_m_s == pytest.approx(near.exit_speed_m_s, abs=2e-4)  # the arrival is interpolated
    assert far.exit_speed_m_s < 4.0, "it has braked"


def test_no_stage_above_that_of_the_entrance_is_commanded_before_it(plant: Plant) -> None:
    """Whatever the regulator wants: it raises at every sample. The stage found at rest stays."""
    for entrance_stage, initial in ((0, 0), (1, 0), (1, 1), (2, 0)):
        ahead = replace(plant, approach=Approach(8.0, entrance_stage, initial))
        loop = close_loop(ahead, ahead.top_stage + 1)
        law = full_brake(loop.stages, ahead.start_m, ahead.exit_m)
        for i in range(20):
            trace = loop.follow(law, loop.draws(random_passes(5, i, 1)))
            before = trace.stage[trace.path_m < 0.0]
            assert before[0] == initial
            assert before.max() == entrance_stage
            assert trace.stage.max() == ahead.top_stage


def test_a_brake_that_is_full_at_the_entrance_takes_the_work_of_its_whole_length(plant: Plant) -> None:
    """v² = v0² + 2·(grade − w − brake): the closed form, with the stage left from the cut ahead."""
    quiet = nominal_plant(plant)
    top = plant.top_stage
    closed = replace(quiet, approach=Approach(0.0, top, top))
    trace = nominal_pass(closed, full_brake(top + 1, 0.0, plant.exit_m), 0.5, 0.5)
    filled = float(trace.overpressure_kpa[0])
    fine = np.arange(5e-4, plant.exit_m, 1e-3)
    force = [
        n * plant.position.force.slope_kn_per_kpa(plant.cut, n) * filled if n else 0.0
        for n in (sum(int(0.0 <= s - x < 12.0) for x in plant.cut.axle_offsets_m) for s in fine)
    ]
    grade = [np.mean([4.0 if s - x >= 1.0 else 12.0 for x in plant.cut.axle_offsets_m]) for s in fine]
    drive = plant.cut.reduced_gravity_m_s2 * 1e-3 * (np.array(grade) - plant.resistance.mean_n_per_kn)
    square = 4.5**2 + 2.0 * float((drive - np.array(force) / plant.cut.inertia_t).sum()) * 1e-3
    assert 1.0 < square < 12.0, "the cut leaves, braked"
    assert trace.exit_speed_m_s == pytest.approx(math.sqrt(square), abs=1e-3)


@pytest.mark.parametrize("approach", [AHEAD, Approach(4.0, 1, 1), Approach(3.3, 0), Approach(0.0, 2, 2)])
def test_the_density_predicts_the_closed_loop(plant: Plant, approach: Approach) -> None:
    """As without approach (`test_monte_carlo`): 3.5 standard errors and the error of the grid."""
    ahead, target = replace(plant, approach=approach), 3.0
    chain = persistent_chain(ahead, replace(GRID, friction_nodes=7, path_levels=3, resistance_nodes=3))
    nodes, never = chain.grid.path_m, np.full(len(chain.grid.path_m), np.inf)
    u = nodes / plant.exit_m
    lines = SwitchingLines(
        np.array(nodes),
        np.stack([-never, 2.6 + 0.2 * u, 3.4 - 0.4 * u]),
        np.stack([3.2 - 0.2 * u, 4.0 - 0.9 * u, never]),
    )
    density = exit_density(chain.quantised(), lines)
    sample = simulate(ahead, LineController(lines), random_passes(7, 0, PASSES))
    error = sample.exit_speed_m_s - target
    rms = math.sqrt((error**2).mean())
    of_rms = (error**2).std() / math.sqrt(PASSES) / (2 * rms)
    print(f"predicted {density.rms_m_s(target):.5f}, simulated {rms:.5f} ± {of_rms:.5f}")
    assert abs(density.rms_m_s(target) - rms) < 3.5 * of_rms + 0.03 * rms
    assert abs(density.bias_m_s(target) - error.mean()) < 3.5 * error.std() / math.sqrt(PASSES) + 0.003
    assert abs(density.switchings - sample.switchings.mean()) < 0.02 * density.switchings + 0.02


def test_more_permission_costs_nothing(plant: Plant) -> None:
    """The programme's own value at the entry falls with each stage allowed at the entrance, and with the approach."""
    coarse = Resolution(path_step_m=0.25, speed_step_m_s=0.03, friction_nodes=4, resistance_nodes=1)
    aim = Aim(2.2)
    costs = []
    for approach in (Approach(4.0, 0), Approach(4.0, 1), Approach(4.0, 2)):
        chain = persistent_chain(replace(plant, approach=approach), coarse)
        costs.append(Evaluation(chain, aim).cost(solve(chain, aim).lines))
    print(costs)
    assert costs[2] < costs[1] < costs[0]
