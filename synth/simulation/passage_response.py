"""The nominal pass with point sensors by python-control: a second computation of what the simulator does.

As in `nominal_response`, each stretch of constant valve position is integrated by itself. The impulse element
quantises by path: the loop is integrated until the first axle reaches the next coil, and the time of that is found by
Newton's method on the integrated path. At a second coil the regulator is asked.

The simulator of `synth.simulation.passage_loop` is the first computation. Both share the law of the regulator, the
durations of its transients and the path coefficients.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from plant_models.stage_regulator import reaches_valves_s
from synth.kernels.loop.passage_loop import WATCHED_FROM_S
from synth.kernels.loop.passage_pulses import Pulses, coils_of
from synth.kernels.loop.passes import LONGEST_PASS_S
from synth.simulation.control_system import nominal_loop
from synth.simulation.impulse_train import ImpulseTrain, held, resting_train
from synth.simulation.nominal_response import CLOSED, NominalResponse, played, to_the_end, valve_schedule
from synth.simulation.passage_control_system import (
    passage_actuator,
    passage_regulator_start,
    passage_regulator_system,
)
from synth.simulation.passage_controller import PassageController
from synth.simulation.passage_loop import PassageLoop

if TYPE_CHECKING:
    from control import InterconnectedSystem

LONGEST_STRETCH_S = 1.0
"""Integrated at a time, while the next coil is far."""

NEWTON_STEPS, REACHED_M = 3, 1e-6
"""The path is smooth between two points of a response, 0.01 s apart: each step squares the error."""


@dataclass(frozen=True, order=True)
class Coil:
    """Where the first axle is when a coil tells a wheel; `second`: which of the two; `source`: the pulses."""

    path_m: float
    second: bool
    source: int


def passage_response(loop: PassageLoop, controller: PassageController, entry_speed_m_s: float) -> NominalResponse:
    """The nominal pass of the plant of `loop` under `controller`, from where the regulator acts.

    `entry_speed_m_s` at the entrance. Friction is 1, resistance the class's mean; bases have no error and the timer no
    noise, but it has its resolution.
    """
    plant, motion = loop.plant, nominal_loop(loop.plant)
    regulator, memory = passage_regulator_system(loop, controller), passage_regulator_start(loop, controller)
    rests_kpa = passage_actuator(loop, controller).mode_pressure_kpa
    speed = float(plant.start_speed_m_s(np.array(entry_speed_m_s), plant.resistance.mean_n_per_kn))
    point = np.array([0.0, plant.start_m, speed, rests_kpa[int(memory[1])]])
    met = coils(loop.pulses_of(controller))
    first_s = pulses_before(met, plant.start_m, float(motion.dynamics(0.0, point[1:], [CLOSED])[1]), speed)
    parts, schedule, heard_s = [point[:, None]], resting_train(CLOSED), WATCHED_FROM_S
    stages = resting_train(memory[0])
    for coil in met[len(first_s) :]:
        if coil.path_m >= plant.exit_m:
            break
        points = rolled(motion, point, coil.path_m, schedule)
        parts.append(points[:, 1:])
        point = points[:, -1]
        if point[1] < coil.path_m - REACHED_M:
            break  # it has stopped
        now = float(point[0])
        if not coil.second:
            first_s[coil.source] = now
            continue
        seen = [coil.source, now, now - first_s[coil.source], now - heard_s]
        wanted, heard_s = int(regulator.output(0.0, memory, seen)[0]), now
        if wanted != int(memory[0]):
            command_s = reaches_valves_s(now, loop.sensors.computing_delay_s)
            schedule = valve_schedule(plant.position, rests_kpa[int(memory[1])], wanted, command_s)
            stages = (*stages, (now, wanted))
        memory = regulator.dynamics(0.0, memory, seen)
    parts.append(rolled(motion, point, plant.exit_m, schedule)[:, 1:])
    points = np.hstack(parts)
    return to_the_end(points, np.array([held(stages, time) for time in points[0]]), plant.exit_m)


def coils(pulses: Pulses) -> list[Coil]:
    """All coils in the order of the path."""
    found = []
    for source in range(len(pulses.path_m)):
        first, second = coils_of(pulses, source, 0.0)
        found += [Coil(first, False, source), Coil(second, True, source)]
    return sorted(found)


def pulses_before(met: list[Coil], start_m: float, free_m_s2: float, speed_m_s: float) -> dict[int, float]:
    """Times of the first pulses ahead of where the pass begins: there nothing brakes."""
    found = {}
    for coil in met:
        way = start_m - coil.path_m
        if way > 0.0:
            found[coil.source] = -2.0 * way / (speed_m_s + math.sqrt(speed_m_s**2 - 2.0 * free_m_s2 * way))
    return found


def rolled(
    motion: InterconnectedSystem, point: NDArray[np.float64], to_m: float, schedule: ImpulseTrain
) -> NDArray[np.float64]:
    """Response from `point` (time, s, v, p) to where s is `to_m`, or to where the cut stops; `point` is its first."""
    parts = [point[:, None]]
    while parts[-1][1, -1] < to_m and parts[-1][2, -1] > 0.0 and parts[-1][0, -1] < LONGEST_PASS_S:
        now, path, speed = parts[-1][:3, -1]
        lasts = min(1.1 * (to_m - path) / speed + 0.01, LONGEST_STRETCH_S)
        parts.append(played(motion, parts[-1][1:, -1], now, now + lasts, schedule)[:, 1:])
    points = np.hstack(parts)
    if points[1, -1] < to_m:
        return points
    before = points[:, : max(1, int(np.argmax(points[1] >= to_m)))]
    now, path, speed = before[:3, -1]
    lasts = (to_m - path) / speed
    for _ in range(NEWTON_STEPS):
        if lasts < 1e-12:
            return before
        stretch = played(motion, before[1:, -1], now, now + lasts, schedule)
        lasts += (to_m - stretch[1, -1]) / stretch[2, -1]
    stretch[1, -1] = to_m  # no further than 1e-9 m away: a place that is reached is reached
    return np.hstack([before, stretch[:, 1:]])
