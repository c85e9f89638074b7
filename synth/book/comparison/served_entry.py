"""The entry speeds that a position can serve for a target, whatever table it is given."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from synth.book.comparison.told_regulator import picked
from synth.book.feasibility import Feasibility
from synth.simulation.common_passes import CommonPasses
from synth.simulation.controllers import fixed
from synth.simulation.exit_range import exit_range
from synth.simulation.unavoidable_error import excess_and_lack_m_s, unavoidable_error

ENTRY_POINTS, ENTRY_PASSES = 16, 1000
"""Entry speeds that are looked at, and passes at each of them: the same, but for the speed."""


def feasibility_of(
    passes: CommonPasses, target_m_s: float, limit_m_s: float, entry_passes: int = ENTRY_PASSES
) -> Feasibility:
    """What the position of `passes` can do for a target; the first `entry_passes` of them at each entry speed."""
    found = passes.exit_range
    entry, rms = unavoidable_by_entry(passes, target_m_s, entry_passes)
    return Feasibility(
        limit_m_s=limit_m_s,
        unavoidable=unavoidable_error(found.slowest, found.fastest, target_m_s),
        entry_m_s=entry,
        entry_rms_m_s=rms,
        served_m_s=served(entry, rms, limit_m_s),
    )


def unavoidable_by_entry(
    passes: CommonPasses, target_m_s: float, entry_passes: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Entry speeds from the target to the position's highest (`ENTRY_POINTS`,), and the rms at each of them."""
    plant = passes.plant
    entry = np.linspace(max(target_m_s, 0.5), plant.position.max_entry_speed_m_s, ENTRY_POINTS)
    few = passes.first(entry_passes).draws
    count = len(few.weight)
    each = picked(few, np.tile(np.arange(count), ENTRY_POINTS))
    start_m_s = plant.start_speed_m_s(np.repeat(entry, count), each.resistance_n_kn)
    found = exit_range(passes.loop(plant.top_stage + 1), each._replace(entry_m_s=fixed(start_m_s, np.float64)))
    excess, lack = excess_and_lack_m_s(found.slowest, found.fastest, target_m_s)
    squares = (excess + lack).reshape(ENTRY_POINTS, count) ** 2
    return entry, np.sqrt(squares @ few.weight / few.weight.sum())


def served(
    entry_m_s: NDArray[np.float64], rms_m_s: NDArray[np.float64], limit_m_s: float
) -> tuple[float, float] | None:
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
