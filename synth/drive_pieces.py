"""What the drive plays, as one row of pieces of constant overpressure (for the kernel that runs passes in lanes)."""

from __future__ import annotations

import numpy as np

from synth.controllers import fixed
from synth.kernels.closed_loop import Drive
from synth.kernels.closed_loop_lanes import Pieces


def drive_pieces(drive: Drive, period_s: float) -> Pieces:
    """Resting modes and chains of `drive` as pieces; within a sample, parts of equal pressure are one piece."""
    modes, substeps = len(drive.mode_overpressure_kpa), drive.substeps
    part = period_s / substeps
    # Piece 0 lasts until the first sample, which each pass has elsewhere; then the resting modes.
    kpa, parts = [drive.mode_overpressure_kpa[:1], drive.mode_overpressure_kpa], [np.zeros(1 + modes)]
    places, ahead = [np.zeros(1 + modes, dtype=np.int64)], [np.ones(1), np.zeros(modes)]
    first, count = [], 1 + modes
    for chain, mode in enumerate(drive.chain_mode):
        played = drive.chain_overpressure_kpa[chain, : drive.chain_samples[chain] * substeps]
        begins = np.flatnonzero((np.arange(played.size) % substeps == 0) | np.append(True, np.diff(played) != 0.0))
        first.append(count)
        count += begins.size
        kpa.append(played[begins])
        parts.append(np.diff(np.append(begins, played.size)))
        places.append(begins)
        ahead.append(np.append(np.ones(begins.size - 1), 1 + mode - (count - 1)))
    place = np.concatenate(places)
    rest = np.zeros(count, dtype=np.int64)
    rest[1 : 1 + modes] = np.arange(1, modes + 1)
    duration = np.concatenate(parts) * part
    duration[1 : 1 + modes] = period_s
    order = np.stack([np.concatenate(ahead), rest, place // substeps], axis=1)
    none = drive.command < 0
    return Pieces(
        motion=fixed(np.stack([np.concatenate(kpa), duration], axis=1).reshape(-1), np.float64),
        start_s=fixed(place % substeps * part, np.float64),
        order=fixed(order.reshape(-1), np.int32),
        command=fixed(np.where(none, 0, np.asarray(first)[drive.command]), np.int64),
        samples=fixed(np.where(none, 0, drive.chain_samples[drive.command]), np.int64),
    )
