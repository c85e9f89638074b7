"""Kernel of the sensors in the loop of passages: where the coils lie for this pass, and what a pulse pair tells.

A *source* is an axle that rolls over a sensor. What the regulator hears are *rows*: pulse pairs, each with the number
of the sensor that it is told, after so long, and with the measured time over the base or another. Without faults there
is one row a source; faults of sensors add and take away.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Floats, Ints
from synth.kernels.compiling import borrowing_inline, part_inline

SHORTEST_BASE = 0.1
"""A base is at least this part of what it should be: beyond, the normal law of its error has no meaning."""

BASE_COLUMN, MOST_BASES = 255, 32
"""Of the numbers of a pass the last ones are for the bases, that of sensor i at 255 − i; all before, for the timer."""


class Pulses(NamedTuple):
    """E sources and R rows, alike in all passes.

    `path_m` (E,): path of the first axle where the axle is at the middle of the base; `sensor` (E,); `number` (E,):
    among all passages heard; `decides` (E,): among those at which is decided, or −1; `column` (E,): which number of a
    pass is the noise of the timer. `coils` (2E,): first coils e and second coils E + e, in the order of the path if
    bases have no error. Rows of source e are `first_row[e]` … `first_row[e + 1]` − 1, `first_row` (E + 1,); those
    behind come by the clock. `told_sensor` (R,).
    """

    path_m: Floats
    sensor: Ints
    number: Ints
    decides: Ints
    column: Ints
    coils: Ints
    first_row: Ints
    told_sensor: Ints
    base_m: float
    base_tolerance: float
    timer_noise_s: float
    timer_resolution_s: float


class Heard(NamedTuple):
    """What differs from pass to pass, (n, R), or (1, R) where nothing does.

    `after_s`: from the second pulse of the source to the row, or for a row by the clock its time; NaN: not heard.
    `told_m_s`: the speed told; NaN: that which is measured.
    """

    after_s: Floats
    told_m_s: Floats


class Memory(NamedTuple):
    """Room for one pass: coils (2E,), pulse times (E,), rows (R,) and those of them that wait, and the tracker."""

    place_m: Floats
    order: Ints
    first_s: Floats
    due_s: Floats
    half_s: Floats
    over_s: Floats
    row_source: Ints
    waiting: Ints
    state: NDArray[np.float32]


class Pair(NamedTuple):
    """A pulse pair that is heard: the `sensor` told, the true `source` and its `passage` among those heard (−1: none),
    half the true time between the pulses, the measured time over the base, and the speed that it tells."""

    sensor: int
    source: int
    passage: int
    half_s: float
    over_s: float
    read_m_s: float


@borrowing_inline
def coils_of(pulses: Pulses, source: int, z: float) -> Any:
    """Impulse element: (path of the first pulse, of the second) of `source`; `z`: the error of the base, in stds."""
    scale = 1.0 + pulses.base_tolerance * z
    if not scale >= SHORTEST_BASE:
        scale = 1.0 if math.isnan(scale) else SHORTEST_BASE
    half = 0.5 * pulses.base_m * scale
    return pulses.path_m[source] - half, pulses.path_m[source] + half


@part_inline
def measured_over_base_s(pulses: Pulses, true_s: float, z: float) -> float:
    """The measured time over the base: it has the noise `z` in standard deviations and is rounded.

    NaN where `z` is: nothing was measured.
    """
    measured_s: float = true_s + pulses.timer_noise_s * z
    if pulses.timer_resolution_s > 0.0:
        measured_s = np.rint(measured_s / pulses.timer_resolution_s) * pulses.timer_resolution_s
    return measured_s


@borrowing_inline
def read_speed_m_s(pulses: Pulses, true_s: float, z: float) -> float:
    """Relay element of the speed: base over the measured time."""
    over_s: float = measured_over_base_s(pulses, true_s, z)
    return pulses.base_m / over_s


@part_inline
def place_coils(pulses: Pulses, noise_z: NDArray[np.float32], memory: Memory) -> None:
    """Where the first axle is at each pulse of this pass, and the order of the pulses."""
    sources = pulses.path_m.shape[0]
    for e in range(sources):
        z = noise_z[BASE_COLUMN - pulses.sensor[e]]
        memory.place_m[e], memory.place_m[sources + e] = coils_of(pulses, e, z)
    for at in range(2 * sources):  # by insertion: all but in order already
        coil = pulses.coils[at]
        place, slot = memory.place_m[coil], at
        while slot > 0 and memory.place_m[memory.order[slot - 1]] > place:
            memory.order[slot] = memory.order[slot - 1]
            slot -= 1
        memory.order[slot] = coil


@part_inline
def pulses_before(start_m: float, free_m_s2: float, v: float, memory: Memory) -> int:
    """Times of the coils passed before `start_m`, which the cut reaches with `v` at time 0; returns how many.

    Only first coils can lie there. Nothing brakes, so the acceleration is the free one.
    """
    coil = 0
    while coil < memory.order.shape[0] and memory.place_m[memory.order[coil]] < start_m:
        way = start_m - memory.place_m[memory.order[coil]]
        v_before = math.sqrt(max(v * v - 2.0 * free_m_s2 * way, 0.01 * v * v))
        memory.first_s[memory.order[coil]] = -2.0 * way / (v + v_before)
        coil += 1
    return coil


@part_inline
def wait_for(row: int, source: int, due_s: float, half_s: float, over_s: float, waiting: int, memory: Memory) -> int:
    """Have `row` heard at `due_s`; returns how many rows are waited for."""
    memory.due_s[row], memory.half_s[row], memory.over_s[row] = due_s, half_s, over_s
    memory.row_source[row] = source
    memory.waiting[waiting] = row
    return waiting + 1


@part_inline
def rows_by_the_clock(pulses: Pulses, heard: Heard, memory: Memory) -> int:
    """Have the rows heard that come from no source; returns how many rows are waited for."""
    waiting = 0
    for row in range(pulses.first_row[pulses.path_m.shape[0]], pulses.told_sensor.shape[0]):
        if not math.isnan(heard.after_s[row]):
            told_m_s = heard.told_m_s[row]
            over_s = pulses.base_m / told_m_s
            half_s = 0.5 * over_s if told_m_s > 0.0 else 0.0
            waiting = wait_for(row, -1, heard.after_s[row], half_s, over_s, waiting, memory)
    return waiting


@part_inline
def cover_coil(
    coil: int, time_s: float, noise_z: NDArray[np.float32], pulses: Pulses, heard: Heard, waiting: int, memory: Memory
) -> int:
    """The first axle is on a coil at `time_s`; returns how many rows are waited for.

    At the second coil of a source its rows are heard, later. Its timer may measure nothing. A time that is measured as
    0 or less tells an infinite or negative speed: the rule holds, and the tracker does not believe it.
    """
    source = coil - pulses.path_m.shape[0]
    if source < 0:
        memory.first_s[coil] = time_s
        return waiting
    true_s = time_s - memory.first_s[source]
    measured_s = measured_over_base_s(pulses, true_s, noise_z[pulses.column[source]])
    if math.isnan(measured_s):
        return waiting
    for row in range(pulses.first_row[source], pulses.first_row[source + 1]):
        after_s, told_m_s = heard.after_s[row], heard.told_m_s[row]
        if not math.isnan(after_s):
            over_s = measured_s if math.isnan(told_m_s) else pulses.base_m / told_m_s
            waiting = wait_for(row, source, time_s + after_s, 0.5 * true_s, over_s, waiting, memory)
    return waiting


@part_inline
def next_row(waiting: int, memory: Memory) -> Any:
    """(time, place in `waiting`) of the row that is heard next, the first of several; infinity where none waits."""
    due_s, found = math.inf, -1
    for at in range(waiting):
        row = memory.waiting[at]
        if memory.due_s[row] < due_s or (memory.due_s[row] == due_s and row < memory.waiting[found]):
            due_s, found = memory.due_s[row], at
    return due_s, found


@part_inline
def take_pair(at: int, waiting: int, pulses: Pulses, memory: Memory) -> Any:
    """(pair, how many rows still wait) once the row at place `at` of `waiting` is heard."""
    row = memory.waiting[at]
    memory.waiting[at] = memory.waiting[waiting - 1]
    source, over_s = memory.row_source[row], memory.over_s[row]
    passage = pulses.number[source] if source >= 0 else -1
    pair = Pair(pulses.told_sensor[row], source, passage, memory.half_s[row], over_s, pulses.base_m / over_s)
    return pair, waiting - 1
