"""The estimator of a plant, and the plant as a regulator with an estimator sees it: what its lines are designed on."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from plant_models import DopplerSensor, Plant, path_coefficients
from plant_models.frozen_arrays import Bools
from plant_models.motion import path_breaks_m
from synth.kernels.loop.passes import Draws
from synth.simulation.closed_loop import ClosedLoop
from synth.simulation.controllers import Controller
from synth.simulation.passes import PassTrace
from synth.solver.any_time.sampled_chain import EstimateError, error_along_path
from tuning_tables.estimator import MOST_BREAKS, MOST_READINGS, Estimator

REPEATED_BY_CHANCE = 1e-4
"""A sensor is frozen that repeats a reading so often as chance does no oftener, on a cut that neither slows down nor
speeds up. From a third as many on, by chance at most one in twenty, a reading is not believed."""

DOUBTED_S = 2.0
"""Readings that leapt away from the estimate, and since then move as a cut does, are believed after so long. A sensor
whose error lasts is then followed; one that began in error and is good again is not doubted to the end of the pass."""

LOST_SPEED_STD_M_S = 0.2
"""A cut whose speed is known no better than this is lost: what is left of the pass could take it beyond 0.3 m/s."""

UNLIKELY_STDS = 2.4
"""Of the friction of any day: a cut beyond it is not of the table's category. How often that is said
wrongly stands in docs/explanation/radar-faults.md."""

SECTIONS = 10
"""Of the path, each with figures of its own for the error of an estimate."""


def estimator_of(plant: Plant) -> Estimator:
    """The estimator that knows this plant: its work by grade, mean resistance and brake, its sensor and friction.

    Quantisation counts as noise, resolution/√12. D and W are exact at the breaks of N(s) and grade; very long cuts,
    with more breaks than a table takes, have evenly spaced ones instead.
    """
    breaks = path_breaks_m(plant.position, plant.cut, plant.profile, plant.start_m)
    edges = np.unique(breaks)
    # Slivers between nearly equal breaks would vanish in float32.
    edges = edges[np.concatenate([[True], np.diff(edges) > 2e-3])]
    if len(edges) > MOST_BREAKS:
        edges = np.linspace(plant.start_m, plant.exit_m, MOST_BREAKS)
    cells = path_coefficients(plant.position, plant.cut, plant.profile, edges)
    drive = cells.free_m_s2(plant.resistance.mean_n_per_kn)
    length = np.diff(edges)
    sensor, friction = plant.sensor, plant.friction
    return Estimator(
        speed_noise_m_s=sensor.reading_std_m_s,
        friction_cv=plant.friction_cv,
        resistance_std_m_s2=plant.cut.reduced_gravity_m_s2 * 1e-3 * plant.resistance.std_n_per_kn,
        path_std=friction.path_std,
        correlation_length_m=friction.correlation_length_m,
        frozen_readings=frozen_readings(sensor),
        doubted_readings=max(1, round(DOUBTED_S / sensor.sample_period_s)),
        lost_speed_std_m_s=LOST_SPEED_STD_M_S,
        unlikely_deviation=UNLIKELY_STDS * replace(plant, friction=friction.of_any_day).friction_cv,
        touch_pressure_kpa=plant.position.force.touch_pressure_kpa,
        s_m=tuple(edges.tolist()),
        drive_m2_s2=(0.0, *np.cumsum(drive * length).tolist()),
        brake_m2_s2_per_kpa=(0.0, *np.cumsum(cells.brake_m_s2_per_kpa * length).tolist()),
    )


def frozen_readings(sensor: DopplerSensor) -> int:
    """After how many repetitions of one reading the sensor is taken to have frozen; `MOST_READINGS`: never."""
    again = sensor.repeat_probability
    if again == 0.0:
        return 1
    needed = math.log(REPEATED_BY_CHANCE) / math.log(again) if again < 1.0 else math.inf
    return math.ceil(min(needed, MOST_READINGS))


def error_of_estimate(loop: ClosedLoop, controller: Controller, draws: Draws, least_std_m_s: float) -> EstimateError:
    """The error of the speed that `controller` compares with its lines, along the path and by what is hidden."""
    plant = loop.plant
    per_n_kn = -plant.cut.reduced_gravity_m_s2 * 1e-3
    rows = []
    for i, trace, decided in decisions(loop, controller, draws):
        error = (trace.measured_m_s - trace.speed_m_s)[decided]
        hidden = draws.cut_factor[i] - 1.0, per_n_kn * (draws.resistance_n_kn[i] - plant.resistance.mean_n_per_kn)
        columns = trace.path_m[decided], error, *(np.full(error.shape, x) for x in (*hidden, draws.weight[i]))
        rows.append(np.column_stack(columns))
    edges = np.linspace(plant.start_m, plant.exit_m, SECTIONS + 1)
    return error_along_path(np.concatenate(rows), edges, least_std_m_s)


def decisions(loop: ClosedLoop, controller: Controller, draws: Draws) -> Iterator[tuple[int, PassTrace, Bools]]:
    """Every pass with the number of its draw, and which of its events are decisions."""
    for index in range(len(draws.cut_factor)):
        trace = loop.follow(controller, draws.part(index, index + 1))
        yield index, trace, ~np.isnan(trace.measured_m_s)
