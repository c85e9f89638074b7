"""The nominal pass, mean friction, mean resistance, no noise: by the simulator, and a second computation of it by
python-control; and how far they are apart.

- At every sample the regulator is asked; between samples `input_output_response` integrates the loop.
- python-control has no exact dead time, and its input is linear between time points. Valve and computing delays are
  therefore instants at which the valve position changes, and each stretch of constant valve position is integrated by
  itself: nothing is smeared, no short pulse is skipped.
- Which valve opens when, the relay of the stage pressure decides; `Pneumatics.respond` states that law once, and its
  instants are used. The pressure itself is integrated by python-control and not taken from there.

The simulator of `synth.simulation.closed_loop` is the first computation. Both share the law of the regulator, the
durations of its transients and the path coefficients.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from plant_models import Plant, RetarderPosition, RollingResistance
from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from plant_models.pressure_regulator import overpressure_kpa
from plant_models.stage_regulator import reaches_valves_s
from synth.kernels.loop.passes import LONGEST_PASS_S
from synth.simulation.closed_loop import Controller, trace
from synth.simulation.control_system import (
    ImpulseTrain,
    held,
    nominal_loop,
    regulated_actuator,
    regulator_start,
    regulator_system,
    resting_train,
)
from synth.simulation.passes import PassTrace
from synth.simulation.random_passes import NOISE_SAMPLES, PATH_CELLS, RandomPasses

if TYPE_CHECKING:
    from control import InterconnectedSystem


def nominal_plant(plant: Plant) -> Plant:
    """`plant` without chance: every cut has the mean friction and resistance, the sensor only quantises."""
    return replace(
        plant,
        friction=replace(plant.friction, common_cv=0.0, axle_cv=0.0, path_std=0.0),
        resistance=RollingResistance(plant.resistance.mean_n_per_kn, 0.0),
        sensor=replace(plant.sensor, noise_m_s=0.0, missed_share=0.0),
    )


def nominal_entry_m_s(plant: Plant, entry_u: float) -> float:
    """The entry speed below which the share `entry_u` (0 … 1) of all cuts enter."""
    return float(plant.entry.speed_m_s(np.array([entry_u]))[0])


def nominal_pass(plant: Plant, controller: Controller, entry_u: float, phase_u: float) -> PassTrace:
    """The nominal pass event by event; entry as in `nominal_entry_m_s`, first sample after `phase_u` of a period."""
    return trace(nominal_plant(plant), controller, one_pass(entry_u, phase_u), 0)


def one_pass(entry_u: float, phase_u: float) -> RandomPasses:
    """A single pass with entry speed and phase as given, and the mean of everything else."""
    one = np.ones(1)
    return RandomPasses(
        cut_z=np.zeros(1),
        entry_u=entry_u * one,
        phase_u=phase_u * one,
        resistance_u=0.5 * one,
        path_z=np.zeros((1, PATH_CELLS), dtype=np.float32),
        noise_z=np.zeros((1, NOISE_SAMPLES), dtype=np.float32),
        loss_key=np.zeros(1, dtype=np.int64),
        weight=one,
    )


CLOSED = 0.0
"""Valve position, the input of the drive, that holds the pressure; +1 supplies, −1 exhausts."""

OUTPUT_STEP_S = 0.01
"""Longest time between points of a response."""

SAME_SAMPLE_S = 1e-6
"""Commands nearer to each other than this belong to one sample."""

SAME_PASSAGE_S = 1e-3
"""And to one passage: the time of a passage depends on the motion before it, that of a sample does not."""

SOLVER = {"method": "RK45", "rtol": 1e-9, "atol": 1e-10, "max_step": 0.02}
"""For `solve_ivp`; `max_step` keeps the solver from stepping over a change of N(s)."""


@frozen_arrays
class NominalResponse:
    """One nominal pass, arrays of shape (points,), from where the regulator acts to the exit or to the stall.

    `stage` is the commanded stage, `pressure_kpa` the gauge pressure in the cylinders.
    """

    time_s: Floats
    path_m: Floats
    speed_m_s: Floats
    pressure_kpa: Floats
    stage: Ints
    stalled: bool

    @property
    def exit_speed_m_s(self) -> float:
        """Speed at the exit; 0 after a stall."""
        return 0.0 if self.stalled else float(self.speed_m_s[-1])


def nominal_response(plant: Plant, controller: Controller, entry_speed_m_s: float, phase_s: float) -> NominalResponse:
    """The nominal pass of `plant` under `controller`, from where the regulator acts.

    `entry_speed_m_s` at the entrance; `phase_s`: time of the first sample after the beginning, 0 … sampling period.
    Friction is 1, resistance the class's mean; the sensor quantises but has no noise.
    """
    loop, regulator = nominal_loop(plant), regulator_system(plant, controller)
    rests_kpa = regulated_actuator(plant, controller).mode_pressure_kpa
    position, sensor = plant.position, plant.sensor
    memory, over_kpa = regulator_start(plant, controller), 0.0
    initial_kpa = rests_kpa[int(memory[1])]
    start_speed = plant.start_speed_m_s(np.array(entry_speed_m_s), plant.resistance.mean_n_per_kn)
    schedule = resting_train(CLOSED)
    points = played(loop, np.array([plant.start_m, float(start_speed), initial_kpa]), 0.0, phase_s, schedule)
    stages = [np.full(points.shape[1], memory[0])]
    parts, sample = [points], 0
    while points[1, -1] < plant.exit_m and points[2, -1] > 0.0 and points[0, -1] < LONGEST_PASS_S:
        now, state = phase_s + sample * sensor.sample_period_s, points[1:, -1]
        seen = [*state[:2], over_kpa]
        wanted = int(regulator.output(now, memory, seen)[0])
        if wanted != int(memory[0]):
            command_s = reaches_valves_s(now, sensor.computing_delay_s)
            schedule = valve_schedule(position, rests_kpa[int(memory[1])], wanted, command_s)
        memory = regulator.dynamics(now, memory, seen)
        sample += 1
        points = played(loop, state, now, phase_s + sample * sensor.sample_period_s, schedule)
        over_kpa = mean_overpressure_kpa(points, position.force.touch_pressure_kpa)
        parts.append(points)
        stages.append(np.full(points.shape[1], wanted))
    return to_the_end(np.hstack(parts), np.concatenate(stages), plant.exit_m)


def mean_overpressure_kpa(points: Floats, touch_kpa: float) -> float:
    """Mean of max(0, P − P0) over the time that `points` (4, n) of a response cover."""
    time, over = points[0], overpressure_kpa(points[3], touch_kpa)
    return float(np.trapezoid(over, time) / (time[-1] - time[0]))


def valve_schedule(position: RetarderPosition, rests_kpa: float, stage: int, command_s: float) -> ImpulseTrain:
    """The valve positions, each held until the next, after a command of `stage` that reaches them at `command_s`.

    `rests_kpa`: the pressure at which the drive rests when the command is given.
    """
    history = position.pneumatics.respond(
        rests_kpa, position.stage_pressures_kpa[stage], position.force.touch_pressure_kpa
    )
    valves = np.sign(history.asymptotes_kpa - history.pressures_kpa)
    return (*resting_train(CLOSED), *zip((command_s + history.starts_s).tolist(), valves.tolist(), strict=True))


def played(loop: InterconnectedSystem, state: Floats, start_s: float, end_s: float, schedule: ImpulseTrain) -> Floats:
    """Response from `start_s` to `end_s`, columns (time, s, v, p), one stretch of constant valve position at a time."""
    import control

    cuts = [start_s, *(t for t, _ in schedule if start_s < t < end_s), end_s]
    parts = [np.append(start_s, state)[:, None]]
    for start, stop in pairwise(cuts):
        if stop - start < 1e-12:
            continue
        valve = held(schedule, start)
        times = np.linspace(start, stop, max(2, math.ceil((stop - start) / OUTPUT_STEP_S) + 1))
        response = control.input_output_response(
            loop, times, np.full((1, times.size), valve), state, solve_ivp_kwargs=SOLVER
        )
        state = response.states[:, -1]
        parts.append(np.vstack([times, response.states])[:, 1:])
    return np.hstack(parts)


def to_the_end(points: Floats, stages: Floats, exit_m: float) -> NominalResponse:
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


@dataclass(frozen=True)
class ResponseDifference:
    """Response less trace, m/s: the largest in size of the whole pass, or of its part before `parted_s`.

    `parted_s`: the first sample at which the two command different stages, None where there is none. A regulator is a
    relay: where the speed of a sample lies on a line, rounding decides, and from then on these are two passes.
    """

    largest_m_s: float
    exit_m_s: float
    parted_s: float | None


def response_difference(
    response: NominalResponse, trace: PassTrace, same_s: float = SAME_SAMPLE_S
) -> ResponseDifference:
    """`response` less `trace`, at the events of the trace; commands nearer to each other than `same_s` are one."""
    parted = parting(commands_of(response), commands_of(trace), same_s)
    time = trace.time_s
    counted = time <= min(float(response.time_s[-1]), math.inf if parted is None else parted)
    if response.stalled and trace.stalled:
        counted &= time < time[-1]  # at rest both are 0, but a response ends at one of its points shortly after
    speed = np.interp(time[counted], response.time_s, response.speed_m_s)
    apart = speed - trace.speed_m_s[counted]
    largest = float(apart[np.argmax(np.abs(apart))])
    return ResponseDifference(largest, response.exit_speed_m_s - trace.exit_speed_m_s, parted)


def commands_of(trace: NominalResponse | PassTrace) -> tuple[tuple[float, int], ...]:
    """(time of the sample in s, stage commanded) of every change of stage."""
    changed = np.flatnonzero(np.diff(trace.stage)) + 1
    return tuple((float(trace.time_s[i]), int(trace.stage[i])) for i in changed)


def parting(
    one: tuple[tuple[float, int], ...], other: tuple[tuple[float, int], ...], same_s: float = SAME_SAMPLE_S
) -> float | None:
    """Time of the first command that is not in both; None if all are."""
    for (time, stage), (later, wanted) in zip(one, other, strict=False):
        if stage != wanted or abs(time - later) > same_s:
            return min(time, later)
    rest = one[len(other) :] or other[len(one) :]
    return rest[0][0] if rest else None
