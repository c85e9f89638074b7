"""The path of a plant as the closed loop runs it: cells in which everything is constant."""

from __future__ import annotations

import math

import numpy as np

from plant_models import Plant, path_coefficients
from plant_models.frozen_arrays import Floats
from plant_models.motion import path_breaks_m
from synth.kernels.loop.motion import Path
from synth.simulation.controllers import fixed
from synth.simulation.random_passes import PATH_CELLS

CELL_M = 0.5
"""Longest path cell, at most a quarter of the correlation length; η is constant in a cell."""


def path_cells(plant: Plant) -> Path:
    """Cells with constant coefficients and constant η."""
    edges = cell_edges_m(plant)
    coefficients = path_coefficients(plant.position, plant.cut, plant.profile, edges)
    length = np.diff(edges)
    memory = np.append(0.0, plant.friction.path_correlation(0.5 * (length[1:] + length[:-1])))  # none before the first
    before = int(np.searchsorted(edges, 0.0))
    memory[before] = 0.0
    return Path(
        fixed(edges, np.float64),
        fixed(coefficients.gravity_m_s2, np.float64),
        fixed(coefficients.brake_m_s2_per_kpa, np.float64),
        fixed(plant.friction.path_cell_std(length), np.float64),
        fixed(memory, np.float64),
        fixed(np.sqrt(1.0 - memory**2), np.float64),
        coefficients.resistance_m_s2_per_n_kn,
        before,
    )


def cell_edges_m(plant: Plant) -> Floats:
    """Edges of at most 512 cells of at most 0.5 m, none of them with a change of N(s) or grade inside.

    Long cuts get longer cells; if their axles alone make too many breaks, cells take the mean over a break. Before the
    entrance, where nothing brakes, there are no more cells than grades.
    """
    ahead = path_breaks_m(plant.position, plant.cut, plant.profile, plant.start_m)
    return np.concatenate([ahead[ahead < 0.0], braked_edges_m(plant)])


def braked_edges_m(plant: Plant) -> Floats:
    """Edges of the cells from the entrance to the exit."""
    breaks = path_breaks_m(plant.position, plant.cut, plant.profile)
    if breaks.size > PATH_CELLS // 2:
        return np.linspace(0.0, plant.exit_m, PATH_CELLS + 1)
    cell_m = min(CELL_M, plant.friction.correlation_length_m / 4.0)
    count = min(math.ceil(plant.exit_m / cell_m), PATH_CELLS - breaks.size)
    uniform = np.linspace(0.0, plant.exit_m, count + 1)
    # A sliver between a break and a node of the mesh would only cost time and digits.
    far = np.abs(uniform[:, None] - breaks).min(axis=1) > 1e-3
    return np.sort(np.concatenate([uniform[far], breaks]))
