"""Kernel of the closed-loop simulation: cut, valves, sensor and switching rule, pass after pass.

Motion is exact: within a path cell and a piece of constant overpressure the acceleration is constant, so
positions and times of cell edges are closed forms. The only approximation is that a transient is played as
its exact mean overpressure over each part of a sampling period.

What the regulator measures and wants is in `kernels.regulator`.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from synth.kernels.compiling import borrowing_inline, kernel, part, part_inline
from synth.kernels.loop.regulator import (
    Rule,
    Sensor,
    admitted,
    estimated_speed,
    impulse_time_s,
    measure,
    stage_by_lines,
    stage_by_table,
)

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

MOVING, LEFT, STALLED = 0, 1, 2

LONGEST_PASS_S = 300.0
"""A cut that is still inside, at rest between two commands, after this time has stalled: it creeps."""

TOGETHER = 16
"""Passes of which η is followed at a time."""

EVENT_FIELDS = 6
"""Columns of a trace: time, path, speed, overpressure, stage, measured speed (NaN between samples)."""


class Path(NamedTuple):
    """Cells along the path: `edges_m` (C + 1,); all others (C,) but the last two.

    `eta_std` of η in the cell, `eta_memory` correlation with the cell before (0 in the first that brakes) and
    `eta_fresh` = sqrt(1 − memory²); `drag_m_s2_per_n_kn`: deceleration by one N/kN of resistance; `approach_cells`:
    how many lie before the entrance.
    """

    edges_m: Floats
    gravity_m_s2: Floats
    brake_m_s2_per_kpa: Floats
    eta_std: Floats
    eta_memory: Floats
    eta_fresh: Floats
    drag_m_s2_per_n_kn: float
    approach_cells: int


class Drive(NamedTuple):
    """Resting modes and chains of the actuator (`stage_regulator.Actuator`, same names).

    A pass begins at `initial_mode` of `initial_stage`; before the entrance no higher stage than `entrance_stage` is
    commanded, whatever the law.
    """

    mode_overpressure_kpa: Floats
    command: Ints
    chain_mode: Ints
    chain_samples: Ints
    chain_overpressure_kpa: Floats
    substeps: int
    initial_mode: int
    initial_stage: int
    entrance_stage: int


class Draws(NamedTuple):
    """What chance gives to n passes: ξ_cut, w0, speed at the beginning, first sample (n,); z of path and sensor (n, ·).

    `brake_m_s2_per_kpa` (n, C) follows from ξ_cut and path_z (`brake_rows`): worked out once for all controllers.
    `weight` (n,): how many cuts each pass stands for; no kernel reads it.
    """

    cut_factor: Floats
    resistance_n_kn: Floats
    entry_m_s: Floats
    first_sample_s: Floats
    path_z: NDArray[np.float32]
    noise_z: NDArray[np.float32]
    brake_m_s2_per_kpa: Floats
    weight: Floats


class Exits(NamedTuple):
    """Results of n passes, filled by the kernel; a stalled pass leaves with speed 0 at the time it stops."""

    speed_m_s: Floats
    time_s: Floats
    stalled: NDArray[np.bool_]
    switchings: NDArray[np.int32]


@borrowing_inline
def advance(
    edges_m: Floats, free: Floats, brake: Floats, overpressure: float, duration_s: float, cell: int, s: float, v: float
) -> Any:
    """Move for `duration_s` under constant overpressure; returns (cell, s, v, time used, status).

    `free` and `brake` (C,) are acceleration without brake and deceleration by one kPa in each cell. Ends
    early at the exit (LEFT) or where the speed reaches 0 (STALLED).
    """
    left = duration_s
    while True:
        a = free[cell] - brake[cell] * overpressure
        gap = edges_m[cell + 1] - s
        v_end = v + a * left
        x = 0.5 * (v + v_end) * left
        if v_end > 0.0 and x < gap:
            return cell, s + x, v_end, duration_s, MOVING
        square = v * v + 2.0 * a * gap
        if square <= 0.0:
            return cell, s - 0.5 * v * v / a, 0.0, duration_s - left - v / a, STALLED
        v_edge = math.sqrt(square)
        left = max(0.0, left - 2.0 * gap / (v + v_edge))
        v = v_edge
        cell += 1
        s = edges_m[cell]
        if cell == free.shape[0]:
            return cell, s, v, duration_s - left, LEFT


@part_inline
def note(events: Floats, count: int, t: float, s: float, v: float, kpa: float, stage: int, measured: float) -> int:
    """Write one event, if a trace is wanted (`events` not empty); returns the number of events."""
    if count < events.shape[0]:
        events[count, 0], events[count, 1], events[count, 2] = t, s, v
        events[count, 3], events[count, 4], events[count, 5] = kpa, stage, measured
        return count + 1
    return count


@part
def run_pass(
    edges_m: Floats, free: Floats, brake: Floats, drive: Drive, sensor: Sensor, law: Rule,
    entry_m_s: float, first_sample_s: float, noise_z: NDArray[np.float32], events: Floats, known: NDArray[np.float32],
) -> Any:  # fmt: skip
    """One pass from where the regulator acts to the exit; returns (v, time, status, switchings, events).

    A pressure, stage or speed in `events` holds from its time on; the last event is the end of the pass. `known` (16,)
    is memory for the estimator.
    """
    table, lower, upper, start_m, spacing_m, farthest, lead_s, filter_s = law
    mode_kpa, command, chain_mode, chain_samples, chain_kpa, substeps, mode, stage, entrance_stage = drive
    period, part = sensor.period_s, sensor.period_s / substeps
    tabled, estimating = table.stages > 0, table.breaks > 0
    known[:], passed_kpa = 0.0, 0.0
    top = command.shape[1] - 1
    gain, longest = period / (period + filter_s), int(LONGEST_PASS_S / period)
    sample, switchings, slope, before = 0, 0, 0.0, math.nan
    kpa = mode_kpa[mode]
    count = note(events, 0, 0.0, edges_m[0], entry_m_s, kpa, stage, math.nan)
    cell, s, v, time, status = advance(edges_m, free, brake, kpa, first_sample_s, 0, edges_m[0], entry_m_s)
    chain, played = -1, 0
    # One turn of the loop is one sampling period, at rest or within a chain.
    while status == MOVING and (chain >= 0 or sample < longest):
        measured = math.nan
        if chain < 0 or lead_s != 0.0 or estimating:  # within a chain only filters look at the sensor
            measured = measure(v, noise_z[sample % noise_z.shape[0]], sensor)
        if lead_s != 0.0:
            if not math.isnan(measured - before):  # neither at the first sample nor beside a missing reading
                slope += gain * ((measured - before) / period - slope)
            before = measured
        if estimating:
            estimated = float(estimated_speed(table, known, s, measured, passed_kpa))
            measured = estimated if chain < 0 else math.nan  # compared, and noted, only at rest
        if chain < 0:
            if tabled:
                wanted = stage_by_table(table, stage, s, measured, math.nan)
            else:
                ahead = measured + lead_s * slope
                wanted = stage_by_lines(lower, upper, start_m, spacing_m, farthest, stage, top, s, ahead)
            wanted = admitted(stage, wanted, s, entrance_stage)
            if wanted != stage:
                chain, played, stage = command[mode, wanted], 0, wanted
                switchings += 1
        if chain < 0:
            kpa = mode_kpa[mode]
            passed_kpa = kpa
            count = note(events, count, time, s, v, kpa, stage, measured)
            cell, s, v, used, status = advance(edges_m, free, brake, kpa, period, cell, s, v)
        else:
            i, at = 0, played * substeps
            passed_kpa = chain_kpa[chain, at : at + substeps].mean() if estimating else 0.0
            while i < substeps and status == MOVING:
                first = i
                kpa = chain_kpa[chain, at + i]
                while i < substeps and chain_kpa[chain, at + i] == kpa:
                    i += 1  # dead times and rests are one step
                time = impulse_time_s(first_sample_s, sample, period) + first * part
                count = note(events, count, time, s, v, kpa, stage, measured)
                measured = math.nan
                cell, s, v, used, status = advance(edges_m, free, brake, kpa, (i - first) * part, cell, s, v)
            played += 1
            if played == chain_samples[chain]:
                mode, chain = chain_mode[chain], -1
        sample += 1
        if status == MOVING:
            time = impulse_time_s(first_sample_s, sample, period)
        else:
            time += used
    count = note(events, count, time, s, v, kpa, stage, math.nan)
    return v, time, status, switchings, count


@kernel
def brake_rows(path: Path, cut_factor: Floats, path_z: NDArray[np.float32], rows: Floats) -> None:
    """Deceleration by one kPa in every cell of every pass, `rows` (n, C): β·ξ_cut·(1 + η), η from cell to cell.

    Before the entrance nothing brakes and no number is used up: the same cut meets the same η with any approach.
    """
    # Several passes at once: a pass alone would wait for each cell's η before the next.
    x, cells, before = np.empty(TOGETHER), rows.shape[1], path.approach_cells
    rows[:, :before] = 0.0
    for first in range(0, rows.shape[0], TOGETHER):
        x[:] = 0.0
        passes = min(TOGETHER, rows.shape[0] - first)
        for j in range(before, cells):
            memory, fresh, std, brake = (
                path.eta_memory[j],
                path.eta_fresh[j],
                path.eta_std[j],
                path.brake_m_s2_per_kpa[j],
            )
            for k in range(passes):
                x[k] = memory * x[k] + fresh * path_z[first + k, j - before]
                factor = cut_factor[first + k] * max(0.0, 1.0 + std * x[k])  # bars do not push
                rows[first + k, j] = brake * factor


@kernel
def run_passes(path: Path, drive: Drive, sensor: Sensor, law: Rule, draws: Draws, exits: Exits, events: Floats) -> int:
    """Simulate all passes of `draws` into `exits`; returns the number of events of the last pass."""
    gravity, brakes = path.gravity_m_s2, draws.brake_m_s2_per_kpa
    free, known = np.empty(gravity.shape[0]), np.empty(16, np.float32)
    count = 0
    for i in range(draws.cut_factor.shape[0]):
        drag = path.drag_m_s2_per_n_kn * draws.resistance_n_kn[i]
        for j in range(free.shape[0]):
            free[j] = gravity[j] - drag
        v, time, status, switchings, count = run_pass(
            path.edges_m, free, brakes[i], drive, sensor, law,
            draws.entry_m_s[i], draws.first_sample_s[i], draws.noise_z[i], events, known,
        )  # fmt: skip
        exits.stalled[i] = status != LEFT
        exits.speed_m_s[i] = v if status == LEFT else 0.0
        exits.time_s[i] = time
        exits.switchings[i] = switchings
    return count
