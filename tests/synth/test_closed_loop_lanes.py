"""Passes side by side are, to the bit, the passes one after the other: two loops written apart."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from plant_models import EntrySpeed, Plant, RollingResistance, TrackProfile
from synth.kernels.loop.lane_places import LANES
from synth.kernels.loop.passes import LONGEST_PASS_S, Draws
from synth.retarder.comparison.baselines import energy_rule, relay
from synth.retarder.configuration.config_file import load_config
from synth.simulation.closed_loop import ClosedLoop, Controller, LineController, TableController, close_loop
from synth.simulation.controllers import Regulator, fixed
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses, random_passes
from synth.solver.switching_lines import SwitchingLines
from tests.oracles.passes_one_by_one import events_of, one_by_one
from tests.synth.case_factory import make_table
from tuning_tables.estimator import Estimator
from tuning_tables.provenance import ValidRange
from tuning_tables.stage import Stage, round_coefficients
from tuning_tables.table import ControllerTable


@pytest.fixture(scope="module")
def passes() -> RandomPasses:
    return random_passes(seed=11, first_pass=0, count=3 * LANES + 7)


def assert_same(loop: ClosedLoop, controller: Controller, draws: Draws) -> ExitSample:
    by_lanes, apart = loop.run(controller, draws), one_by_one(loop, controller, draws)
    for name, array in vars(apart).items():
        assert getattr(by_lanes, name).tobytes() == array.tobytes(), name
    for i in range(0, len(by_lanes), 30):
        assert_same_trace(loop, controller, draws.part(i, i + 1))
    return by_lanes


def assert_same_trace(loop: ClosedLoop, controller: Regulator, draws: Draws) -> None:
    """Of the only pass, every event and every bit of it."""
    trace, events = loop.follow(controller, draws), events_of(loop, controller, draws)
    columns = trace.time_s, trace.path_m, trace.speed_m_s, trace.overpressure_kpa, trace.stage, trace.measured_m_s
    assert np.stack(columns, axis=1).tobytes() == events.tobytes()


def constant_lines(plant: Plant, lower: list[float], upper: list[float], lead_s: float) -> LineController:
    nodes = np.linspace(0.0, plant.exit_m, 2)
    lines = SwitchingLines(nodes, np.outer(lower, [1.0, 1.0]), np.outer(upper, [1.0, 1.0]))
    return LineController(lines, lead_s=lead_s)


@pytest.mark.parametrize(("lead_s", "farthest"), [(0.0, 1), (0.0, 2), (0.0, 4), (0.3, 4)])
def test_lines(plant_52t: Plant, passes: RandomPasses, lead_s: float, farthest: int) -> None:
    loop = close_loop(plant_52t, 5)
    controller = replace(energy_rule(loop, 3.0, 4, 0.8, 0.15, lead_s, 0.15), farthest=farthest)
    sample = assert_same(loop, controller, loop.draws(passes))
    assert sample.switchings.mean() > 3.0


def wavy_table(plant: Plant, target_m_s: float) -> ControllerTable:
    """A table of cubics that are close to each other, so that commands are many."""
    stages = []
    for k in range(plant.top_stage + 1):
        lower, upper = ([target_m_s + shift + 0.1 * k, 0.03, -0.003, 4e-5] for shift in (0.0, 0.3))
        stages.append(
            Stage(
                k,
                plant.position.stage_pressures_kpa[k],
                round_coefficients(np.array(lower)) if k > 0 else None,
                round_coefficients(np.array(upper)) if k < plant.top_stage else None,
            )
        )
    narrow = ValidRange((1.0, plant.exit_m - 2.0), (0.3, 9.0))  # than the position: the ends are clamped
    return replace(make_table("wavy", plant, target_m_s), stages=tuple(stages), valid=narrow)


@pytest.mark.parametrize("target_m_s", [2.0, 4.0])
def test_tables(plant_52t: Plant, passes: RandomPasses, target_m_s: float) -> None:
    loop = close_loop(plant_52t, 5)
    controller = TableController(wavy_table(plant_52t, target_m_s))
    sample = assert_same(loop, controller, loop.draws(passes))
    assert sample.switchings.mean() > 5.0


@pytest.mark.parametrize("count", [1, LANES - 1, LANES, LANES + 1])
def test_any_number_of_passes(plant_52t: Plant, passes: RandomPasses, count: int) -> None:
    loop = close_loop(plant_52t, 5)
    controller = replace(relay(loop, 3.0, 3, 0.1, 0.0), lead_s=0.2)
    draws = loop.draws(passes.part(0, count))
    few = assert_same(loop, controller, draws)
    many = loop.run(controller, loop.draws(passes))
    assert few.exit_speed_m_s.tobytes() == many.exit_speed_m_s[:count].tobytes()


def test_missing_readings_and_a_sensor_without_steps(plant_52t: Plant, passes: RandomPasses) -> None:
    loop = close_loop(replace(plant_52t, sensor=replace(plant_52t.sensor, resolution_m_s=0.0)), 5)
    noise = np.where(np.arange(passes.noise_z.shape[1]) % 5 == 3, np.float32(np.nan), passes.noise_z)
    draws = loop.draws(replace(passes, noise_z=noise))
    for lead_s in (0.0, 0.4):
        assert_same(loop, energy_rule(loop, 3.0, 4, 0.8, 0.15, lead_s, 0.15), draws)


@pytest.mark.parametrize("lead_s", [0.0, 0.2])
def test_stalls_and_passes_longer_than_their_noise(plant_22t: Plant, passes: RandomPasses, lead_s: float) -> None:
    level = replace(plant_22t, profile=TrackProfile.uniform(1.5), resistance=RollingResistance(1.4, 0.2))
    loop = close_loop(level, 3)
    draws = loop.draws(passes)
    stopped = assert_same(loop, constant_lines(level, [-math.inf] * 3, [0.0, 0.0, math.inf], lead_s), draws)
    assert stopped.stalled.all()
    slow = draws._replace(entry_m_s=np.linspace(0.5, 3.0, len(passes)))
    sample = assert_same(loop, constant_lines(level, [-math.inf, 0.6, 0.6], [0.8, 0.8, math.inf], lead_s), slow)
    assert 0 < sample.stalled.sum() < len(passes)
    assert sample.transit_time_s.max() > 0.1 * passes.noise_z.shape[1]


@pytest.mark.parametrize("lead_s", [0.0, 0.2])
def test_a_creeping_cut_is_given_up(plant_22t: Plant, passes: RandomPasses, lead_s: float) -> None:
    crawl = replace(plant_22t, profile=TrackProfile.uniform(1.4), resistance=RollingResistance(1.4, 0.0))
    loop = close_loop(crawl, 3)
    draws = loop.draws(passes)
    draws = draws._replace(entry_m_s=np.full(len(passes), 0.1))
    sample = assert_same(loop, constant_lines(crawl, [-math.inf] * 3, [math.inf] * 3, lead_s), draws)
    assert sample.stalled.all()
    assert not sample.exit_speed_m_s.any()
    longest = LONGEST_PASS_S
    assert np.all((sample.transit_time_s >= longest) & (sample.transit_time_s < longest + 0.11))


def rough_estimator(plant: Plant) -> Estimator:
    """An estimator that knows the plant roughly, and not all of the path."""
    s = np.linspace(2.0, plant.exit_m - 3.0, 9)
    work = (0.1 * s + 0.01 * np.sin(s), 0.0016 * s)
    breaks, drive, brake = (tuple(float(each) for each in row) for row in (s, *work))
    return Estimator(0.05, 0.15, 0.006, 0.1, 2.0, 7, 20, 0.2, 0.5, 60.0, breaks, drive, brake)


def with_gaps(passes: RandomPasses) -> RandomPasses:
    """`passes` with missing readings: now and then, for a while, and some passes from their first sample on."""
    missing = np.random.default_rng(3).random(passes.noise_z.shape) < 0.1
    missing[:, 30:45], missing[::3, :7] = True, True
    return replace(passes, noise_z=np.where(missing, np.float32(np.nan), passes.noise_z))


# With 0.4 s the pressure changes within the period of the command, and its mean is over more parts.
@pytest.mark.parametrize(("gaps", "period_s"), [(False, 0.1), (True, 0.1), (False, 0.4)])
def test_estimators(plant_52t: Plant, passes: RandomPasses, gaps: bool, period_s: float) -> None:
    sensor = replace(plant_52t.sensor, sample_period_s=period_s)
    loop, estimator = close_loop(replace(plant_52t, sensor=sensor), 5), rough_estimator(plant_52t)
    draws = loop.draws(with_gaps(passes) if gaps else passes)
    table = TableController(replace(wavy_table(plant_52t, 3.0), estimator=estimator))
    sample = assert_same(loop, table, draws)
    assert sample.switchings.mean() > 3.0
    without = loop.run(TableController(wavy_table(plant_52t, 3.0)), draws)
    assert np.mean(sample.exit_speed_m_s != without.exit_speed_m_s) > 0.5
    for lead_s, farthest in ((0.0, 4), (0.2, 1)):
        lines = energy_rule(loop, 3.0, 4, 0.8, 0.15, lead_s, 0.15)
        assert_same(loop, replace(lines, farthest=farthest, estimator=estimator), draws)


def with_faults(passes: RandomPasses, noise_m_s: float) -> RandomPasses:
    """`passes` with missing, zero, spiky and shifted readings, alone and in spells, some from the first sample on."""
    rng = np.random.default_rng(6)
    noise_z = passes.noise_z.copy()
    errors = np.array([np.nan, -1e6, 3.0 / noise_m_s, -1.0 / noise_m_s, 0.5 / noise_m_s], dtype=np.float32)
    for row in noise_z:
        for start in rng.integers(0, 200, 8):
            spell = slice(start, start + rng.choice([1, 1, 4, 25]))
            row[spell] += rng.choice(errors)
    noise_z[::5, :3], noise_z[1::5, :3] = np.nan, -1e6
    return replace(passes, noise_z=noise_z)


@pytest.mark.parametrize("readings", [(7, 20), (1, 3), (1000, 1)], ids=["as tuned", "hasty", "trusting"])
def test_a_sensor_that_fails_in_every_way(plant_52t: Plant, passes: RandomPasses, readings: tuple[int, int]) -> None:
    loop, (frozen, doubted) = close_loop(plant_52t, 5), readings
    rough = replace(rough_estimator(plant_52t), frozen_readings=frozen, doubted_readings=doubted)
    cautious = replace(rough, lost_speed_std_m_s=0.05)
    good = loop.draws(passes)
    draws = loop.draws(with_faults(passes, plant_52t.sensor.noise_m_s))
    for estimator in (rough, cautious):
        table = TableController(replace(wavy_table(plant_52t, 3.0), estimator=estimator))
        sample = assert_same(loop, table, draws)
        assert np.mean(sample.exit_speed_m_s != loop.run(table, good).exit_speed_m_s) > 0.8
        lines = energy_rule(loop, 3.0, 4, 0.8, 0.15, 0.2, 0.15)
        assert_same(loop, replace(lines, estimator=estimator), draws)


@pytest.mark.parametrize("estimating", [False, True])
def test_a_radar_that_loses_readings(plant_22t: Plant, passes: RandomPasses, estimating: bool) -> None:
    """Also in passes that are longer than their noise, and with bursts that need more numbers than these."""
    for share, burst_s in ((1.0 / 3.0, 0.6), (0.5, 9.0)):
        sensor = replace(plant_22t.sensor, missed_share=share, missed_burst_s=burst_s)
        slow = replace(plant_22t, sensor=sensor, entry=EntrySpeed(0.4, 3.0), profile=TrackProfile.uniform(1.7))
        table = wavy_table(slow, 1.0)
        loop = close_loop(slow, len(table.stages))
        draws = loop.draws(passes)
        assert draws.noise_z.shape[1] == (256 if burst_s < 1.0 else 768)
        controller = TableController(replace(table, estimator=rough_estimator(slow)) if estimating else table)
        sample = assert_same(loop, controller, draws)
        assert sample.transit_time_s.max() > 26.0
        heard = loop.run(controller, draws._replace(noise_z=fixed(passes.noise_z, np.float32)))
        assert np.mean(heard.transit_time_s != sample.transit_time_s) > 0.3


def few_exits(laws_of: Callable[[ClosedLoop], tuple[Regulator, ...]]) -> str:
    """Bytes of what twelve passes of the default book do under each law."""
    _, plant = load_config(None).plants()[-1]  # all five stages
    loop, rng, n = close_loop(plant, plant.top_stage + 1), np.random.default_rng(5), 12
    entry_u, phase_u, resistance_u = (rng.random(n) for _ in range(3))
    path_z, noise_z = (rng.standard_normal((n, 512), dtype=np.float32) for _ in range(2))
    cut_z = rng.standard_normal(n)
    draws = loop.draws(RandomPasses(cut_z, entry_u, phase_u, resistance_u, path_z, noise_z, np.arange(n), np.ones(n)))
    return "".join(array.tobytes().hex() for law in laws_of(loop) for array in vars(loop.run(law, draws)).values())


def laws_at_rest(loop: ClosedLoop) -> tuple[Regulator, ...]:
    table = TableController(wavy_table(loop.plant, 3.0))
    observing = TableController(replace(table.table, estimator=rough_estimator(loop.plant)))
    return table, observing, relay(loop, 3.0, 3, 0.1, 0.0), energy_rule(loop, 3.0, 4, 0.8, 0.15, 0.3, 0.15)


def without_compiler(laws: str) -> str:
    """`few_exits` of a function of the tests of `synth`, in a process that compiles nothing."""
    module, _, name = laws.rpartition(".")
    program = (
        "from tests.synth.test_closed_loop_lanes import few_exits\n"
        f"from tests.synth.{module} import {name}\nprint(few_exits({name}))"
    )
    plain = subprocess.run(
        [sys.executable, "-c", program], env={**os.environ, "NUMBA_DISABLE_JIT": "1"},
        capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    assert plain.returncode == 0, plain.stderr
    return plain.stdout.strip()


def test_the_kernels_mean_the_same_without_the_compiler() -> None:
    assert without_compiler("test_closed_loop_lanes.laws_at_rest") == few_exits(laws_at_rest)
