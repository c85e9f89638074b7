"""A position whose brake stays as it is whatever is commanded: stuck released, or stuck at a stage."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from plant_models.errors import require
from plant_models.frozen_arrays import Floats
from synth.hump.trains.hump_position import Arrivals, Passed, evenly_braked_s
from synth.hump.trains.normal_hump_position import LibraryBrake


@dataclass(frozen=True)
class StuckPosition:
    """It takes `taken_head_m` from every cut, metres, evenly along the path, and obeys no command.

    A cut that has less energy stops. As all cuts that stop in a position (`humping`), it then stands at the exit. Held
    by the last position it counts as having reached its track, all of which it leaves free; those behind run into it.
    """

    taken_head_m: Callable[[Arrivals], Floats]

    def passed(self, arrivals: Arrivals) -> Passed:
        """See `HumpPosition`."""
        taken = 2.0 * arrivals.reduced_gravity_m_s2 * self.taken_head_m(arrivals)
        exit_m_s = np.sqrt(np.maximum(arrivals.unbraked_exit_m_s**2 - taken, 0.0))
        return Passed(exit_m_s, evenly_braked_s(arrivals, exit_m_s), np.zeros(len(arrivals), dtype=np.int64))


def released(arrivals: Arrivals) -> Floats:
    """What a brake takes that is stuck released: nothing."""
    return np.zeros(len(arrivals))


@dataclass(frozen=True)
class StuckStage:
    """What `brake` takes that is stuck at `stage`, whatever stages the cuts may be given, at mean friction."""

    brake: LibraryBrake
    stage: int

    def __post_init__(self) -> None:
        top = self.brake.position.top_stage
        require(1 <= self.stage <= top, f"stuck stage: {self.stage}; the position has the stages 1 to {top}")

    def __call__(self, arrivals: Arrivals) -> Floats:
        """Energy head, m."""
        stages = np.full(len(arrivals), self.stage)
        return np.asarray(self.brake.share * self.brake.full.head_m(arrivals.mass_t, arrivals.axles, stages))
