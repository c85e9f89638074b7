"""A plant as plain data for the page: its path cells, its drive, its radar, and the laws that cuts are drawn from."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, Final

import numpy as np
from numpy.typing import NDArray

from plant_models import EntryLaw, Plant, path_coefficients
from plant_models.cut import GRAVITY_M_S2
from plant_models.plant import SLOWEST_START_M_S
from synth.kernels.loop.passes import LONGEST_PASS_S
from synth.simulation.closed_loop import close_loop

Data = dict[str, Any]

ENTRY_QUANTILES: Final = 512
"""Parts of equal probability of the entry law, linear within each."""


def plant_data(plant: Plant, mass_limits_t: tuple[float, float], stages: int) -> Data:
    """What the scripts must know of `plant` with so many stages; its cut may weigh what lies
    between `mass_limits_t`.

    The cells are those of the closed loop: whatever mass, a cell has the same grade and the same pads.
    """
    loop = close_loop(plant, stages)
    path, cut, position = loop.path, plant.cut, plant.position
    gravity = cut.reduced_gravity_m_s2 * 1e-3
    return {
        "stage_kpa": list(position.stage_pressures_kpa[:stages]),
        "initial_stage": plant.approach.initial_stage,
        "entrance_stage": plant.approach.entrance_stage,
        "substeps": loop.drive.substeps,
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
        "sensor": sensor_data(plant),
        "laws": law_data(plant),
    }


def force_kn_per_kpa(plant: Plant, mass_t: float, edges_m: NDArray[np.float64]) -> NDArray[np.float64]:
    """Braking force on a cut of this mass for each kPa of overpressure, by cell; linear in the mass by every law."""
    cut = replace(plant.cut, mass_t=mass_t)
    cells = path_coefficients(plant.position, cut, plant.profile, edges_m)
    return np.asarray(cells.brake_m_s2_per_kpa * cut.inertia_t)


def valve_data(plant: Plant) -> Data:
    """Constants of the drive."""
    pneumatics = plant.position.pneumatics
    valves = pneumatics.valves(plant.position.force.touch_pressure_kpa)
    return {**valves._asdict(), "closing_delay_s": pneumatics.closing_delay_s}


def sensor_data(plant: Plant) -> Data:
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
