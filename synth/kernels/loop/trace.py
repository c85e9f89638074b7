"""Kernel that writes down a pass event by event."""

from __future__ import annotations

import math
from typing import NamedTuple

from plant_models.frozen_arrays import Floats, Ints
from synth.kernels.compiling import part, part_inline
from synth.kernels.loop.drive import Pieces
from synth.kernels.loop.lane_places import FIRST_S, PIECE, SAMPLE, STAGE, S, V, Work
from synth.kernels.loop.regulator import Sensor, impulse_time_s

EVENT_FIELDS = 6
"""Columns of a trace: time, path, speed, overpressure, stage, measured speed (NaN between samples)."""


class Trace(NamedTuple):
    """Memory for the events of a pass: `events` (n, `EVENT_FIELDS`), of which n = 0 where none are wanted.

    A pressure, stage or speed holds from the time of its event on; the last event is the end of the pass. `noted` (3,):
    how many events there are, and piece and sample of the last.
    """

    events: Floats
    noted: Ints


@part_inline
def note(events: Floats, count: int, t: float, s: float, v: float, kpa: float, stage: int, measured: float) -> int:
    """Write one event, if a trace is wanted (`events` not empty); returns the number of events."""
    if count < events.shape[0]:
        events[count, 0], events[count, 1], events[count, 2] = t, s, v
        events[count, 3], events[count, 4], events[count, 5] = kpa, stage, measured
        return count + 1
    return count


@part_inline
def piece_begins_s(x: Floats, n: Ints, lane: int, pieces: Pieces, sensor: Sensor) -> float:
    """When the piece that a lane is in began; 0 is where its pass began."""
    piece = n[PIECE + lane]
    if piece == 0:
        return 0.0
    sampled_s: float = impulse_time_s(x[FIRST_S + lane], n[SAMPLE + lane], sensor.period_s)
    return sampled_s + float(pieces.start_s[piece])


@part
def note_piece(trace: Trace, work: Work, heard: int, pieces: Pieces, sensor: Sensor) -> None:
    """Write down the piece that the only pass, on lane 0, is in, if that is another than at its last event.

    `heard`: how many lanes have read the sensor since.
    """
    x, n, noted = work.floats, work.ints, trace.noted
    if n[PIECE] == noted[1] and n[SAMPLE] == noted[2]:
        return
    read = work.read[0] if heard > 0 else math.nan
    begins_s = piece_begins_s(x, n, 0, pieces, sensor)
    noted[0] = note(trace.events, noted[0], begins_s, x[S], x[V], pieces.kpa[n[PIECE]], n[STAGE], read)
    noted[1], noted[2] = n[PIECE], n[SAMPLE]


@part
def note_end(trace: Trace, time_s: float, s: float, v: float, stage: int) -> None:
    """Write down the end of the only pass, which keeps the overpressure of its last event."""
    last = trace.noted[0]
    trace.noted[0] = note(trace.events, last, time_s, s, v, trace.events[last - 1, 3], stage, math.nan)
