"""What a position makes of a commanded exit speed, exactly it, nearly it, or what a simulated table leaves; and how
the cuts then couple: over-speeds, gaps and coupling speeds, each with its interval.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from scipy.special import ndtri

from plant_models.errors import require_between
from plant_models.frozen_arrays import Bools, Floats, frozen_arrays
from plant_models.rolling.random_numbers import Purpose
from synth.aim.scene import SceneCuts
from synth.simulation.exit_statistics import NORMAL_95, clopper_pearson


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


@dataclass(frozen=True)
class Figure:
    """A figure and its 95 % interval."""

    value: float
    low95: float
    high95: float


@frozen_arrays
class Couplings:
    """n cuts that meet standing cars at one place: `speed_m_s` (n,) of coupling, 0 if they stop before; `gap_m` (n,)
    that then stays free, 0 if they couple; `cars` of each cut."""

    speed_m_s: Floats
    gap_m: Floats
    limit_m_s: float
    cars: int

    @property
    def overspeed(self) -> Figure:
        """Share that couples too fast, exact interval (Clopper and Pearson)."""
        return self.faster_than(self.limit_m_s)

    def faster_than(self, speed_m_s: float) -> Figure:
        """Share that couples faster than `speed_m_s`."""
        hits, n = int((self.speed_m_s > speed_m_s).sum()), len(self.speed_m_s)
        low, high = clopper_pearson(hits, n)
        return Figure(hits / n, low, high)

    def of(self, which: Bools) -> Couplings:
        """Some of these."""
        return Couplings(self.speed_m_s[which], self.gap_m[which], self.limit_m_s, self.cars)

    @property
    def gap_per_car_m(self) -> Figure:
        """Mean gap that a car leaves, normal interval."""
        gaps = self.gap_m / self.cars
        mean, half = float(gaps.mean()), NORMAL_95 * float(gaps.std(ddof=1)) / np.sqrt(len(gaps))
        return Figure(mean, mean - half, mean + half)


def couplings(cuts: SceneCuts, exits: ExitSpeeds, commanded_m_s: Floats, arrival_m: Floats) -> Couplings:
    """Let `cuts` out with `commanded_m_s` (n,) towards standing cars whose head is at `arrival_m` (n,).

    Over-speed is told by the roll forwards, which knows nothing of the thresholds that the commands come from. Raises
    `ValueError` for a command that is NaN: where none meets the requirement, the caller says what is done.
    """
    if not np.isfinite(commanded_m_s).all():
        raise ValueError("couplings: a command is not a finite number")
    rolled = cuts.rolling.roll_on(cuts.release_m, exits.at(commanded_m_s), arrival_m[:, None])
    gap = np.where(np.isfinite(rolled.stop_m), np.maximum(arrival_m - rolled.stop_m, 0.0), 0.0)
    return Couplings(rolled.speed_m_s[:, 0], gap, cuts.scene.coupling_speed_m_s, cuts.rolling.cuts.cars)
