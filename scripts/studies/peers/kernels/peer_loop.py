"""Kernel of the closed loop with a peer as its regulator, asked at rest or at every sample.

Cut, sensor, drives and motion are those of `kernels.loop.closed_loop` and `kernels.any_time.closed_loop`. A table may
be the regulator too: then the loop gives the exits of those kernels bit for bit, at rest and at any time.
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Floats
from scripts.studies.any_time.kernels.rolled_period import roll_period
from scripts.studies.peers.kernels.observed_motion import KNOWN, observed
from scripts.studies.peers.kernels.prediction import MeanPath, Prediction, stage_by_prediction
from scripts.studies.peers.kernels.pulses import STATE, Pulses, begin_pulses, stage_by_pulses
from synth.kernels.any_time.any_time_law import AnyTimeLaw, wanted_stage
from synth.kernels.any_time.driven_period import SampledDrive, play_period
from synth.kernels.compiling import kernel, part
from synth.kernels.loop.drive import Drive
from synth.kernels.loop.motion import LEFT, MOVING, Cells, Path, advance
from synth.kernels.loop.passes import LONGEST_PASS_S, Draws, Exits
from synth.kernels.loop.regulator import Sensor, admitted, measure
from synth.kernels.loop.trace import note
from tuning_tables.programs.held import LineTable

BY_TABLE, BY_PREDICTION, BY_PULSES = 0, 1, 2


class Peer(NamedTuple):
    """A regulator: `kind` says which of the three laws decides; the other two are not looked at.

    `at_rest`: commanded only where the last command is carried out. If `observer` has an estimator, the law gets the
    estimated speed, and the prediction the estimated friction; else the measured speed, and ξ = 1.
    """

    kind: int
    table: AnyTimeLaw
    prediction: Prediction
    pulses: Pulses
    at_rest: bool
    observer: LineTable


class Hardware(NamedTuple):
    """The same drive twice, as it is simulated with commands at rest and at any time; `rest_kpa` (H,): of its modes."""

    locked: Drive
    sampled: SampledDrive
    rest_kpa: Floats
    sensor: Sensor


class Memory(NamedTuple):
    """What a pass writes into: state of the estimator, overpressures of a period, the same predicted, pulses."""

    known: NDArray[np.float32]
    over: Floats
    ahead: Floats
    pulses: Floats


@part
def wanted_by(
    peer: Peer, path: MeanPath, hardware: Hardware, stage: int, may: bool, pressure: float, wait: float, factor: float,
    cell: int, s: float, v: float, memory: Memory,
) -> int:  # fmt: skip
    """The stage that the law wants; `may`: whether it can be commanded now. Pulses go on where it cannot."""
    period = hardware.sensor.period_s
    if peer.kind == BY_PULSES:
        pulsed: int = stage_by_pulses(peer.pulses, path, period, stage, cell, s, v, memory.pulses)
        return pulsed
    if not may:
        return stage
    if peer.kind == BY_PREDICTION:
        predicted: int = stage_by_prediction(
            peer.prediction, path, hardware.sampled, period, stage, pressure, wait, factor, cell, s, v, memory.ahead
        )
        return predicted
    tabled: int = wanted_stage(peer.table, stage, hardware.sampled.stage_kpa.shape[0] - 1, pressure, s, v)
    return tabled


@part
def play_locked(drive: Drive, mode: int, chain: int, played: int, over: Floats) -> Any:
    """A period of the drive that is commanded at rest into `over`; (mode, chain, periods played) at its end."""
    if chain < 0:
        over[:] = drive.mode_overpressure_kpa[mode]
        return mode, chain, played
    at = played * drive.substeps
    for i in range(drive.substeps):
        over[i] = drive.chain_overpressure_kpa[chain, at + i]
    played += 1
    if played == drive.chain_samples[chain]:
        return drive.chain_mode[chain], -1, 0
    return mode, chain, played


@part
def run_peer_pass(
    cells: Cells, hardware: Hardware, peer: Peer, path: MeanPath, entry_m_s: float, first_sample_s: float,
    noise_z: NDArray[np.float32], memory: Memory, events: Floats,
) -> Any:  # fmt: skip
    """One pass from where the regulator acts to the exit; returns (v, time, status, switchings, events)."""
    edges_m, free, brake = cells
    locked, drive, sensor, over = hardware.locked, hardware.sampled, hardware.sensor, memory.over
    stage_kpa, estimating = drive.stage_kpa, peer.observer.breaks > 0
    period, longest = sensor.period_s, int(LONGEST_PASS_S / sensor.period_s)
    memory.known[:], passed_kpa, factor = 0.0, 0.0, 1.0
    begin_pulses(memory.pulses)
    pressure, wait, stage, sample, switchings = drive.initial_kpa, 0.0, drive.initial_stage, 0, 0
    mode, chain, played = locked.initial_mode, -1, 0
    kpa = locked.mode_overpressure_kpa[mode]
    count = note(events, 0, 0.0, edges_m[0], entry_m_s, kpa, stage, math.nan)
    cell, s, v, time, status = advance(edges_m, free, brake, kpa, first_sample_s, 0, edges_m[0], entry_m_s)
    while status == MOVING and (chain >= 0 or sample < longest):
        speed = measure(v, noise_z[sample % noise_z.shape[0]], sensor)
        if estimating:
            speed, factor = observed(peer.observer, memory.known, s, speed, passed_kpa)
        may, before = not peer.at_rest or chain < 0, stage
        wanted = stage
        if speed >= 0.0:  # neither a missing reading nor an estimate that has not begun
            wanted = wanted_by(peer, path, hardware, stage, may, pressure, wait, factor, cell, s, speed, memory)
        if may:
            stage = admitted(stage, wanted, s, drive.entrance_stage)
        if stage != before:
            switchings += 1
        if peer.at_rest:
            if stage != before:
                chain, played = locked.command[mode, stage], 0
            moves = chain >= 0
            mode, chain, played = play_locked(locked, mode, chain, played, over)
            pressure = hardware.rest_kpa[mode]
            passed_kpa = over.mean() if moves else over[0]  # the mean of equal numbers may round
        else:
            pressure, wait = play_period(
                pressure, wait, stage_kpa[before], stage_kpa[stage], drive.computing_delay_s, period, drive.valves, over
            )
            passed_kpa = over.mean()
        begins_s = first_sample_s + sample * period
        cell, s, v, kpa, time, used, status, count = roll_period(
            cells, over, period / drive.parts, begins_s, stage, speed, cell, s, v, events, count
        )
        sample += 1
        if status == MOVING:
            time = first_sample_s + sample * period  # not by summing up: the clock must not drift
        else:
            time += used
    count = note(events, count, time, s, v, kpa, stage, math.nan)
    return v, time, status, switchings, count


@kernel
def run_peer_passes(
    cells: Path, hardware: Hardware, peer: Peer, path: MeanPath, draws: Draws, exits: Exits, events: Floats
) -> int:
    """Simulate all passes of `draws` into `exits`; returns the number of events of the last pass."""
    free, count = np.empty(cells.gravity_m_s2.shape[0]), 0
    memory = Memory(
        np.empty(KNOWN, np.float32), np.empty(hardware.sampled.parts), np.empty(peer.prediction.parts), np.empty(STATE)
    )
    for i in range(draws.cut_factor.shape[0]):
        drag = cells.drag_m_s2_per_n_kn * draws.resistance_n_kn[i]
        for j in range(free.shape[0]):
            free[j] = cells.gravity_m_s2[j] - drag
        v, time, status, switchings, count = run_peer_pass(
            Cells(cells.edges_m, free, draws.brake_m_s2_per_kpa[i]), hardware, peer, path, draws.entry_m_s[i],
            draws.first_sample_s[i], draws.noise_z[i], memory, events,
        )  # fmt: skip
        exits.stalled[i] = status != LEFT
        exits.speed_m_s[i] = v if status == LEFT else 0.0
        exits.time_s[i] = time
        exits.switchings[i] = switchings
    return count
