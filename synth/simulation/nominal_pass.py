"""The simulator's own nominal pass: mean friction, mean resistance, no noise; what python-control is compared with."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from plant_models import Plant, RollingResistance
from synth.simulation.closed_loop import Controller, trace
from synth.simulation.passes import PassTrace
from synth.simulation.random_passes import NOISE_SAMPLES, PATH_CELLS, RandomPasses


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
