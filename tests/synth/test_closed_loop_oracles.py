"""The motion in the closed loop against an adaptive integrator, and with smaller steps."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

from plant_models import Plant, PressureHistory
from plant_models.stage_regulator import stage_locked_actuator
from synth.kernels.loop.motion import MOVING, STALLED, advance
from synth.kernels.loop.passes import Draws
from synth.simulation.closed_loop import (
    ClosedLoop,
    close_loop,
    simulate,
    trace,
)
from synth.simulation.passes import PassTrace
from synth.simulation.random_passes import RandomPasses
from tests.synth.test_closed_loop import constant_lines, energy_controller

EXIT_SPEED_TOLERANCE_M_S = 1e-4
"""Asked for is 1 mm/s."""


def test_advance_does_not_depend_on_how_time_is_divided(plant_52t: Plant) -> None:
    path = close_loop(plant_52t, 5).path
    motion = (path.edges_m, path.gravity_m_s2, path.brake_m_s2_per_kpa, 120.0)
    cell, s, v, used, status = advance(*motion, 3.0, 0, 0.0, 6.0)
    assert (used, status) == (3.0, MOVING)
    state = (0, 0.0, 6.0)
    for _ in range(30):
        *state, _, status = advance(*motion, 0.1, *state)
    assert state == pytest.approx([cell, s, v], rel=1e-12)


def test_a_stall_stops_where_the_energy_ends() -> None:
    edges, brake = np.array([0.0, 2.0, 10.0]), np.array([0.0, 0.01])
    cell, s, v, used, status = advance(edges, np.zeros(2), brake, 100.0, 60.0, 0, 0.0, 1.0)
    assert (cell, v, status) == (1, 0.0, STALLED)
    assert s == pytest.approx(2.0 + 1.0 / 2.0)
    assert used == pytest.approx(2.0 + 1.0)


def test_stall_is_counted_and_leaves_with_speed_zero(plant_22t: Plant, passes: RandomPasses) -> None:
    controller = constant_lines(plant_22t, [-math.inf] * 3, [0.0, 0.0, math.inf])  # always to the top stage
    sample = simulate(plant_22t, controller, passes.part(0, 50))
    assert sample.stalled.all()
    assert not sample.exit_speed_m_s.any()
    assert np.all((sample.transit_time_s > 1.0) & (sample.transit_time_s < 20.0))
    assert np.all(sample.switchings == 1)
    end = trace(plant_22t, controller, passes, 3)
    assert end.stalled
    assert end.exit_speed_m_s == 0.0
    assert end.path_m[-1] < plant_22t.exit_m


def pass_motion(loop: ClosedLoop, draws: Draws) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Free acceleration and brake coefficient of the only pass, with η drawn as the model says."""
    path = loop.path
    x = np.empty(path.eta_std.size)
    x[0] = draws.path_z[0, 0]
    for j in range(1, x.size):
        x[j] = path.eta_memory[j] * x[j - 1] + path.eta_fresh[j] * draws.path_z[0, j]
    free = path.gravity_m_s2 - path.drag_m_s2_per_n_kn * draws.resistance_n_kn[0]
    brake = path.brake_m_s2_per_kpa * draws.cut_factor[0] * (1.0 + path.eta_std * x)
    assert draws.brake_m_s2_per_kpa[0] == pytest.approx(brake, rel=1e-12)
    return free, brake


def commands(plant: Plant, followed: PassTrace) -> list[tuple[float, PressureHistory]]:
    """Times at which the drive gets its commands, and the pressure histories that follow."""
    actuator = stage_locked_actuator(plant.position, plant.sensor, plant.top_stage, 1)
    touch = plant.position.force.touch_pressure_kpa
    found, mode = [], 0
    for event in np.flatnonzero(np.diff(followed.stage)) + 1:
        stage = followed.stage[event]
        wanted = plant.position.stage_pressures_kpa[stage]
        history = plant.position.pneumatics.respond(float(actuator.mode_pressure_kpa[mode]), wanted, touch)
        found.append((float(followed.time_s[event]) + plant.sensor.computing_delay_s, history))
        mode = int(actuator.chain_mode[actuator.command[mode, stage]])
    return found


def kinks_s(start_s: float, history: PressureHistory, touch_kpa: float) -> list[float]:
    """Times at which a valve opens or closes or the overpressure leaves 0."""
    times = [start_s + t for t in history.starts_s]
    for t, p, end, constant in zip(
        history.starts_s, history.pressures_kpa, history.asymptotes_kpa, history.time_constants_s, strict=True
    ):
        if (p - touch_kpa) * (end - touch_kpa) < 0:
            times.append(start_s + t + constant * math.log((end - p) / (end - touch_kpa)))
    return times


def oracle_exit_speed(plant: Plant, loop: ClosedLoop, draws: Draws, followed: PassTrace) -> float:
    """Exit speed by an adaptive integrator between all switch instants, under the commands of `followed`."""
    free, brake = pass_motion(loop, draws)
    edges, touch = loop.path.edges_m, plant.position.force.touch_pressure_kpa
    orders = commands(plant, followed)
    instants = sorted({t for start, history in orders for t in kinks_s(start, history, touch)} | {0.0, 400.0})
    time, state, cell = 0.0, np.array([0.0, draws.entry_m_s[0]]), 0
    while cell < free.size:
        until = next(t for t in instants if t > time + 1e-12)
        begun = [(start, history) for start, history in orders if start <= time + 1e-12]

        def overpressure(t: float, begun: list[tuple[float, PressureHistory]] = begun) -> float:
            if not begun:
                return 0.0
            start, history = begun[-1]
            return max(0.0, float(history.pressure_kpa(np.array(max(t - start, 0.0)))) - touch)

        def rate(t: float, y: NDArray[np.float64], cell: int = cell) -> tuple[float, float]:
            return y[1], free[cell] - brake[cell] * overpressure(t)

        def edge(t: float, y: NDArray[np.float64], cell: int = cell) -> float:
            return float(y[0] - edges[cell + 1])

        edge.terminal, edge.direction = True, 1.0  # type: ignore[attr-defined]  # as scipy wants it
        # Short first steps: an event that a step jumps over twice is not seen.
        first = min(1e-3, 0.5 * (until - time))
        solved = solve_ivp(
            rate, (time, until), state, events=edge, rtol=1e-10, atol=1e-12, first_step=first, max_step=0.3
        )
        time, state = float(solved.t[-1]), solved.y[:, -1].copy()
        if solved.status == 1:
            cell += 1
            state[0] = edges[cell]
    return float(state[1])


@pytest.mark.requirement("PRED-03")
@pytest.mark.parametrize(("mass_t", "target_m_s"), [(22.0, 2.0), (52.0, 3.0)])
def test_exit_speed_agrees_with_an_adaptive_integrator(
    plant_of: Callable[[float], Plant], passes: RandomPasses, mass_t: float, target_m_s: float
) -> None:
    plant = plant_of(mass_t)
    controller = energy_controller(plant, target_m_s)
    loop = close_loop(plant, controller.stages)
    errors = []
    for i in range(10):
        draws = loop.draws(passes.part(i, i + 1))
        followed = loop.follow(controller, draws)
        errors.append(followed.exit_speed_m_s - oracle_exit_speed(plant, loop, draws, followed))
    assert max(map(abs, errors)) < EXIT_SPEED_TOLERANCE_M_S


def test_substeps_converge(plant_52t: Plant, passes: RandomPasses) -> None:
    controller = energy_controller(plant_52t, 3.0)
    part = passes.part(0, 300)

    def exits(substeps: int) -> tuple[NDArray[np.float64], NDArray[np.int32]]:
        loop = close_loop(plant_52t, 5, substeps)
        sample = loop.run(controller, loop.draws(part))
        return sample.exit_speed_m_s, sample.switchings

    reference, commands_sent = exits(160)
    errors = []
    for substeps in (5, 10, 20):
        speed, switchings = exits(substeps)
        # A sample on the edge of a line may decide otherwise: those passes are another matter.
        same = (switchings == commands_sent) & (np.abs(speed - reference) < 0.01)
        assert same.mean() > 0.97
        errors.append(float(np.sqrt(np.mean((speed - reference)[same] ** 2))))
    assert errors[1] < 0.2 * EXIT_SPEED_TOLERANCE_M_S
    assert errors[0] > 2.5 * errors[1] > 6.0 * errors[2]  # second order, but for kinks within a substep
