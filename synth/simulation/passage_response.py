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
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Floats
from plant_models.stage_regulator import Actuator, reaches_valves_s, stage_locked_actuator
from synth.kernels.loop.passage_loop import WATCHED_FROM_S
from synth.kernels.loop.passage_pulses import Pulses, coils_of, read_speed_m_s
from synth.kernels.loop.passage_regulator import DECIDED, believed_passage, outcome_of, stage_at_passage
from synth.kernels.loop.passes import LONGEST_PASS_S
from synth.simulation.control_system import ImpulseTrain, held, nominal_loop, resting_train
from synth.simulation.nominal_response import CLOSED, NominalResponse, played, to_the_end, valve_schedule
from synth.simulation.passage_controller import PassageController
from synth.simulation.passage_loop import PassageLoop
from tuning_tables.programs.tracker import TRACKER, begin_cut

if TYPE_CHECKING:
    from control import InterconnectedSystem, NonlinearIOSystem


STAGE, MODE, RESTS_S, BELIEVED = range(4)
"""Places in the regulator's state; from `BELIEVED` on the six numbers of the tracker."""

TRACKED = len(TRACKER.members)


def passage_regulator_system(loop: PassageLoop, controller: PassageController) -> NonlinearIOSystem:
    """The regulator as a discrete-time system of one step a pulse pair; it begins as `passage_regulator_start`.

    Inputs: `source`, which of the pulses heard; `time`, of the second pulse, s; `over_base`, time from the first pulse,
    s (true; it is quantised here); `since`, time since the pulse pair before, s. Output: the commanded stage. States:
    stage, resting mode (index of `Actuator`), time from which on the last transient has ended, and the tracker's.
    """
    import control  # start-up: python-control only where it is needed

    actuator, law = passage_actuator(loop, controller), controller.rule
    pulses, period = loop.pulses_of(controller), loop.sensors.scan_period_s

    def heard(x: Any, u: Any) -> tuple[int, NDArray[np.float32]]:
        source, time, over_base, since = int(u[0]), float(u[1]), float(u[2]), float(u[3])
        known, stage = np.array(x[BELIEVED:], dtype=np.float32), int(x[STAGE])
        read, passage = float(read_speed_m_s(pulses, over_base, 0.0)), int(pulses.number[source])
        if controller.tracks:
            sensor = int(pulses.sensor[source])
            passage = believed_passage(law, known, sensor, since, read)
        if outcome_of(law, passage, time - 0.5 * over_base >= float(x[RESTS_S])) == DECIDED:
            stage = stage_at_passage(law, passage, stage, read)
        return stage, known

    def next_state(t: float, x: Any, u: Any, params: dict[str, float]) -> list[float]:
        stage, known = heard(x, u)
        mode, rests_s = int(x[MODE]), float(x[RESTS_S])
        if stage != int(x[STAGE]):
            mode, scans = actuator.change(mode, stage)
            rests_s = float(u[1]) + scans * period
        return [float(stage), float(mode), rests_s, *known.tolist()]

    return control.nlsys(
        next_state,
        lambda t, x, u, params: [heard(x, u)[0]],
        inputs=["source", "time", "over_base", "since"],
        outputs=["stage"],
        states=["stage", "mode", "rests", *(f"believed{i}" for i in range(TRACKED))],
        dt=True,
        name="passage_regulator",
    )


def passage_regulator_start(loop: PassageLoop, controller: PassageController) -> Floats:
    """The state of `passage_regulator_system` before the first pulse: at rest as the plant has it."""
    stage, known = loop.plant.approach.initial_stage, np.zeros(TRACKED, dtype=np.float32)
    begin_cut(known)
    return np.array([stage, passage_actuator(loop, controller).mode_of(stage), -np.inf, *known], dtype=np.float64)


def passage_actuator(loop: PassageLoop, controller: PassageController) -> Actuator:
    """Modes and chains for as many stages as the controller has, counted in scans."""
    return stage_locked_actuator(loop.plant.position, loop.sensors, controller.stages - 1, 1)


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


def rolled(motion: InterconnectedSystem, point: Floats, to_m: float, schedule: ImpulseTrain) -> Floats:
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
