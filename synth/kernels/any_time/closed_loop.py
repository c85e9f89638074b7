"""Kernel of the closed-loop simulation where a command may be given at every sample.

Cut, sensor, random numbers and the motion itself are those of `kernels.closed_loop`; only the drive differs: here its
pressure and waiting valve are followed on, whatever is commanded when.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numba import njit
from numpy.typing import NDArray

from synth.kernels.any_time.driven_period import play_period
from synth.kernels.loop.closed_loop import LEFT, LONGEST_PASS_S, MOVING, Draws, Exits, Floats, Path, advance, note
from synth.kernels.loop.regulator import Sensor, admitted, measure


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


class SurfaceLaw(NamedTuple):
    """Rule at a sample: a polynomial of path and pressure, or surfaces on nodes if there is none (size 0).

    `coefficients` (K + 1, 2, 3, r + 1): lower and upper line as a sum over powers 0 … 2 of (P − P_k)/100 kPa, each with
    a polynomial in u, ascending, −1 at `start_m` and 1 at `exit_m`; `has_line` (K + 1, 2); P is taken
    for `gauge_factor` times itself. Surfaces: `lower`, `upper` (K + 1, R, B, N + 1) by stage, wait, pressure node and
    path node, linear in between.
    """

    coefficients: Floats
    has_line: NDArray[np.bool_]
    start_m: float
    exit_m: float
    gauge_factor: float
    lower: Floats
    upper: Floats
    waits_s: Floats
    nodes_kpa: Floats
    spacing_m: float


@njit(cache=True, nogil=True, error_model="numpy", forceinline=True)
def polynomial_line(coefficients: Floats, u: float, x: float) -> float:
    """One line at u and at pressure x above its stage, in 100 kPa."""
    total = 0.0
    for i in range(coefficients.shape[0] - 1, -1, -1):
        value = 0.0
        for power in range(coefficients.shape[1] - 1, -1, -1):
            value = value * u + coefficients[i, power]
        total = total * x + value
    return total


@njit(cache=True, nogil=True, error_model="numpy")
def surface_line(surface: Floats, nodes_kpa: Floats, spacing_m: float, pressure: float, s: float) -> float:
    """Line of `surface` (B, N + 1) at a pressure and a path `s` from its first node.

    Beside an infinite node it is infinite: no command.
    """
    low = min(max(np.searchsorted(nodes_kpa, pressure + 1e-7) - 1, 0), nodes_kpa.shape[0] - 2)
    share = (pressure - nodes_kpa[low]) / (nodes_kpa[low + 1] - nodes_kpa[low])
    place = s / spacing_m
    node = min(int(place), surface.shape[1] - 2)
    x = place - node
    total = 0.0
    for b in range(2):
        weight = share if b == 1 else 1.0 - share
        if abs(weight) < 1e-6:  # on a node its neighbour has no say
            continue
        at: float = surface[low + b, node]
        beyond: float = surface[low + b, node + 1]
        if math.isinf(at):
            return at
        if math.isinf(beyond):
            return beyond
        total += weight * (at + x * (beyond - at))
    return total


@njit(cache=True, nogil=True, error_model="numpy")
def wanted_step(
    law: SurfaceLaw, stage_kpa: Floats, stage: int, pressure: float, wait: float, s: float, v: float
) -> int:
    """−1, 0 or +1 stage."""
    if law.coefficients.shape[0] > 0:
        u = 2.0 * (s - law.start_m) / (law.exit_m - law.start_m) - 1.0
        x = 0.01 * (pressure * law.gauge_factor - stage_kpa[stage])
        if law.has_line[stage, 0] and v < polynomial_line(law.coefficients[stage, 0], u, x):
            return -1
        if law.has_line[stage, 1] and v > polynomial_line(law.coefficients[stage, 1], u, x):
            return 1
        return 0
    w = 0
    for i in range(law.waits_s.shape[0]):
        if abs(law.waits_s[i] - wait) < abs(law.waits_s[w] - wait):
            w = i
    if v < surface_line(law.lower[stage, w], law.nodes_kpa, law.spacing_m, pressure, s - law.start_m):
        return -1
    if v > surface_line(law.upper[stage, w], law.nodes_kpa, law.spacing_m, pressure, s - law.start_m):
        return 1
    return 0


@njit(cache=True, nogil=True, error_model="numpy")
def run_any_time_pass(
    edges_m: Floats, free: Floats, brake: Floats, drive: SampledDrive, sensor: Sensor, law: SurfaceLaw,
    entry_m_s: float, first_sample_s: float, noise_z: NDArray[np.float32], events: Floats,
) -> Any:  # fmt: skip
    """One pass from where the regulator acts to the exit; returns (v, time, status, switchings, events)."""
    stage_kpa, touch = drive.stage_kpa, drive.valves.touch_kpa
    period, top = sensor.period_s, stage_kpa.shape[0] - 1
    over = np.empty(drive.parts)
    part = period / drive.parts
    pressure, wait, stage, sample, switchings = drive.initial_kpa, 0.0, drive.initial_stage, 0, 0
    kpa = max(0.0, pressure - touch)
    count = note(events, 0, 0.0, edges_m[0], entry_m_s, kpa, stage, math.nan)
    cell, s, v, time, status = advance(edges_m, free, brake, kpa, first_sample_s, 0, edges_m[0], entry_m_s)
    while status == MOVING and time < LONGEST_PASS_S:
        measured = measure(v, noise_z[sample % noise_z.shape[0]], sensor)
        step = wanted_step(law, stage_kpa, stage, pressure, wait, s, measured)
        before, stage = stage, admitted(stage, min(max(stage + step, 0), top), s, drive.entrance_stage)
        if stage != before:
            switchings += 1
        pressure, wait = play_period(
            pressure, wait, stage_kpa[before], stage_kpa[stage], drive.computing_delay_s, period, drive.valves, over
        )
        i, used = 0, 0.0
        while i < drive.parts and status == MOVING:
            begun, kpa = i, over[i]
            while i < drive.parts and abs(over[i] - kpa) < 1e-9:
                i += 1  # dead times and rests are one step
            time = first_sample_s + sample * period + begun * part
            count = note(events, count, time, s, v, kpa, stage, measured)
            measured = math.nan
            cell, s, v, used, status = advance(edges_m, free, brake, kpa, (i - begun) * part, cell, s, v)
        sample += 1
        if status == MOVING:
            time = first_sample_s + sample * period  # not by summing up: the clock must not drift
        else:
            time += used
    count = note(events, count, time, s, v, kpa, stage, math.nan)
    return v, time, status, switchings, count


@njit(cache=True, nogil=True, error_model="numpy")
def run_any_time_passes(
    path: Path, drive: SampledDrive, sensor: Sensor, law: SurfaceLaw, draws: Draws, exits: Exits, events: Floats
) -> int:
    """Simulate all passes of `draws` into `exits`; returns the number of events of the last pass."""
    free = np.empty(path.gravity_m_s2.shape[0])
    count = 0
    for i in range(draws.cut_factor.shape[0]):
        drag = path.drag_m_s2_per_n_kn * draws.resistance_n_kn[i]
        for j in range(free.shape[0]):
            free[j] = path.gravity_m_s2[j] - drag
        v, time, status, switchings, count = run_any_time_pass(
            path.edges_m, free, draws.brake_m_s2_per_kpa[i], drive, sensor, law,
            draws.entry_m_s[i], draws.first_sample_s[i], draws.noise_z[i], events,
        )  # fmt: skip
        exits.stalled[i] = status != LEFT
        exits.speed_m_s[i] = v if status == LEFT else 0.0
        exits.time_s[i] = time
        exits.switchings[i] = switchings
    return count
