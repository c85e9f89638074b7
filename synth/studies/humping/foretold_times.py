"""Passes as long as a control foretells them of positions that brake early, whatever the exit speeds are."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from synth.yard.humping.hump_position import Arrivals, Floats, HumpPosition, Passed
from synth.yard.humping.trial import BrakeHead, HumpTrial

LEAST_SHARE = 0.05
"""Of a path on which a cut is braked, as in the kernel `exit_choices`."""


@dataclass(frozen=True)
class ForetoldTimes:
    """The exit speeds of `position`; its passes last as long as `early_s` tells.

    `head_m`: what the control trusts the brake to take.
    """

    position: HumpPosition
    head_m: BrakeHead

    brakes_early = True

    def passed(self, arrivals: Arrivals) -> Passed:
        """See `HumpPosition`."""
        passed = self.position.passed(arrivals)
        head = self.head_m(arrivals.mass_t, arrivals.axles, arrivals.category)
        return replace(passed, time_s=early_s(arrivals, passed.exit_m_s, head))


def early_s(arrivals: Arrivals, exit_m_s: Floats, head_m: Floats) -> Floats:
    """Time (m,) of passes that are braked by `head_m` on the whole path until they have the exit speed, and hold it
    then; infinite where the cut stops."""
    entry, moves = arrivals.entry_m_s, (exit_m_s > 0.0) & (arrivals.entry_m_s > 0.0)
    needed = arrivals.unbraked_exit_m_s**2 - exit_m_s**2
    share = np.clip(needed / (2.0 * arrivals.reduced_gravity_m_s2 * head_m), LEAST_SHARE, 1.0)
    exits = np.where(moves, exit_m_s, 1.0)
    time = arrivals.path_m * (2.0 * share / (entry + exits) + (1.0 - share) / exits)
    return np.where(moves, time, np.inf)


def with_foretold_times(trial: HumpTrial) -> HumpTrial:
    """The trial with such passes in all positions."""
    both = zip(trial.positions, trial.usable_heads_m, strict=True)
    return replace(trial, positions=tuple(ForetoldTimes(position, head) for position, head in both))
