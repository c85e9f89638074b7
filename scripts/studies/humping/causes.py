"""Why cuts couple above 2 m/s: what the last position could not do, and what its commands did not know."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from synth.hump.trains.outcomes import USUAL_COUPLINGS
from synth.hump.trains.trial import HumpTrial

FAST_M_S = USUAL_COUPLINGS.harmful_m_s
NOT_HELD_STDS = 3.0
"""A cut that leaves so many standard deviations above its command was not held by the full brake."""


@dataclass(frozen=True)
class Causes:
    """Of `cuts`, `fast` coupled above 2 m/s: `rolling` to a cut that still rolled; of the others `not_held` by the last
    position; of the others `lowest` had the lowest command that there is; the `rest` rolled better than most."""

    cuts: int
    fast: int
    rolling: int
    not_held: int
    lowest: int
    rest: int


def causes(trial: HumpTrial, std_m_s: float, trains: int) -> Causes:
    """Those of the first `trains`; `std_m_s`: of the last position. Cuts in contact are not counted."""
    humped, _, memory = trial.humped(0, trains)
    none = trial.routes.elements
    fast = (memory.end_speed_m_s > FAST_M_S) & (memory.misrouted_at == none) & (memory.contact_at == none)
    rolling = fast & memory.caught_on_track
    command = memory.command_m_s[:, :, -1]
    category = humped.category.reshape(command.shape)
    with np.errstate(invalid="ignore"):  # a cut that never came to the position
        above = memory.exit_m_s[:, :, -1] > command + NOT_HELD_STDS * std_m_s
        at_lowest = command <= trial.aim.lowest_by_table_m_s[trial.aim.group[memory.route], category]
    not_held = fast & ~rolling & above
    lowest = fast & ~rolling & ~above & at_lowest
    of_all, of_rolling, of_not_held, of_lowest = (int(each.sum()) for each in (fast, rolling, not_held, lowest))
    return Causes(fast.size, of_all, of_rolling, of_not_held, of_lowest, of_all - of_rolling - of_not_held - of_lowest)
