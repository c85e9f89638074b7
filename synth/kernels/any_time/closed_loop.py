"""Kernel of the closed-loop simulation where a command may be given at every sample.

Cut, sensor, random numbers and the motion itself are those of `kernels.closed_loop`; only the drive differs: here its
pressure and waiting valve are followed on, whatever is commanded when.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from synth.kernels.any_time.driven_period import play_period
from synth.kernels.compiling import kernel, part, part_inline
from synth.kernels.loop.closed_loop import LEFT, LONGEST_PASS_S, MOVING, Draws, Exits, Floats, Path, advance, note
from synth.kernels.loop.regulator import (
    Rule,
    Sensor,
    admitted,
    estimated_speed,
    measure,
    stage_by_lines,
    stage_by_table,
)


class SampledDrive(NamedTuple):
    """`valves` (`plant_models.valve_drive.ValveDrive`), pressures of the stages (K + 1,).

    A pass begins with `initial_stage` at rest at `initial_kpa`; before the entrance no higher stage than
    `entrance_stage` is commanded.
    """

    valves: Any
    stage_kpa: Floats
    initial_stage: int
    initial_kpa: float
    entrance_stage: int
    computing_delay_s: float
    parts: int


class AnyTimeLaw(NamedTuple):
    """What is asked at every sample: a rule of the locked loop.

    The gauge shows `gauge_factor` times the true pressure; NaN: it shows none.
    """

    rule: Rule
    gauge_factor: float


@part
def wanted_stage(law: AnyTimeLaw, stage: int, top: int, pressure: float, s: float, v: float) -> int:
    """The stage that is wanted at a sample, within 0 … `top`; `v` is the speed that the regulator knows."""
    by = law.rule
    if by.table.stages > 0:
        by_table: int = stage_by_table(by.table, stage, s, v, pressure * law.gauge_factor)
        return by_table
    wanted: int = stage_by_lines(by.lower, by.upper, by.start_m, by.spacing_m, by.farthest, stage, top, s, v)
    return wanted


@part_inline
def joined_until(over: Floats, begun: int) -> int:
    """The part behind those that are played as one step with part `begun`: dead times and rests are one step."""
    i = begun
    while i < over.shape[0] and abs(over[i] - over[begun]) < 1e-9:
        i += 1
    return i


@part_inline
def roll_period(
    edges_m: Floats, free: Floats, brake: Floats, over: Floats, part_s: float, begins_s: float, stage: int,
    measured: float, cell: int, s: float, v: float, events: Floats, count: int,
) -> Any:  # fmt: skip
    """Roll on for a period under `over` (parts,), and note it.

    Returns (cell, s, v, overpressure and time of the last step, what of that was used, status, events).
    """
    i, kpa, used, status, time = 0, 0.0, 0.0, MOVING, begins_s
    while i < over.shape[0] and status == MOVING:
        begun, kpa, i = i, over[i], joined_until(over, i)
        time = begins_s + begun * part_s
        count = note(events, count, time, s, v, kpa, stage, measured)
        measured = math.nan
        cell, s, v, used, status = advance(edges_m, free, brake, kpa, (i - begun) * part_s, cell, s, v)
    return cell, s, v, kpa, time, used, status, count


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
            edges_m, free, brake, over, part, first_sample_s + sample * period, stage, measured, cell, s, v, events,
            count,
        )  # fmt: skip
        sample += 1
        if status == MOVING:
            time = first_sample_s + sample * period  # not by summing up: the clock must not drift
        else:
            time += used
    count = note(events, count, time, s, v, kpa, stage, math.nan)
    return v, time, status, switchings, count


@kernel
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
