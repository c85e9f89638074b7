"""What the drive plays, as one row of pieces of constant overpressure (for the kernel that runs passes in lanes)."""

from __future__ import annotations

import numpy as np

from plant_models.frozen_arrays import Floats
from synth.kernels.any_time.driven_period import SampledDrive
from synth.kernels.any_time.played_periods import PlayedPeriods
from synth.kernels.loop.drive import Drive, Pieces
from synth.kernels.loop.lane_places import LANES
from synth.simulation.controllers import fixed

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
