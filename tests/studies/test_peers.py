"""The peers of a table: their loop is the simulator's, what they foresee happens, and they do what their rule says."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import pytest
from numba import njit

from plant_models import Plant
from scripts.studies.peers.kernels.peer_loop import BY_TABLE, Peer
from scripts.studies.peers.kernels.prediction import Prediction, held, line_square, stage_by_prediction
from scripts.studies.peers.kernels.pulses import STATE, Pulses, begin_pulses, stage_by_pulses
from scripts.studies.peers.peer_loop import (
    NO_PREDICTION,
    NO_PULSES,
    PeerLoop,
    PredictiveController,
    PulseController,
    no_table,
    peer_loop,
)
from scripts.studies.peers.peer_tuning import PREDICTIVE as PREDICTIVE_FAMILY
from scripts.studies.peers.peer_tuning import Aimed, cost_of
from synth.kernels.any_time.any_time_law import AnyTimeLaw
from synth.kernels.loop.passes import Draws
from synth.retarder.estimation.estimator_design import estimator_of
from synth.simulation.closed_loop import ClosedLoop, Controller, LineController, TableController
from synth.simulation.common_passes import CommonPasses, common_passes
from synth.simulation.controllers import fixed
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.any_time.polynomial_surfaces import CUBIC_AND_SLOPE, PolynomialSurfaces
from synth.solver.switching_lines import SwitchingLines
from tests.synth.any_time.conftest import tabled
from tuning_tables import Decisions

AIM_M_S = 3.0


@pytest.fixture(scope="module")
def passes(plant_52t: Plant) -> CommonPasses:
    return common_passes(plant_52t, stratified_passes(3, 0, 400))


@pytest.fixture(scope="module")
def loop(passes: CommonPasses) -> PeerLoop:
    return peer_loop(passes.loop(passes.plant.top_stage + 1))


def falling_lines(plant: Plant) -> LineController:
    """Lines for the estimated speed, with much to do."""
    s = np.linspace(plant.start_m, plant.exit_m, 80)
    middle = AIM_M_S + 1.2 * (1.0 - s / plant.exit_m) ** 2 + 0.1 * np.arange(plant.top_stage + 1)[:, None]
    lower, upper = middle - 0.03, middle + 0.03
    lower[0], upper[-1] = -np.inf, np.inf
    return LineController(SwitchingLines(s, lower, upper), estimator=estimator_of(plant))


def surfaces(plant: Plant) -> TableController:
    """A table for commands at any time, whose lines depend on the pressure."""
    count = plant.top_stage + 1
    coefficients = np.zeros((count, 2, 5))
    coefficients[:, :, 0] = AIM_M_S + np.array([0.15, 0.3])
    coefficients[:, :, 1], coefficients[:, :, 4] = -0.25, 0.06
    has_line = np.ones((count, 2), dtype=np.bool_)
    has_line[0, 0], has_line[-1, 1] = False, False
    pressures = np.asarray(plant.position.stage_pressures_kpa[:count])
    found = PolynomialSurfaces(plant.start_m, plant.exit_m, pressures, CUBIC_AND_SLOPE, coefficients, has_line)
    return tabled(plant, found, estimator_of(plant))


CONTROLLERS: dict[str, Callable[[Plant], Controller]] = {
    "lines at rest": falling_lines,
    "lines at any time": lambda plant: replace(falling_lines(plant), decisions=Decisions.AT_ANY_TIME, farthest=1),
    "a table at any time": surfaces,
}


@dataclass(frozen=True)
class TableAsPeer:
    """A table or lines in the loop of the peers."""

    controller: TableController | LineController

    def peer(self, loop: ClosedLoop) -> Peer:
        """The regulator as the kernel takes it; this loop knows no lead."""
        rule, law = self.controller.rule, self.controller.law()
        at_rest = not isinstance(law, AnyTimeLaw)
        table = law if isinstance(law, AnyTimeLaw) else no_table()._replace(rule=rule)
        return Peer(BY_TABLE, table, NO_PREDICTION, NO_PULSES, at_rest, rule.table)


@pytest.mark.long
@pytest.mark.parametrize("make", CONTROLLERS.values(), ids=CONTROLLERS)
def test_with_a_table_the_loop_is_the_simulator_bit_for_bit(
    make: Callable[[Plant], Controller], passes: CommonPasses, loop: PeerLoop
) -> None:
    controller = make(passes.plant)
    expected, found = passes.run(controller), loop.run(TableAsPeer(controller), passes.draws)
    assert expected.switchings.mean() > 4.0
    for name in ("exit_speed_m_s", "transit_time_s", "switchings", "stalled"):
        assert np.array_equal(getattr(found, name), getattr(expected, name))


def as_known(passes: CommonPasses, factor: float = 1.0) -> Draws:
    """The same cuts with mean resistance, this friction, none of its noise along the path, and a sensor without any."""
    loop, law = passes.loop(passes.plant.top_stage + 1), passes.plant.resistance
    draws, count = passes.draws, len(passes)
    brake = factor * np.tile(loop.path.brake_m_s2_per_kpa, (count, 1))
    return draws._replace(
        cut_factor=fixed(np.full(count, factor), np.float64),
        resistance_n_kn=fixed(np.full(count, law.mean_n_per_kn), np.float64),
        path_z=fixed(np.zeros_like(draws.path_z), np.float32),
        noise_z=fixed(np.zeros_like(draws.noise_z), np.float32),
        brake_m_s2_per_kpa=fixed(brake, np.float64),
    )


@njit
def foresee(path, drive, period, horizon, old, new, pressure, factor, cell, s, v, parts):  # type: ignore[no-untyped-def]
    return held(path, drive, period, horizon, old, new, pressure, 0.0, factor, (cell, s, v), np.empty(parts))


@njit
def choose(law, path, drive, period, stage, pressure, factor, cell, s, v):  # type: ignore[no-untyped-def]
    over = np.empty(law.parts)
    return stage_by_prediction(law, path, drive, period, stage, pressure, 0.0, factor, cell, s, v, over)


@njit
def line(path, aim, kpa, cell, s):  # type: ignore[no-untyped-def]
    return line_square(path, aim, kpa, cell, s)


def commanding_once(plant: Plant, stage: int) -> LineController:
    """Commands `stage` at the first sample, and nothing more."""
    lower, upper = np.full((plant.top_stage + 1, 2), -np.inf), np.full((plant.top_stage + 1, 2), np.inf)
    upper[:stage] = 0.0
    return LineController(SwitchingLines(np.array([plant.start_m, plant.exit_m]), lower, upper))


@pytest.mark.parametrize("stage", [1, 2, 4])
@pytest.mark.parametrize("factor", [0.8, 1.2])
def test_what_is_foreseen_happens_in_the_mean_plant(
    stage: int, factor: float, passes: CommonPasses, loop: PeerLoop
) -> None:
    """With the steps of the simulation to rounding; with a step a period within 2 mm/s, and ever nearer."""
    plant = passes.plant
    assert plant.start_m == 0.0
    draws = as_known(passes.first(1), factor)
    trace = passes.loop(plant.top_stage + 1).follow(commanding_once(plant, stage), draws)
    first = int(np.argmax(~np.isnan(trace.measured_m_s)))
    s, v, stages = float(trace.path_m[first]), float(trace.speed_m_s[first]), loop.hardware.sampled
    cell = int(np.searchsorted(loop.path.edges_m, s, side="right")) - 1
    period = loop.hardware.sensor.period_s

    def foreseen(parts: int) -> float:
        start = stages.initial_stage, stage, stages.initial_kpa, factor, cell, s, v
        _, _, speed, _ = foresee(loop.path, stages, period, 100.0, *start, parts)
        return float(speed)

    exact = float(trace.speed_m_s[-1])
    assert foreseen(stages.parts) == pytest.approx(exact, abs=1e-9)
    errors = [abs(foreseen(parts) - foreseen(64)) for parts in (1, 4)]
    assert errors[0] < 2e-3
    assert errors[1] < 0.25 * errors[0] + 1e-9


def test_the_energy_line_leads_to_the_aim(loop: PeerLoop) -> None:
    """Rolling on from the line at its overpressure, valves at rest, ends at the aim."""
    for stage, factor, cell in [(1, 1.0, 3), (2, 0.8, 10), (3, 1.3, 17)]:
        pressure = float(loop.hardware.sampled.stage_kpa[stage])
        kpa = pressure - loop.hardware.sampled.valves.touch_kpa
        s = 0.4 * loop.path.edges_m[cell] + 0.6 * loop.path.edges_m[cell + 1]
        v = math.sqrt(line(loop.path, 2.7, factor * kpa, cell, s))
        start = stage, stage, pressure, factor, cell, float(s), v
        end, place, speed, _ = foresee(loop.path, loop.hardware.sampled, 0.1, 100.0, *start, 1)
        assert (end, place) == (len(loop.path.free_m_s2), loop.path.edges_m[-1])
        assert speed == pytest.approx(2.7, abs=1e-9)


def test_the_stage_of_least_cost_is_taken(loop: PeerLoop) -> None:
    """Against costs that are worked out here, from where each stage leads; a price too high keeps the stage."""
    rng = np.random.default_rng(7)
    drive, count, changed = loop.hardware.sampled, len(loop.hardware.sampled.stage_kpa), 0
    for _ in range(60):
        stage, cell = int(rng.integers(count)), int(rng.integers(2, len(loop.path.free_m_s2) - 1))
        s, v, factor = float(loop.path.edges_m[cell]), float(rng.uniform(2.5, 6.0)), float(rng.uniform(0.7, 1.3))
        law = Prediction(0.73, 90.0, AIM_M_S, float(rng.choice([0.0, 0.5])), 2)
        costs = np.empty(count)
        for new in range(count):
            start = stage, new, float(drive.stage_kpa[stage]), factor, cell, s, v
            end, place, speed, _ = foresee(loop.path, drive, 0.1, law.horizon_s, *start, law.parts)
            wanted = line(loop.path, AIM_M_S, factor * law.held_kpa, end, place)
            costs[new] = (speed**2 - wanted) ** 2 + (law.price_m2_s2**2 if new != stage else 0.0)
        state = stage, float(drive.stage_kpa[stage]), factor, cell, s, v
        taken = choose(law, loop.path, drive, 0.1, *state)
        assert costs[taken] == pytest.approx(costs.min(), rel=1e-12)
        changed += taken != stage
        assert choose(law._replace(price_m2_s2=1e3), loop.path, drive, 0.1, *state) == stage
    assert changed > 20


@njit
def pulsed(law, path, sample_s, stage, cell, s, v, count):  # type: ignore[no-untyped-def]
    state, found = np.empty(STATE), np.empty(count, np.int64)
    begin_pulses(state)
    for i in range(count):
        stage = stage_by_pulses(law, path, sample_s, stage, cell, s, v, state)
        found[i] = stage
    return found


def test_pulses_make_the_overpressure_that_is_wanted(loop: PeerLoop) -> None:
    """On the line the PI adds nothing: the mean overpressure of two neighbouring stages is that of even braking."""
    kpa = np.array([0.0, 50.0, 110.0, 180.0])
    law = Pulses(80.0, AIM_M_S, 100.0, 2.0, 2.0, fixed(kpa, np.float64))
    s = float(loop.path.edges_m[5])
    v = math.sqrt(line(loop.path, AIM_M_S, law.held_kpa, 5, s))
    stages = pulsed(law, loop.path, 0.1, 0, 5, s, v, 200)
    assert set(stages.tolist()) == {1, 2}
    assert kpa[stages].mean() == pytest.approx(law.held_kpa, abs=1e-9)
    assert np.count_nonzero(np.diff(stages)) <= 11  # a period begins with the stage that is there
    assert set(pulsed(law, loop.path, 0.1, 0, 5, s, v + 5.0, 20).tolist()) == {3}
    assert set(pulsed(law, loop.path, 0.1, 3, 5, s, v - 2.0, 20).tolist()) == {0}


def test_the_integral_finds_a_lasting_error(loop: PeerLoop) -> None:
    """A speed that stays above the line by e asks for gain·e·t/T more after t, and no more than the highest stage."""
    kpa = np.linspace(0.0, 300.0, 31)
    law = Pulses(80.0, AIM_M_S, 100.0, 2.0, 0.1, fixed(kpa, np.float64))
    s = float(loop.path.edges_m[5])
    v = math.sqrt(line(loop.path, AIM_M_S, law.held_kpa, 5, s))
    stages = pulsed(law, loop.path, 0.1, 8, 5, s, v + 0.2, 41)
    assert kpa[stages[-1]] == pytest.approx(80.0 + 100.0 * (0.2 + 0.2 * 4.0 / 2.0), abs=10.0)


def test_the_cost_of_a_peer_is_that_of_the_tables(passes: CommonPasses, loop: PeerLoop) -> None:
    estimator = estimator_of(passes.plant)
    sample = loop.run(PREDICTIVE_FAMILY.build(AIM_M_S, Decisions.AT_REST, estimator, 0.8, 0.2, 0.0, 0.1), passes.draws)
    aimed = Aimed(AIM_M_S, 1e-3, Decisions.AT_REST, estimator)
    square = (sample.exit_speed_m_s - AIM_M_S) ** 2
    weight = sample.weight / sample.weight.sum()
    assert cost_of(sample, aimed) == pytest.approx(weight @ square + 1e-3 * (weight @ sample.switchings))


def test_a_sensor_without_readings_moves_nothing(passes: CommonPasses, loop: PeerLoop) -> None:
    """A missing reading is no standstill: neither peer commands before the first reading."""
    silent = passes.draws._replace(noise_z=fixed(np.full_like(passes.draws.noise_z, np.nan), np.float32))
    estimator: Any = estimator_of(passes.plant)
    for regulator in (
        PredictiveController(AIM_M_S, Decisions.AT_ANY_TIME, estimator, 0.8, 0.2, 0.0, 0.0),
        PulseController(AIM_M_S, Decisions.AT_ANY_TIME, None, 0.2, 2.0, 3.0, 0.3),
    ):
        assert (loop.run(regulator, silent).switchings == 0).all()
