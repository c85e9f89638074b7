"""Where passes that run side by side keep their state, and what the drive plays to them (for `closed_loop_lanes`)."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

LANES = 64
"""Passes side by side: enough to hide what one waits for. They move in packs of eight."""

PLACES = LANES + 8
"""Numbers of a field; nobody is in the places after the lanes, which fill up the last pack of a list of lanes."""

# A lane without a pass has no speed: NaN, which fails every comparison, so that it neither moves nor waits.
FLOATS, INTS = 7, 8
S, V, LEFT_S, DRAG, FIRST_S, SLOPE, BEFORE = range(0, FLOATS * PLACES, PLACES)
CELL, ROW, PIECE, SAMPLE, STAGE, SWITCHINGS, PASS, NUMBER = range(0, INTS * PLACES, PLACES)


class Pieces(NamedTuple):
    """Pieces of constant overpressure, one after the other: what the drive plays (P of them).

    Piece 0 is before the first sample; a resting mode is one piece of a sampling period that is followed by itself, a
    chain several that end in a resting mode. Pieces below `resting` are at rest (1 + mode), those below `sampled` begin
    a sample, at rest or within a chain. `kpa`, `duration_s`, `after` (P,): overpressure, duration (that of piece 0 is
    each pass's own, noted as 0) and the piece that follows; `start_s` (P,) since the sample that it begins in;
    `mean_kpa` (P,): mean overpressure of the sampling period, noted with the first piece of each.
    `command` (modes, K + 1): first piece of the chain to a stage. `initial_stage`, `entrance_stage` as in `Drive`.
    """

    kpa: Floats
    duration_s: Floats
    start_s: Floats
    mean_kpa: Floats
    after: Ints
    command: Ints
    resting: int
    sampled: int
    initial_stage: int
    entrance_stage: int


class Work(NamedTuple):
    """Memory of the lanes: `floats` (FLOATS · PLACES,) and `ints` (INTS · PLACES,); lists of lanes, (PLACES,) each.

    `heard` (PLACES,): speed that the regulator compares in each of the lanes of `told`.
    """

    floats: Floats
    ints: Ints
    waiting: Ints
    ended: Ints
    told: Ints
    heard: Floats
