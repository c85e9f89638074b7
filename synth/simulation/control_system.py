"""The nominal loop as python-control systems: mean friction, mean resistance, no noise.

What python-control can represent is exact here, the rest is stated:

- motion and pneumatic drive are continuous `nlsys`, connected by `interconnect` (`nominal_loop`);
- the sampled, stage-locked regulator is a discrete-time `nlsys` (`regulator_system`). python-control refuses to
  connect systems of different timebases, so `nominal_response` closes the loop itself: at every sample it asks
  the regulator, between samples it lets `input_output_response` integrate the loop;
- python-control has no exact dead time, and its input is linear between time points. Valve and computing
  delays are therefore instants at which the valve position changes, and each stretch of constant valve
  position is integrated by itself: nothing is smeared, no short pulse is skipped;
- which valve opens when, the relay of the stage pressure decides; `Pneumatics.respond` states that law once, and
  its instants are used. The pressure itself is integrated by python-control and not taken from there.

So this is a second computation of a pass, by a general ODE solver; the simulator of `synth.simulation.closed_loop` is
the first. What they share is the law of the regulator, its transients' durations and the path coefficients.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant, PressureHistory, path_breaks_m, path_coefficients
from plant_models.frozen_arrays import frozen_arrays
from plant_models.stage_regulator import Actuator, stage_locked_actuator
from synth.kernels.loop import closed_loop as kernel
from synth.kernels.loop import regulator
from synth.simulation.closed_loop import Controller

if TYPE_CHECKING:
    from control import DescribingFunctionResponse, InterconnectedSystem, NonlinearIOSystem

    from synth.book.comparison.limit_cycle import LimitCycle

CLOSED = 0.0
"""Valve position, the input of the drive, that holds the pressure; +1 supplies, −1 exhausts."""

OUTPUT_STEP_S = 0.01
"""Longest time between points of a response."""

SOLVER = {"method": "RK45", "rtol": 1e-7, "atol": 1e-8, "max_step": 0.02}
"""For `solve_ivp`; `max_step` keeps the solver from stepping over a change of N(s)."""


@frozen_arrays
@dataclass(frozen=True, eq=False)
class NominalResponse:
    """One nominal pass, arrays of shape (points,), from the entrance to the exit or to the stall.

    `stage` is the commanded stage, `pressure_kpa` the gauge pressure in the cylinders.
    """

    time_s: NDArray[np.float64]
    path_m: NDArray[np.float64]
    speed_m_s: NDArray[np.float64]
    pressure_kpa: NDArray[np.float64]
    stage: NDArray[np.int64]
    stalled: bool

    @property
    def exit_speed_m_s(self) -> float:
        """Speed at the exit; 0 after a stall."""
        return 0.0 if self.stalled else float(self.speed_m_s[-1])

    @property
    def commands(self) -> tuple[tuple[float, int], ...]:
        """(time of the sample in s, stage commanded) of every change of stage."""
        changed = np.flatnonzero(np.diff(self.stage)) + 1
        return tuple((float(self.time_s[i]), int(self.stage[i])) for i in changed)


def motion_system(plant: Plant) -> NonlinearIOSystem:
    """Motion of the cut: input p (kPa gauge), states and outputs s (m), v (m/s).

    Parameters of the system: `friction` ξ (1) and `resistance_n_kn` w (the class's mean). A cut at rest stays
    where it is; outside [0, S_exit] the nearest path cell goes on.
    """
    import control  # start-up: python-control only where it is needed

    edges = path_breaks_m(plant.position, plant.cut, plant.profile)
    path = path_coefficients(plant.position, plant.cut, plant.profile, edges)
    inner, gravity, brake = edges[1:-1].tolist(), path.gravity_m_s2.tolist(), path.brake_m_s2_per_kpa.tolist()
    touch = plant.position.force.touch_pressure_kpa

    def derivatives(t: float, x: Any, u: Any, params: dict[str, float]) -> list[float]:
        s, v = x
        cell = bisect_right(inner, s)
        drag = path.resistance_m_s2_per_n_kn * params["resistance_n_kn"]
        a = gravity[cell] - drag - params["friction"] * brake[cell] * max(0.0, u[0] - touch)
        return [0.0, 0.0] if v <= 0.0 else [v, a]

    return control.nlsys(
        derivatives,
        None,
        inputs=["p"],
        outputs=["s", "v"],
        states=["s", "v"],
        params={"friction": 1.0, "resistance_n_kn": plant.resistance.mean_n_per_kn},
        name="motion",
    )


def drive_system(plant: Plant) -> NonlinearIOSystem:
    """Pneumatic drive (zhukovitsky-2012): input valve in [−1, 1], state and output p (kPa gauge).

    Valve +1: dp/dt = (P_max − p)/T_fill; −1: dp/dt = (P_min − p)/T_exh; 0: p holds; in proportion between.
    Valve delays are not in it: they belong to the instants at which the input changes.
    """
    import control

    air = plant.position.pneumatics

    def derivatives(t: float, x: Any, u: Any, params: dict[str, float]) -> list[float]:
        fill = max(0.0, u[0]) * (air.supply_pressure_kpa - x[0]) / air.fill_time_constant_s
        return [fill + max(0.0, -u[0]) * (air.exhaust_pressure_kpa - x[0]) / air.exhaust_time_constant_s]

    return control.nlsys(derivatives, None, inputs=["valve"], outputs=["p"], states=["p"], name="drive")


def nominal_loop(plant: Plant) -> InterconnectedSystem:
    """Drive and motion connected: input valve, outputs s, v, p, state (s, v, p). The regulator closes it."""
    import control

    systems = [motion_system(plant), drive_system(plant)]
    return control.interconnect(systems, inputs=["valve"], outputs=["s", "v", "p"], name="nominal_loop")


def regulator_system(plant: Plant, controller: Controller) -> NonlinearIOSystem:
    """The stage-locked regulator as a discrete-time system of the sensor's sampling period.

    Inputs s (m) and v (m/s, true; it is quantised here), output the commanded stage. States: stage, resting
    mode (index of `Actuator`), samples for which it is still locked, filtered slope (m/s²), last measured
    speed (−1 before the first sample). All start at 0 but the last.
    """
    import control

    actuator = regulated_actuator(plant, controller)
    period = plant.sensor.sample_period_s
    sensor = regulator.Sensor(period, 0.0, plant.sensor.resolution_m_s)
    law = controller.law()
    gain = period / (period + law.filter_s)

    def filtered_slope(x: Any, measured: float) -> float:
        slope, last = float(x[3]), float(x[4])
        return slope if last < 0.0 else slope + gain * ((measured - last) / period - slope)

    def stage_wanted(t: float, x: Any, u: Any, params: dict[str, float]) -> list[int]:
        stage, top = int(x[0]), actuator.stages - 1
        if x[2] > 0:
            return [stage]
        measured = regulator.measure(float(u[1]), 0.0, sensor)
        if law.coefficients.shape[0] > 0:
            step = regulator.table_decision(law.coefficients, law.has_line, law.valid, stage, float(u[0]), measured)
            return [min(max(stage + step, 0), top)]
        ahead = measured + law.lead_s * filtered_slope(x, measured)
        lines = (law.lower, law.upper, law.spacing_m, law.multi_step)
        return [regulator.stage_by_lines(*lines, stage, top, float(u[0]), ahead)]

    def next_state(t: float, x: Any, u: Any, params: dict[str, float]) -> list[float]:
        [wanted] = stage_wanted(t, x, u, params)
        mode, locked = int(x[1]), int(x[2])
        if wanted != int(x[0]):
            chain = actuator.command[mode, wanted]
            mode, locked = int(actuator.chain_mode[chain]), int(actuator.chain_samples[chain])
        measured = regulator.measure(float(u[1]), 0.0, sensor)
        return [wanted, mode, max(0, locked - 1), filtered_slope(x, measured), measured]

    return control.nlsys(
        next_state,
        stage_wanted,
        inputs=["s", "v"],
        outputs=["stage"],
        states=["stage", "mode", "locked", "slope", "last"],
        dt=period,
        name="regulator",
    )


def regulated_actuator(plant: Plant, controller: Controller) -> Actuator:
    """Modes and chains for as many stages as the controller has."""
    return stage_locked_actuator(plant.position, plant.sensor, controller.stages - 1, 1)


def nominal_response(plant: Plant, controller: Controller, entry_speed_m_s: float, phase_s: float) -> NominalResponse:
    """The nominal pass of `plant` under `controller`, released at the entrance.

    `phase_s`: time of the first sample after the entrance, 0 … sampling period. Friction is 1, resistance the
    class's mean; the sensor quantises but has no noise.
    """
    loop, regulator = nominal_loop(plant), regulator_system(plant, controller)
    rests_kpa = regulated_actuator(plant, controller).mode_pressure_kpa
    position, sensor = plant.position, plant.sensor
    memory = np.array([0.0, 0.0, 0.0, 0.0, -1.0])
    schedule = [(-np.inf, CLOSED)]
    points = played(loop, np.array([0.0, entry_speed_m_s, rests_kpa[0]]), 0.0, phase_s, schedule)
    stages = [np.zeros(points.shape[1])]
    parts, sample = [points], 0
    while points[1, -1] < plant.exit_m and points[2, -1] > 0.0 and points[0, -1] < kernel.LONGEST_PASS_S:
        now, state = phase_s + sample * sensor.sample_period_s, points[1:, -1]
        wanted = int(regulator.output(now, memory, state[:2])[0])
        if wanted != int(memory[0]):
            history = position.pneumatics.respond(
                rests_kpa[int(memory[1])], position.stage_pressures_kpa[wanted], position.force.touch_pressure_kpa
            )
            schedule = valve_schedule(history, now + sensor.computing_delay_s)
        memory = regulator.dynamics(now, memory, state[:2])
        sample += 1
        points = played(loop, state, now, phase_s + sample * sensor.sample_period_s, schedule)
        parts.append(points)
        stages.append(np.full(points.shape[1], wanted))
    return to_the_end(np.hstack(parts), np.concatenate(stages), plant.exit_m)


def valve_schedule(history: PressureHistory, command_s: float) -> list[tuple[float, float]]:
    """(instant in s, valve position from then on) after a command that reaches the valves at `command_s`."""
    valves = np.sign(history.asymptotes_kpa - history.pressures_kpa)
    return [(-np.inf, CLOSED), *zip(command_s + history.starts_s, valves, strict=True)]


def played(
    loop: InterconnectedSystem,
    state: NDArray[np.float64],
    start_s: float,
    end_s: float,
    schedule: list[tuple[float, float]],
) -> NDArray[np.float64]:
    """Response from `start_s` to `end_s`, columns (time, s, v, p), one stretch of constant valve position at a time."""
    import control

    cuts = [start_s, *(t for t, _ in schedule if start_s < t < end_s), end_s]
    parts = [np.append(start_s, state)[:, None]]
    for start, stop in pairwise(cuts):
        if stop - start < 1e-12:
            continue
        valve = next(position for t, position in reversed(schedule) if t <= start)
        times = np.linspace(start, stop, max(2, math.ceil((stop - start) / OUTPUT_STEP_S) + 1))
        response = control.input_output_response(
            loop, times, np.full((1, times.size), valve), state, solve_ivp_kwargs=SOLVER
        )
        state = response.states[:, -1]
        parts.append(np.vstack([times, response.states])[:, 1:])
    return np.hstack(parts)


def to_the_end(points: NDArray[np.float64], stages: NDArray[np.float64], exit_m: float) -> NominalResponse:
    """The response cut off at the exit, where v² is linear in s between two points, or at the stall."""
    time, path, speed, pressure = points
    stalled = bool(path[-1] < exit_m)
    last = int(np.argmax(speed <= 0.0)) if stalled and speed[-1] <= 0.0 else len(path) - 1
    if not stalled:
        last = int(np.argmax(path >= exit_m))
        share = (exit_m - path[last - 1]) / (path[last] - path[last - 1])
        exit_speed = math.sqrt((1.0 - share) * speed[last - 1] ** 2 + share * speed[last] ** 2)
        time[last] = time[last - 1] + 2.0 * (exit_m - path[last - 1]) / (speed[last - 1] + exit_speed)
        path[last], speed[last] = exit_m, exit_speed
    time, path, speed, pressure = points[:, : last + 1].copy()
    return NominalResponse(time, path, speed, pressure, stages[: last + 1].astype(np.int64), stalled)


def describing_function_analysis(cycle: LimitCycle) -> DescribingFunctionResponse:
    """python-control's own analysis, to plot: relay with hysteresis, exact dead time, integrator.

    It knows one amplitude and one delay: both stages count as (rise + fall)/2 and both changes as delayed by
    the mean. The dead time is exact because the loop is given as frequency response data.
    """
    import control

    height, edge = 0.5 * (cycle.rise_m_s2 + cycle.fall_m_s2), 0.5 * max(0.0, cycle.gap_m_s)
    delay = 0.5 * (cycle.brake_delay_s + cycle.release_delay_s)
    fastest = 0.5 * math.pi / delay
    slowest = 0.5 * math.pi / (delay + edge * math.pi**2 / (8.0 * height))  # as arccos lies above its chord
    omega = np.linspace(0.9 * slowest, 1.1 * fastest, 400)
    loop = control.frd(np.exp(-1j * omega * delay) / (1j * omega), omega, smooth=True)
    largest = 4.0 * height / (math.pi * omega[0])
    amplitudes = np.linspace(max(1.0001 * edge, 0.1 * largest), 1.1 * largest, 80)
    relay = control.relay_hysteresis_nonlinearity(height, edge)
    return control.describing_function_response(loop, relay, amplitudes, omega=omega)
