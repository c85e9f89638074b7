"""The entry speeds that a position can serve for a target, whatever table it is given."""

from __future__ import annotations

import numpy as np

from plant_models.frozen_arrays import Floats, frozen_arrays
from synth.retarder.tuned_case import Feasibility
from synth.simulation.closed_loop import picked
from synth.simulation.common_passes import CommonPasses, ExitRange, exit_range
from synth.simulation.controllers import fixed
from synth.simulation.exit_statistics import excess_and_lack_m_s

ENTRY_POINTS, ENTRY_PASSES = 24, 500
"""Entry speeds that are looked at, and passes at each of them: the same, but for the speed."""

LOWEST_ENTRY_M_S = 0.5
"""Slower cuts are not looked at: one that is served from here on may be served from further below."""


@frozen_arrays
class EntrySweep:
    """What a position can do to the same cuts at entry speeds up to its highest, whatever the target.

    `entry_m_s` (P,); `exits`: the passes of P·n cuts, those of one entry speed side by side.
    """

    entry_m_s: Floats
    exits: ExitRange

    def unavoidable_rms_m_s(self, target_m_s: float) -> Floats:
        """(P,): rms of the error that no regulator avoids, by entry speed."""
        excess, lack = excess_and_lack_m_s(self.exits.slowest, self.exits.fastest, target_m_s)
        squares = (excess + lack).reshape(len(self.entry_m_s), -1) ** 2
        weight = self.exits.slowest.weight[: squares.shape[1]]
        rms: Floats = np.sqrt(squares @ weight / weight.sum())
        return rms


def entry_sweep(passes: CommonPasses, count: int = ENTRY_PASSES) -> EntrySweep:
    """The first `count` of `passes` at each entry speed."""
    plant = passes.plant
    entry = np.linspace(LOWEST_ENTRY_M_S, plant.position.max_entry_speed_m_s, ENTRY_POINTS)
    few = passes.first(count).draws
    each = picked(few, np.tile(np.arange(len(few.weight)), ENTRY_POINTS))
    start_m_s = plant.start_speed_m_s(np.repeat(entry, len(few.weight)), each.resistance_n_kn)
    at_entry = each._replace(entry_m_s=fixed(start_m_s, np.float64))
    return EntrySweep(entry, exit_range(passes.loop(plant.top_stage + 1), at_entry))


def feasibility_of(sweep: EntrySweep, target_m_s: float, limit_m_s: float) -> Feasibility:
    """What the position can do for a target by entry speed, in a `sweep`."""
    rms = sweep.unavoidable_rms_m_s(target_m_s)
    return Feasibility(
        limit_m_s=limit_m_s,
        entry_m_s=sweep.entry_m_s,
        entry_rms_m_s=rms,
        served_m_s=served(sweep.entry_m_s, rms, limit_m_s),
    )


def served(entry_m_s: Floats, rms_m_s: Floats, limit_m_s: float) -> tuple[float, float] | None:
    """From the first to the last entry speed at which the rms meets the limit, the rms being linear in between."""
    within = np.nonzero(rms_m_s <= limit_m_s)[0]
    if not len(within):
        return None

    def end(inside: int, outside: int) -> float:
        if not 0 <= outside < len(entry_m_s):
            return float(entry_m_s[inside])
        part = (limit_m_s - rms_m_s[inside]) / (rms_m_s[outside] - rms_m_s[inside])
        return float(entry_m_s[inside] + part * (entry_m_s[outside] - entry_m_s[inside]))

    first, last = int(within[0]), int(within[-1])
    return end(first, first - 1), end(last, last + 1)
