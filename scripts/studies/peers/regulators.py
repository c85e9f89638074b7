"""The peers of a table: a predictive controller, and a PI regulator with pulse width, as their kernel takes them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from scripts.studies.peers.kernels.peer_loop import BY_PREDICTION, BY_PULSES, Peer
from scripts.studies.peers.kernels.prediction import Prediction
from scripts.studies.peers.kernels.pulses import Pulses
from synth.kernels.any_time.any_time_law import AnyTimeLaw
from synth.simulation.closed_loop import ClosedLoop, LineController
from synth.simulation.controllers import fixed
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
