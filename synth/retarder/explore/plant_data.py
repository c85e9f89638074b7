"""A plant as plain data for the page: path cells, drive, radar or point sensors, and the laws of its cuts."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Final

import numpy as np

from plant_models import EntryLaw, Plant, PointSensors, every_axle, path_coefficients
from plant_models.cut import GRAVITY_M_S2
from plant_models.frozen_arrays import Floats
from plant_models.plant import SLOWEST_START_M_S
from plant_models.point_sensors import deciding_passages
from synth.kernels.loop.passage_loop import WATCHED_FROM_S
from synth.kernels.loop.passage_pulses import BASE_COLUMN, SHORTEST_BASE
from synth.kernels.loop.passes import LONGEST_PASS_S
from synth.simulation.closed_loop import close_loop
from synth.simulation.passage_loop import PassageLoop, close_passage_loop, scan_substeps

Data = dict[str, Any]

ENTRY_QUANTILES: Final = 512
"""Parts of equal probability of the entry law, linear within each."""


def plant_data(
    plant: Plant, mass_limits_t: tuple[float, float], stages: int, sensors: PointSensors | None = None
) -> Data:
    """What the scripts must know of `plant` with so many stages; its cut may weigh what lies
    between `mass_limits_t`. `sensors`: those that its regulator decides at, in place of a radar.

    The cells are those of the closed loop: whatever mass, a cell has the same grade and the same pads.
    """
    if sensors is None:
        loop = close_loop(plant, stages)
        sensor, substeps = radar_data(plant), loop.drive.substeps
    else:
        by_pulses = close_passage_loop(plant, sensors, stages)
        loop, sensor, substeps = by_pulses.radar, pulse_data(by_pulses), scan_substeps(sensors)
    path, cut, position = loop.path, plant.cut, plant.position
    gravity = cut.reduced_gravity_m_s2 * 1e-3
    return {
        "stage_kpa": list(position.stage_pressures_kpa[:stages]),
        "initial_stage": plant.approach.initial_stage,
        "entrance_stage": plant.approach.entrance_stage,
        "substeps": substeps,
        "longest_pass_s": LONGEST_PASS_S,
        "slowest_start_m_s": SLOWEST_START_M_S,
        "zones_m": [list(zone) for zone in position.zones_m],
        "max_entry_m_s": position.max_entry_speed_m_s,
        "mass_t": cut.mass_t,
        "mass_limits_t": list(mass_limits_t),
        "rotating_t": cut.inertia_t - cut.mass_t,
        "gravity_m_s2": GRAVITY_M_S2,
        "edges_m": path.edges_m.tolist(),
        "approach_cells": path.approach_cells,
        "grade_permille": (path.gravity_m_s2 / gravity).tolist(),
        "force_kn_per_kpa": [force_kn_per_kpa(plant, mass_t, path.edges_m).tolist() for mass_t in mass_limits_t],
        "eta_std": path.eta_std.tolist(),
        "eta_memory": path.eta_memory.tolist(),
        "eta_fresh": path.eta_fresh.tolist(),
        "valves": valve_data(plant),
        "sensor": sensor,
        "laws": law_data(plant),
    }


def force_kn_per_kpa(plant: Plant, mass_t: float, edges_m: Floats) -> Floats:
    """Braking force on a cut of this mass for each kPa of overpressure, by cell; linear in the mass by every law."""
    cut = replace(plant.cut, mass_t=mass_t)
    cells = path_coefficients(plant.position, cut, plant.profile, edges_m)
    return np.asarray(cells.brake_m_s2_per_kpa * cut.inertia_t)


def valve_data(plant: Plant) -> Data:
    """Constants of the drive."""
    pneumatics = plant.position.pneumatics
    valves = pneumatics.valves(plant.position.force.touch_pressure_kpa)
    return {**valves._asdict(), "closing_delay_s": pneumatics.closing_delay_s}


def pulse_data(loop: PassageLoop) -> Data:
    """Point sensors: their clock and timer, and the passages of all axles, each of which gives a pair of pulses."""
    sensors, plant, pulses = loop.sensors, loop.plant, loop.heard
    met = deciding_passages(replace(sensors, axles=every_axle), plant.cut, plant.exit_m)
    return {
        "period_s": sensors.scan_period_s,
        "computing_delay_s": sensors.computing_delay_s,
        "missed_share": 0.0,
        "timer_noise_s": sensors.timer_noise_s,
        "timer_resolution_s": sensors.timer_resolution_s,
        "base_m": sensors.base_m,
        "base_tolerance": sensors.base_tolerance,
        "base_column": BASE_COLUMN,
        "shortest_base": SHORTEST_BASE,
        "watched_from_s": WATCHED_FROM_S,
        "path_m": list(sensors.path_m),
        "coils": pulses.coils.tolist(),
        "passages": [
            {"sensor": each.sensor, "axle": each.axle, "path_m": float(path_m), "column": int(column)}
            for each, path_m, column in zip(met, pulses.path_m, pulses.column, strict=True)
        ],
    }


def radar_data(plant: Plant) -> Data:
    """The radar."""
    sensor = plant.sensor
    return {
        "period_s": sensor.sample_period_s,
        "computing_delay_s": sensor.computing_delay_s,
        "noise_m_s": sensor.noise_m_s,
        "resolution_m_s": sensor.resolution_m_s,
        "missed_share": sensor.missed_share,
        "missed_readings": sensor.missed_readings,
    }


def law_data(plant: Plant) -> Data:
    """What differs from cut to cut."""
    return {
        "factor_cv": plant.friction_cv,
        "factor_floor": plant.friction.floor,
        "resistance_mean": plant.resistance.mean_n_per_kn,
        "resistance_std": plant.resistance.std_n_per_kn,
        "entry": entry_quantiles_m_s(plant.entry),
        "entry_told": plant.entry.sentence,
    }


def entry_quantiles_m_s(law: EntryLaw) -> list[float]:
    """Entry speeds at probabilities 0 to 1 in equal steps."""
    inside = law.speed_m_s(np.arange(1, ENTRY_QUANTILES) / ENTRY_QUANTILES)
    return [round(float(speed), 6) for speed in (law.low_m_s, *inside, law.high_m_s)]
