"""How the cuts of a trial come to one of its positions: some trains are humped to see it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from plant_models.frozen_arrays import Floats
from synth.frame.input_error import InputError
from synth.hump.trains.made_trial import made_trial
from synth.hump.trains.resolved_trial import ResolvedTrial
from synth.kernels.cache import guarded

CUTS: Final = 1000
"""Cuts that are humped, or some more: whole trains."""

BEYOND: Final = 0.01
"""Share of the cuts that may come slower than the entry speeds that are told, and the same faster."""

INNER: Final = (0.1, 0.25, 0.5, 0.75, 0.9)
"""The quantiles between these two at which bins of a histogram meet."""

SHARES: Final = [10, 15, 25, 25, 15, 10]
"""Per cent of the cuts in each bin; in both outer ones lie those beyond them, too."""

LOWEST_M_S: Final = 0.3
"""Nothing slower is told."""

FEWEST: Final = 30
"""Cuts of a category that a histogram can be made of."""


@dataclass(frozen=True)
class Entering:
    """How `cuts` cuts came to a position.

    `low_m_s`, `high_m_s`: entry speeds, but for a few. `of_category`: edges of the bins of a histogram of them, by the
    number of the weight category, where there were enough cuts. `command_m_s`: the highest exit speed that one was
    aimed with, None where none was aimed.
    """

    cuts: int
    low_m_s: float
    high_m_s: float
    of_category: Mapping[int, tuple[float, ...]]
    command_m_s: float | None

    def law(self, category: int, top_target_m_s: float, most_m_s: float) -> dict[str, Any]:
        """The entry speeds of a class of this category as a configuration has them; nothing where those of all cuts
        stand for them. The fastest lie above `top_target_m_s`, for a table asks for that, and not above `most_m_s`."""
        edges = self.of_category.get(category, ())
        if not edges:
            return {}
        last = min(max(edges[-1], top_target_m_s), most_m_s)
        kept = [edge for edge in edges[:-1] if edge < last]
        shares = [*SHARES[: len(kept) - 1], sum(SHARES[len(kept) - 1 :])]
        return {"edges_m_s": [*kept, last], "shares": shares}


def entering_at(place: int, config: ResolvedTrial) -> Entering:
    """How cuts come to the position at `place`; `InputError` where none comes."""
    trains = math.ceil(CUTS / config.settings.trains.cuts)
    humped, _, memory = guarded(made_trial(config).humped, 0, trains)
    speeds, commands = memory.entry_m_s[:, :, place], memory.command_m_s[:, :, place]
    came = np.isfinite(speeds)
    if not came.any():
        raise InputError(f"{config.place}: of {trains} trains no cut comes to position {place + 1}: it needs no tables")
    low, high = np.quantile(speeds[came], [BEYOND, 1.0 - BEYOND])
    aimed = commands[np.isfinite(commands) & config.roles.aims[place][memory.route]]
    category = humped.category.reshape(speeds.shape)
    members = enumerate(config.categories.members)
    return Entering(
        cuts=int(came.sum()),
        low_m_s=max(math.floor(10.0 * low) / 10.0, LOWEST_M_S),
        high_m_s=math.ceil(10.0 * high) / 10.0,
        of_category={m.number: bins_of(speeds[came & (category == row)]) for row, m in members},
        command_m_s=float(aimed.max()) if len(aimed) else None,
    )


def bins_of(speeds_m_s: Floats) -> tuple[float, ...]:
    """Edges of the bins of a histogram; nothing of too few cuts, or of those that come with one speed."""
    if len(speeds_m_s) < FEWEST:
        return ()
    edges = np.quantile(speeds_m_s, [BEYOND, *INNER, 1.0 - BEYOND]).clip(LOWEST_M_S).round(2)
    return tuple(edges.tolist()) if (np.diff(edges) > 0.0).all() else ()
