"""Passes of a plant whose brake or cuts follow a law that the model has not, of a known size.

The simulator has one deceleration for each cell of the path. So a pass is run again and again, each time with the
decelerations that follow from its last speeds, until they stay: then it is the pass of the other law.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from synth.kernels.loop.passes import Draws
from synth.simulation.closed_loop import ClosedLoop
from synth.simulation.controllers import Controller
from synth.simulation.logged_passes import rows_of_pass
from synth.simulation.passes import PassTrace

Floats = NDArray[np.float64]

USUAL_M_S, USUAL_KPA = 4.0, 300.0
MOST_RUNS, SAME = 100, 1e-9
"""Runs of one pass, and how near to each other the relative changes of two of them are in the end."""


@dataclass(frozen=True)
class OtherLaws:
    """Relative changes: of friction and of running resistance by each m/s above 4 m/s, of the force at 600 kPa."""

    friction_by_speed: float = 0.0
    resistance_by_speed: float = 0.0
    force_by_pressure: float = 0.0

    def rows_of_pass(self, loop: ClosedLoop, controller: Controller, draws: Draws, number: int) -> Floats:
        """As that of `logged_passes`, under these laws."""
        one = Draws._make(part[number : number + 1] for part in draws)
        lawful, own = self.settled(loop, controller, one)
        return rows_of_pass(lawful, controller, own, 0)

    def settled(self, loop: ClosedLoop, controller: Controller, one: Draws) -> tuple[ClosedLoop, Draws]:
        """Loop and draws of one pass in which every cell has these laws at the speed with which it is passed."""
        bent = replace(loop, drive=loop.drive._replace(
            mode_overpressure_kpa=self.bent(loop.drive.mode_overpressure_kpa),
            chain_overpressure_kpa=self.bent(loop.drive.chain_overpressure_kpa),
        ))  # fmt: skip
        middle = 0.5 * (loop.path.edges_m[1:] + loop.path.edges_m[:-1])
        drag = loop.path.drag_m_s2_per_n_kn * float(one.resistance_n_kn[0])
        now, own, before = bent, one, np.full(len(middle), np.inf)
        for _ in range(MOST_RUNS):
            above = speeds_at(middle, now.follow(controller, own)) - USUAL_M_S
            if np.max(np.abs(above - before)) < SAME:
                return now, own
            before = above
            slopes = one.brake_m_s2_per_kpa * (1.0 + self.friction_by_speed * above)
            gravity = loop.path.gravity_m_s2 - drag * self.resistance_by_speed * above
            own = one._replace(brake_m_s2_per_kpa=read_only(slopes))
            now = replace(bent, path=loop.path._replace(gravity_m_s2=read_only(gravity)))
        raise AssertionError(f"a pass does not settle within {MOST_RUNS} runs")

    def bent(self, overpressure_kpa: Floats) -> Floats:
        """The overpressure that brakes as these laws say where the force is straight in it."""
        return read_only(overpressure_kpa * (1.0 + self.force_by_pressure * (overpressure_kpa / USUAL_KPA - 1.0)))


def speeds_at(path_m: Floats, trace: PassTrace) -> Floats:
    """Speed of a pass at places; beyond its end, that of the end."""
    return np.asarray(np.interp(path_m, trace.path_m, trace.speed_m_s))


def read_only(values: Floats) -> Floats:
    """As the kernels know their arrays."""
    values.setflags(write=False)
    return values
