"""What a position makes of a commanded exit speed: exactly it, nearly it, or what a simulated table leaves."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.special import ndtri

from plant_models.errors import require_between
from plant_models.frozen_arrays import Floats, frozen_arrays
from plant_models.rolling.random_numbers import Purpose
from synth.aim.scene import SceneCuts


class ExitSpeeds(Protocol):
    """What n cuts make of any command; the draws are fixed, so two commands can be compared cut by cut."""

    def at(self, commanded_m_s: Floats) -> Floats:
        """Exit speed of each cut that is commanded `commanded_m_s` (n,), never less than 0."""

    def threshold(self, critical_m_s: Floats) -> Floats:
        """The command (n,) above which a cut leaves faster than `critical_m_s` (n,); −inf where every command does so.

        Where none does, because the cut is never so fast, it is what would do so if the cut were: so commands to cuts
        that roll out anyway stay near those of their neighbours."""


class PositionModel(Protocol):
    """A retarder position, as the study of aims sees it."""

    def exits(self, cuts: SceneCuts) -> ExitSpeeds:
        """What it makes of these cuts."""


@frozen_arrays
class AddedError:
    """Exit speed = command + error (n,), as published studies take it; at most `most_m_s` (n,)."""

    error_m_s: Floats
    most_m_s: Floats

    def at(self, commanded_m_s: Floats) -> Floats:
        """Command and error, between 0 and the most."""
        return np.clip(commanded_m_s + self.error_m_s, 0.0, self.most_m_s)

    def threshold(self, critical_m_s: Floats) -> Floats:
        """Critical speed less error."""
        return np.where(critical_m_s > 0.0, critical_m_s - self.error_m_s, -np.inf)


@dataclass(frozen=True)
class NormalPosition:
    """Normal exit error of `std_m_s`; 0 is the ideal position.

    `only_brakes`: a cut leaves no faster than it would roll through unbraked; [kozachenko-aimed] does not ask that.
    """

    std_m_s: float = 0.0
    only_brakes: bool = True

    def __post_init__(self) -> None:
        require_between("position: exit_std_m_s", self.std_m_s, 0.0, 3.0)

    def exits(self, cuts: SceneCuts) -> AddedError:
        """One normal error a cut."""
        z = ndtri(cuts.numbers(Purpose.EXIT_ERROR, 1)[:, 0])
        most = cuts.unbraked_exit_m_s if self.only_brakes else np.full(len(cuts), np.inf)
        return AddedError(self.std_m_s * z, most)


@frozen_arrays
class SampledExits:
    """Exit speeds of n cuts simulated at `commands_m_s` (k,), `exits_m_s` (n, k); between two commands linear.

    Commands beyond both ends are those ends. Where an exit falls with the command, noise of the simulation, the higher
    one before counts for all that follow.
    """

    commands_m_s: Floats
    exits_m_s: Floats

    def at(self, commanded_m_s: Floats) -> Floats:
        """Exit speeds between the two neighbours of each command."""
        place = np.interp(commanded_m_s, self.commands_m_s, np.arange(len(self.commands_m_s)))
        low = np.minimum(place.astype(np.int64), max(len(self.commands_m_s) - 2, 0))
        high = np.minimum(low + 1, len(self.commands_m_s) - 1)
        rows = np.arange(len(self.exits_m_s))
        rising = self.rising
        return np.asarray(rising[rows, low] + (place - low) * (rising[rows, high] - rising[rows, low]))

    def threshold(self, critical_m_s: Floats) -> Floats:
        """Where the exit of a cut goes beyond its critical speed."""
        rising, commands = self.rising, self.commands_m_s
        beyond = rising > critical_m_s[:, None]
        first = beyond.argmax(axis=1)
        rows, before = np.arange(len(rising)), np.maximum(first - 1, 0)
        gap = rising[rows, first] - rising[rows, before]
        part = (critical_m_s - rising[rows, before]) / np.where(gap > 0.0, gap, 1.0)
        crossing = commands[before] + part * (commands[first] - commands[before])
        crossing = np.where(first == 0, -np.inf, crossing)
        return np.where(beyond.any(axis=1), crossing, commands[-1] + critical_m_s - rising[:, -1])

    @property
    def rising(self) -> Floats:
        """Exits that do not fall with the command."""
        return np.maximum.accumulate(self.exits_m_s, axis=1)
