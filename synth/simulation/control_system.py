"""A controller and its plant as python-control systems: mean friction, mean resistance, no noise.

Motion and pneumatic drive are continuous `nlsys`, connected by `interconnect` (`nominal_loop`). The sampled,
stage-locked regulator is a discrete-time `nlsys` (`regulator_system`). python-control refuses to connect systems of
different timebases, so `nominal_response` closes the loop. What python-control can represent is exact here.

Between the two stand the ideal impulse element, which makes an impulse of each command whose area is the signal of the
stage that is commanded, and the zero-order hold, which makes steps of the impulses (zhukovitsky-2012, figure 4).
"""

from __future__ import annotations

import math
from bisect import bisect_right
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant, path_coefficients
from plant_models.frozen_arrays import Floats
from plant_models.motion import path_breaks_m
from plant_models.stage_regulator import Actuator, stage_locked_actuator
from synth.kernels.loop import regulator
from synth.simulation.closed_loop import Controller
from tuning_tables import estimator
from tuning_tables.programs.observe import observe

if TYPE_CHECKING:
    from control import InterconnectedSystem, NonlinearIOSystem

Impulse = tuple[float, float]
"""(instant in s, area)."""

ImpulseTrain = tuple[Impulse, ...]
"""Impulses in the order of time."""


def resting_train(value: float) -> ImpulseTrain:
    """The train of a signal that has had this value for ever."""
    return ((-math.inf, value),)


def with_command(
    train: ImpulseTrain, instant_s: float, stage: int, stage_pressures_kpa: tuple[float, ...]
) -> ImpulseTrain:
    """The train with one more impulse at its end, whose area is the pressure of `stage`.

    Raises `ValueError` for an instant before that of the last.
    """
    if instant_s < train[-1][0]:
        raise ValueError(f"impulse train: a command at {instant_s:g} s comes after that at {train[-1][0]:g} s")
    return (*train, (instant_s, stage_pressures_kpa[stage]))


def held(train: ImpulseTrain, time_s: float) -> float:
    """Zero-order hold: the area of the last impulse at or before `time_s`, which must not be before the first."""
    return next(value for instant, value in reversed(train) if instant <= time_s)


STAGE, MODE, LOCKED, SLOPE, LAST, KNOWN = range(6)
"""Places in the regulator's state; from `KNOWN` on the state of the estimator."""


def motion_system(plant: Plant) -> NonlinearIOSystem:
    """Motion of the cut: input p (kPa gauge), states and outputs s (m), v (m/s).

    Parameters of the system: `friction` ξ (1) and `resistance_n_kn` w (the class's mean). A cut at rest stays
    where it is; outside the path the nearest path cell goes on.
    """
    import control  # start-up: python-control only where it is needed

    edges = path_breaks_m(plant.position, plant.cut, plant.profile, plant.start_m)
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
    """The stage-locked regulator as a discrete-time system of the sampling period; it begins as `regulator_start`.

    Inputs: s (m), v (m/s, true; it is quantised here) and the mean overpressure since the sample before (kPa), which
    only an estimator looks at; output: the commanded stage. States: stage, resting mode (index of `Actuator`), samples
    for which it is still locked, filtered slope (m/s²), last measured speed (−1 before the first sample), and the eight
    of the estimator.
    """
    import control

    actuator, period = regulated_actuator(plant, controller), plant.sensor.sample_period_s
    sensor = regulator.Sensor(period, 0.0, plant.sensor.resolution_m_s)
    law = controller.rule
    gain = period / (period + law.filter_s)

    def filtered_slope(x: Any, measured: float) -> float:
        slope, last = float(x[SLOPE]), float(x[LAST])
        return slope if last < 0.0 else slope + gain * ((measured - last) / period - slope)

    def estimated(x: Any, u: Any, measured: float) -> tuple[float, NDArray[np.float32]]:
        known = np.array(x[KNOWN:], dtype=np.float32)
        if law.table.breaks == 0:
            return measured, known
        return float(observe(law.table, known, float(u[0]), measured, float(u[2]))), known

    def stage_wanted(t: float, x: Any, u: Any, params: dict[str, float]) -> list[int]:
        stage, top = int(x[STAGE]), actuator.stages - 1
        if x[LOCKED] > 0:
            return [stage]
        measured = regulator.measure(float(u[1]), 0.0, sensor)
        if law.table.stages > 0:
            wanted = stage_by_table(law, stage, float(u[0]), estimated(x, u, measured)[0])
        else:
            ahead = measured + law.lead_s * filtered_slope(x, measured)
            lines = (law.lower, law.upper, law.start_m, law.spacing_m, law.farthest)
            wanted = regulator.stage_by_lines(*lines, stage, top, float(u[0]), ahead)
        return [regulator.admitted(stage, wanted, float(u[0]), plant.approach.entrance_stage)]

    def next_state(t: float, x: Any, u: Any, params: dict[str, float]) -> list[float]:
        [wanted] = stage_wanted(t, x, u, params)
        mode, locked = int(x[MODE]), int(x[LOCKED])
        if wanted != int(x[STAGE]):
            mode, locked = actuator.change(mode, wanted)
        measured = regulator.measure(float(u[1]), 0.0, sensor)
        known = estimated(x, u, measured)[1].tolist()
        return [wanted, mode, max(0, locked - 1), filtered_slope(x, measured), measured, *known]

    return control.nlsys(
        next_state,
        stage_wanted,
        inputs=["s", "v", "over"],
        outputs=["stage"],
        states=["stage", "mode", "locked", "slope", "last", *(f"known{i}" for i in range(estimator.STATE_SIZE))],
        dt=period,
        name="regulator",
    )


def stage_by_table(law: regulator.Rule, stage: int, s_m: float, v_m_s: float) -> int:
    """Digital controller of a radar: the stage wanted at (s, v) while `stage` is in force."""
    return int(regulator.stage_by_table(law.table, stage, s_m, v_m_s, math.nan))


def regulator_start(plant: Plant, controller: Controller) -> Floats:
    """The state of `regulator_system` before the first sample: at rest as the plant has it, nothing measured."""
    stage = plant.approach.initial_stage
    mode = regulated_actuator(plant, controller).mode_of(stage)
    return np.array([float(stage), float(mode), 0.0, 0.0, -1.0, *estimator.begin()])


def regulated_actuator(plant: Plant, controller: Controller) -> Actuator:
    """Modes and chains for as many stages as the controller has."""
    return stage_locked_actuator(plant.position, plant.sensor, controller.stages - 1, 1)
