"""The closed loop once more, written plainly: one pass after the other, one sampling period after the other.

Against the kernels of the product, which move passes side by side from piece to piece, every bit of exits and traces
must be the same. Measuring, the rules of the tables and the motion over a piece are the product's own functions.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from scripts.studies.any_time.kernels.rolled_period import roll_period
from synth.kernels.any_time.any_time_law import AnyTimeLaw, wanted_stage
from synth.kernels.any_time.driven_period import SampledDrive, play_period
from synth.kernels.compiling import kernel, part
from synth.kernels.loop.drive import Drive
from synth.kernels.loop.motion import LEFT, MOVING, Cells, Path, advance
from synth.kernels.loop.passes import LONGEST_PASS_S, Draws, Exits
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
from synth.kernels.loop.trace import EVENT_FIELDS, note
from synth.simulation.closed_loop import ClosedLoop, empty_exits, sample_of
from synth.simulation.controllers import Regulator
from synth.simulation.passes import ExitSample

Floats = NDArray[np.float64]

compiled: Callable[[Callable[..., int]], Callable[..., int]] = kernel


def one_by_one(loop: ClosedLoop, controller: Regulator, draws: Draws) -> ExitSample:
    """What `ClosedLoop.run` gives."""
    return run(loop, controller, draws, np.empty((0, EVENT_FIELDS)))[0]


def events_of(loop: ClosedLoop, controller: Regulator, draws: Draws) -> Floats:
    """The events that `ClosedLoop.follow` notes of the only pass, (n, `EVENT_FIELDS`)."""
    return run(loop, controller, draws, np.empty((100_000, EVENT_FIELDS)))[1]


def run(loop: ClosedLoop, controller: Regulator, draws: Draws, events: Floats) -> tuple[ExitSample, Floats]:
    """All passes, and the events of the last."""
    law, exits = controller.law(), empty_exits(len(draws.cut_factor))
    if isinstance(law, AnyTimeLaw):
        count = run_any_time_passes(loop.path, loop.sampled, loop.sensor, law, draws, exits, events)
    else:
        count = run_passes(loop.path, loop.drive, loop.sensor, law, draws, exits, events)
    return sample_of(exits, draws), events[:count]


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


@compiled
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


@part
def run_any_time_pass(
    edges_m: Floats, free: Floats, brake: Floats, drive: SampledDrive, sensor: Sensor, law: AnyTimeLaw,
    entry_m_s: float, first_sample_s: float, noise_z: NDArray[np.float32], events: Floats, known: NDArray[np.float32],
    over: Floats,
) -> Any:  # fmt: skip
    """One pass from where the regulator acts to the exit; returns (v, time, status, switchings, events).

    `known` (16,) is memory for the estimator, `over` (parts,) for the overpressures of a period.
    """
    table = law.rule.table
    estimating = table.breaks > 0
    lead_s, gain = law.rule.lead_s, sensor.period_s / (sensor.period_s + law.rule.filter_s)
    known[:], passed_kpa, slope, last = 0.0, 0.0, 0.0, math.nan
    stage_kpa, touch = drive.stage_kpa, drive.valves.touch_kpa
    period, top, longest = sensor.period_s, stage_kpa.shape[0] - 1, int(LONGEST_PASS_S / sensor.period_s)
    part = period / drive.parts
    pressure, wait, stage, sample, switchings = drive.initial_kpa, 0.0, drive.initial_stage, 0, 0
    kpa = max(0.0, pressure - touch)
    count = note(events, 0, 0.0, edges_m[0], entry_m_s, kpa, stage, math.nan)
    cell, s, v, time, status = advance(edges_m, free, brake, kpa, first_sample_s, 0, edges_m[0], entry_m_s)
    while status == MOVING and sample < longest:
        measured = measure(v, noise_z[sample % noise_z.shape[0]], sensor)
        if estimating:
            measured = float(estimated_speed(table, known, s, measured, passed_kpa))
        if not math.isnan(measured - last):  # neither at the first sample nor beside a missing reading
            slope += gain * ((measured - last) / period - slope)
        last = measured
        wanted = wanted_stage(law, stage, top, pressure, s, measured + lead_s * slope)
        before, stage = stage, admitted(stage, wanted, s, drive.entrance_stage)
        if stage != before:
            switchings += 1
        pressure, wait = play_period(
            pressure, wait, stage_kpa[before], stage_kpa[stage], drive.computing_delay_s, period, drive.valves, over
        )
        passed_kpa = over.mean() if estimating else 0.0
        cell, s, v, kpa, time, used, status, count = roll_period(
            Cells(edges_m, free, brake), over, part, first_sample_s + sample * period, stage, measured, cell, s, v,
            events, count,
        )  # fmt: skip
        sample += 1
        if status == MOVING:
            time = first_sample_s + sample * period  # not by summing up: the clock must not drift
        else:
            time += used
    count = note(events, count, time, s, v, kpa, stage, math.nan)
    return v, time, status, switchings, count


@compiled
def run_any_time_passes(
    path: Path, drive: SampledDrive, sensor: Sensor, law: AnyTimeLaw, draws: Draws, exits: Exits, events: Floats
) -> int:
    """Simulate all passes of `draws` into `exits`; returns the number of events of the last pass."""
    free, known, over = np.empty(path.gravity_m_s2.shape[0]), np.empty(16, np.float32), np.empty(drive.parts)
    count = 0
    for i in range(draws.cut_factor.shape[0]):
        drag = path.drag_m_s2_per_n_kn * draws.resistance_n_kn[i]
        for j in range(free.shape[0]):
            free[j] = path.gravity_m_s2[j] - drag
        v, time, status, switchings, count = run_any_time_pass(
            path.edges_m, free, draws.brake_m_s2_per_kpa[i], drive, sensor, law,
            draws.entry_m_s[i], draws.first_sample_s[i], draws.noise_z[i], events, known, over,
        )  # fmt: skip
        exits.stalled[i] = status != LEFT
        exits.speed_m_s[i] = v if status == LEFT else 0.0
        exits.time_s[i] = time
        exits.switchings[i] = switchings
    return count
