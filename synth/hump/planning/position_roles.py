"""What each position does with cuts: aims them at the standing cars, keeps them apart, or has a fixed exit speed."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays
from synth.hump.planning.forecast import Choices, Given, SpeedRange


@dataclass(frozen=True)
class Spacing:
    """The exit speed is chosen in `range` so that the cut keeps apart from those ahead of it and behind it."""

    range: SpeedRange

    @property
    def lowest_m_s(self) -> float:
        """The lowest command that is chosen."""
        return self.range.low_m_s

    def choices(self, category: Ints) -> Choices:
        """For cuts of the places `category` (n,) among the weight categories."""
        return self.range

    def fixed_m_s(self, category: Ints) -> Floats | None:
        """Nothing is fixed."""
        return None


@frozen_arrays
class Fixed:
    """The exit speed is that of the weight category, `speed_m_s` (categories,), whoever is ahead or behind.

    `most_entry_m_s`: fastest that cuts may come to the position.
    """

    speed_m_s: Floats
    most_entry_m_s: float = np.inf

    @property
    def lowest_m_s(self) -> float:
        """Nothing is chosen."""
        return np.nan

    def choices(self, category: Ints) -> Choices:
        """For cuts of the places `category` (n,) among the weight categories."""
        return Given(self.speed_m_s[category], self.most_entry_m_s)

    def fixed_m_s(self, category: Ints) -> Floats | None:
        """What is commanded, (n,)."""
        return np.asarray(self.speed_m_s[category])


Exits = Spacing | Fixed
"""What a position does with cuts that it does not aim."""


@frozen_arrays
class ByRoute:
    """The choices `aim` for the cuts that are aimed, `aims` (n,); `kept` for the others."""

    kept: Choices
    aim: Choices
    aims: Bools

    @property
    def most_entry_m_s(self) -> Floats:
        """See `Choices`."""
        return np.where(self.aims, self.aim.most_entry_m_s, self.kept.most_entry_m_s)

    @property
    def least_entry_m_s(self) -> Floats:
        """See `Choices`."""
        return np.where(self.aims, self.aim.least_entry_m_s, self.kept.least_entry_m_s)

    def speeds(self, most_m_s: Floats) -> Floats:
        """See `Choices`."""
        return np.where(self.aims[:, None], self.aim.speeds(most_m_s), self.kept.speeds(most_m_s))


@frozen_arrays
class Roles:
    """The roles of the positions, in order from the crest.

    `exits`: of each position, for cuts that it does not aim. `aims` (positions, routes): on which routes it aims in
    place of that. `held` (positions, routes): which routes have the position at all.
    """

    exits: tuple[Exits, ...]
    aims: Bools
    held: Bools

    @cached_property
    def not_of_all(self) -> tuple[int, ...]:
        """The positions that do not aim all cuts that come to them."""
        return tuple(np.flatnonzero((self.held & ~self.aims).any(axis=1)).tolist())

    @cached_property
    def aimed_rows(self) -> tuple[int, ...]:
        """The routes on which a position aims."""
        return tuple(np.flatnonzero(self.aims.any(axis=0)).tolist())

    def aimed(self, kept: tuple[Choices, ...], routes: Ints, aim: Given, position: int = 0) -> tuple[Choices, ...]:
        """The choices of the positions from `position` on for cuts on `routes` (n,): `aim` where they are aimed, else
        those in `kept`."""
        return tuple(self._at(place, each, routes, aim) for place, each in enumerate(kept, position))

    def _at(self, position: int, kept: Choices, routes: Ints, aim: Given) -> Choices:
        aims, held = self.aims[position][routes], self.held[position][routes]
        if not aims.any():
            return kept
        return aim if aims[held].all() else ByRoute(kept, aim, aims)
