"""Choices of the exit speeds of a position for cuts of which it is the last one for some, and not for others."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from synth.hump.trains.hump_routes import HumpRoutes

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]


class Choices(Protocol):
    """Exit speeds of a position that are compared."""

    @property
    def most_entry_m_s(self) -> Floats | float:
        """Fastest that a cut may come to the position."""

    @property
    def least_entry_m_s(self) -> Floats | float:
        """Slowest that it may come, so that worse runners than expected come, too."""

    def speeds(self, most_m_s: Floats) -> Floats:
        """(n, choices); a cut cannot be faster than `most_m_s` (n,)."""


@frozen_arrays
@dataclass(frozen=True, eq=False)
class ByRoute:
    """The choices `kept` of a position for cuts whose routes go on to another one; `aim` for those that `aims` (n,),
    since it is the last one of their routes; their own speed for those whose routes have none any more, `gone` (n,)."""

    kept: Choices
    aim: Choices
    aims: Bools
    gone: Bools

    @property
    def most_entry_m_s(self) -> Floats:
        """See `Choices`."""
        most = np.where(self.aims, self.aim.most_entry_m_s, self.kept.most_entry_m_s)
        return np.where(self.gone, np.inf, most)

    @property
    def least_entry_m_s(self) -> Floats:
        """See `Choices`."""
        least = np.where(self.aims, self.aim.least_entry_m_s, self.kept.least_entry_m_s)
        return np.where(self.gone, 0.0, least)

    def speeds(self, most_m_s: Floats) -> Floats:
        """See `Choices`; a cut without choice has its speed as often."""
        found = np.where(self.aims[:, None], self.aim.speeds(most_m_s), self.kept.speeds(most_m_s))
        return np.where(self.gone[:, None], most_m_s[:, None], found)


def choices_by_route(
    routes: HumpRoutes, rows: Ints, position: int, choices: tuple[Choices, ...]
) -> tuple[Choices, ...]:
    """`choices` of the positions from `position` on, the last one of which is the aim, for cuts on the routes `rows`
    (n,)."""
    positions, aim = routes.positions_of[rows], choices[-1]
    places = enumerate(choices, position)
    return tuple(ByRoute(each, aim, positions == place + 1, positions <= place) for place, each in places)
