"""The peers of a table (a predictive controller, and a PI regulator with pulse width, as their kernel takes them),
and the closed loop of a plant with one as its regulator.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from plant_models.frozen_arrays import Floats
from plant_models.stage_regulator import resting_modes
from scripts.studies.peers.kernels.peer_loop import BY_PREDICTION, BY_PULSES, Hardware, Peer, run_peer_passes
from scripts.studies.peers.kernels.prediction import MeanPath, Prediction
from scripts.studies.peers.kernels.pulses import Pulses
from synth.kernels.any_time.any_time_law import AnyTimeLaw
from synth.kernels.loop.passes import LONGEST_PASS_S, Draws
from synth.kernels.loop.trace import EVENT_FIELDS
from synth.simulation.closed_loop import ClosedLoop, LineController, empty_exits, sample_of, trace_of
from synth.simulation.controllers import fixed
from synth.simulation.passes import ExitSample, PassTrace
from synth.solver.switching_lines import SwitchingLines
from tuning_tables import Decisions, Estimator
from tuning_tables.held_table import lines_apart

PARTS = 1
"""Of a sampling period, as the predictive controller foresees them; the simulation plays five."""

NO_PREDICTION = Prediction(1.0, 0.0, 0.0, 0.0, 1)
NO_PULSES = Pulses(0.0, 0.0, 0.0, 1.0, 1.0, fixed(np.zeros(2), np.float64))


class PeerRegulator(Protocol):
    """Whatever the loop of the peers can run."""

    def peer(self, loop: ClosedLoop) -> Peer:
        """The regulator as the kernel takes it."""


@dataclass(frozen=True)
class PredictiveController:
    """Holds every stage over a horizon in the known model, and takes the one that ends nearest to an energy line.

    `held_share`: of the highest stage's overpressure, held along the line at the estimated friction; `shift_m_s` is
    added to the target; a command costs `price_m2_s2`, as an error of v². `parts`: steps of the prediction in a
    sampling period.
    """

    target_m_s: float
    decisions: Decisions
    estimator: Estimator
    horizon_s: float
    held_share: float
    shift_m_s: float
    price_m2_s2: float
    parts: int = PARTS

    def peer(self, loop: ClosedLoop) -> Peer:
        """The regulator as the kernel takes it."""
        kpa = self.held_share * float(loop.stage_overpressures_kpa[-1])
        aim = self.target_m_s + self.shift_m_s
        law = Prediction(self.horizon_s, kpa, aim, self.price_m2_s2, self.parts)
        at_rest = self.decisions is Decisions.AT_REST
        return Peer(BY_PREDICTION, no_table(), law, NO_PULSES, at_rest, lines_apart(self.estimator))


@dataclass(frozen=True)
class PulseController:
    """A PI on the error from a speed line of even braking, whose output two neighbouring stages make in turn.

    `held_share`: of the highest stage's overpressure, held along the line at ξ = 1; `gain_per_m_s`: the same share for
    an error of 1 m/s; `integral_s`, `period_s`: of the PI and of the pulses. With `estimator` the error is that of the
    estimated speed, without it that of the measured one.
    """

    target_m_s: float
    decisions: Decisions
    estimator: Estimator | None
    held_share: float
    gain_per_m_s: float
    integral_s: float
    period_s: float

    def peer(self, loop: ClosedLoop) -> Peer:
        """The regulator as the kernel takes it."""
        stages = fixed(loop.stage_overpressures_kpa, np.float64)
        top = float(stages[-1])
        law = Pulses(
            self.held_share * top, self.target_m_s, self.gain_per_m_s * top, self.integral_s, self.period_s, stages
        )
        at_rest = self.decisions is Decisions.AT_REST
        return Peer(BY_PULSES, no_table(), NO_PREDICTION, law, at_rest, lines_apart(self.estimator))


def no_table() -> AnyTimeLaw:
    """A law without a table, for a kernel that does not ask it."""
    lines = LineController(SwitchingLines(np.array([0.0, 1.0]), np.full((2, 2), -np.inf), np.full((2, 2), np.inf)))
    return AnyTimeLaw(lines.rule, 1.0)


@dataclass(frozen=True)
class PeerLoop:
    """A closed loop as the kernel of the peers takes it; build it with `peer_loop`. `path`: what regulators know."""

    loop: ClosedLoop
    hardware: Hardware
    path: MeanPath

    def run(self, regulator: PeerRegulator, draws: Draws) -> ExitSample:
        """All passes of `draws` under `regulator`."""
        return self._passes(regulator, draws, np.empty((0, EVENT_FIELDS)))[0]

    def follow(self, regulator: PeerRegulator, draws: Draws) -> PassTrace:
        """The only pass of `draws`, event by event."""
        samples = math.ceil(LONGEST_PASS_S / self.loop.sensor.period_s + 2) + 1000
        events = np.empty((samples * self.loop.drive.substeps + 2, EVENT_FIELDS))
        sample, events = self._passes(regulator, draws, events)
        return trace_of(events, bool(sample.stalled[0]))

    def _passes(self, regulator: PeerRegulator, draws: Draws, events: Floats) -> tuple[ExitSample, Floats]:
        exits = empty_exits(len(draws.cut_factor))
        peer = regulator.peer(self.loop)
        count = run_peer_passes(self.loop.path, self.hardware, peer, self.path, draws, exits, events)
        return sample_of(exits, draws), events[:count]


def peer_loop(loop: ClosedLoop) -> PeerLoop:
    """`loop` for the peers; raises `PlantError` where its drive cannot be commanded at any time."""
    modes = resting_modes(loop.plant.position, loop.stages - 1)
    rest_kpa = fixed(np.array([kpa for _, kpa in modes]), np.float64)
    return PeerLoop(loop, Hardware(loop.drive, loop.sampled, rest_kpa, loop.sensor), mean_path(loop))


def mean_path(loop: ClosedLoop) -> MeanPath:
    """The path with the mean resistance and ξ = 1, and the work that is left from each edge of its cells."""
    cells, length = loop.path, np.diff(loop.path.edges_m)
    free = cells.gravity_m_s2 - cells.drag_m_s2_per_n_kn * loop.plant.resistance.mean_n_per_kn
    return MeanPath(
        cells.edges_m, fixed(free, np.float64), cells.brake_m_s2_per_kpa, left(free * length),
        left(cells.brake_m_s2_per_kpa * length),
    )  # fmt: skip


def left(work: Floats) -> Floats:
    """From each edge to the exit, (C + 1,), by `work` (C,) of the cells."""
    return fixed(np.append(np.cumsum(work[::-1])[::-1], 0.0), np.float64)
