"""Where standing cars are: metres from the crest, or metres of free roll behind the park position."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from plant_models.frozen_arrays import Floats
from synth.aim.scene import SceneCuts


class Places(Protocol):
    """Some places at which cuts meet standing cars."""

    @property
    def metres(self) -> tuple[float, ...]:
        """What names the places."""

    def arrivals_m(self, cuts: SceneCuts) -> Floats:
        """Where the head of each cut meets the standing cars, (n, places)."""


@dataclass(frozen=True)
class FromCrest:
    """Standing cars `metres` from the crest, as Kozachenko counts. A cut too long for that couples as it is let go."""

    metres: tuple[float, ...]

    def arrivals_m(self, cuts: SceneCuts) -> Floats:
        """At least where the head is when the last axle leaves the position."""
        return np.asarray(np.maximum(np.asarray(self.metres)[None, :], cuts.release_m[:, None]))


@dataclass(frozen=True)
class FreeDistance:
    """Standing cars `metres` ahead of the head when the last axle leaves the position."""

    metres: tuple[float, ...]

    def arrivals_m(self, cuts: SceneCuts) -> Floats:
        """So far on from there."""
        return np.asarray(cuts.release_m[:, None] + np.asarray(self.metres)[None, :])
