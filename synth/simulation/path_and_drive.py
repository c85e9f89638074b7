"""A plant as the closed loop runs it: the path as cells in which everything is constant, and what the drive plays as
one row of pieces of constant overpressure (for the kernel that runs passes in lanes).
"""

from __future__ import annotations

import math

import numpy as np

from plant_models import Plant, path_coefficients
from plant_models.frozen_arrays import Floats
from plant_models.motion import path_breaks_m
from synth.kernels.any_time.driven_period import SampledDrive
from synth.kernels.any_time.played_periods import PlayedPeriods
from synth.kernels.loop.drive import Drive, Pieces
from synth.kernels.loop.lane_places import LANES
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


STATES = 4096
"""States of a drive that are remembered: 20 000 passes of a table meet some hundreds."""


def drive_pieces(drive: Drive, period_s: float) -> Pieces:
    """Resting modes and chains of `drive` as pieces; within a sample, parts of equal pressure are one piece."""
    modes, substeps = len(drive.mode_overpressure_kpa), drive.substeps
    resting, part = 1 + modes, period_s / substeps
    # Piece 0 lasts until the first sample, which each pass has elsewhere; then the resting modes.
    begins_at = drive.initial_mode
    kpa, parts = (
        [drive.mode_overpressure_kpa[begins_at : begins_at + 1], drive.mode_overpressure_kpa],
        [np.zeros(resting)],
    )
    means = [np.append(kpa[0], drive.mode_overpressure_kpa)]
    places, after = [np.zeros(resting, dtype=np.int64)], [np.append(1 + begins_at, np.arange(1, resting))]
    first, count = [], resting
    for chain, mode in enumerate(drive.chain_mode):
        played = drive.chain_overpressure_kpa[chain, : drive.chain_samples[chain] * substeps]
        begins = np.flatnonzero((np.arange(played.size) % substeps == 0) | np.append(True, np.diff(played) != 0.0))
        first.append(count)
        count += begins.size
        kpa.append(played[begins])
        means.append(period_means(played, substeps)[begins // substeps])
        parts.append(np.diff(np.append(begins, played.size)))
        places.append(begins)
        after.append(np.append(np.arange(first[-1] + 1, count), 1 + mode))
    place, duration = np.concatenate(places), np.concatenate(parts) * part
    duration[1:resting] = period_s
    # Those that begin a sample come first, so that one comparison tells them.
    order = np.argsort(place % substeps != 0, kind="stable")
    number = np.argsort(order)
    none = drive.command < 0
    return Pieces(
        kpa=fixed(np.concatenate(kpa)[order], np.float64),
        duration_s=fixed(duration[order], np.float64),
        mean_kpa=fixed(np.concatenate(means)[order], np.float64),
        start_s=fixed((place % substeps * part)[order], np.float64),
        after=fixed(number[np.concatenate(after)[order]], np.int64),
        command=fixed(np.where(none, 0, number[np.asarray(first)[drive.command]]), np.int64),
        resting=resting,
        sampled=int(np.sum(place % substeps == 0)),
        initial_stage=drive.initial_stage,
        entrance_stage=drive.entrance_stage,
    )


def period_means(played_kpa: Floats, substeps: int) -> Floats:
    """Mean overpressure of every period, summed up from its first part to its last, as the kernel does it."""
    parts = played_kpa.reshape(-1, substeps)
    return np.asarray(np.cumsum(parts, axis=1)[:, -1] / substeps)


def empty_periods(drive: SampledDrive, states: int = STATES) -> PlayedPeriods:
    """Memory for so many states of `drive` and the periods that begin in them, with nothing played yet."""
    lanes, stages = states + LANES, len(drive.stage_kpa)
    pieces = states * (1 + stages) + LANES * (drive.parts + 1)
    return PlayedPeriods(
        Pieces(
            kpa=np.zeros(pieces),
            duration_s=np.zeros(pieces),
            start_s=np.zeros(pieces),
            mean_kpa=np.zeros(pieces),
            after=np.zeros(pieces, dtype=np.int64),
            command=np.zeros((states, stages), dtype=np.int64),
            resting=lanes,
            sampled=lanes,
            initial_stage=drive.initial_stage,
            entrance_stage=drive.entrance_stage,
        ),
        pressure_kpa=np.zeros(lanes),
        wait_s=np.zeros(lanes),
        stage=np.zeros(lanes, dtype=np.int64),
        rises=np.zeros((lanes, 2), dtype=np.float32),
        slots=np.zeros(1 << (2 * states).bit_length(), dtype=np.int64),
        taken=np.zeros(2, dtype=np.int64),
        over=np.zeros(drive.parts),
    )
