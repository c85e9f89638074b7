"""The closed loop of a plant with a peer as its regulator."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Floats
from plant_models.stage_regulator import resting_modes
from scripts.studies.peers.kernels.peer_loop import Hardware, run_peer_passes
from scripts.studies.peers.kernels.prediction import MeanPath
from scripts.studies.peers.regulators import PeerRegulator
from synth.kernels.loop.passes import LONGEST_PASS_S, Draws
from synth.kernels.loop.trace import EVENT_FIELDS
from synth.simulation.closed_loop import ClosedLoop, empty_exits, sample_of, trace_of
from synth.simulation.controllers import fixed
from synth.simulation.passes import ExitSample, PassTrace


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
