"""What is asked: where a cut is let go, where it is measured before, whom it meets, and how sure that must be."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.special import ndtri

from plant_models.errors import require, require_between
from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from plant_models.library.weight_category import WeightCategory
from plant_models.rolling.random_cuts import CutPopulation
from plant_models.rolling.random_numbers import Purpose, uniform_numbers
from plant_models.rolling.roll_track import RollTrack
from synth.aim.configuration.shared_settings import COUPLING_SPEED_M_S
from synth.simulation.free_roll import RollingCuts, rolling_cuts

SLOWEST_M_S = 0.3
"""Speed at a bunch exit that no draw is below."""


@dataclass(frozen=True)
class MeasuredStretch:
    """Free roll between the bunch position and the park position, metres from the crest, first axles: measured from
    `from_m` to `to_m`. Cuts are at `from_m` with a normal speed (the error of the bunch position)."""

    from_m: float
    to_m: float
    speed_mean_m_s: float
    speed_std_m_s: float

    def __post_init__(self) -> None:
        require_between("measured stretch: from_m", self.from_m, 0.0, 10_000.0)
        require(
            self.to_m > self.from_m,
            f"measured stretch: to_m is {self.to_m:g}; it must be more than from_m, {self.from_m:g}",
        )
        require_between("measured stretch: speed_mean_m_s", self.speed_mean_m_s, 0.5, 12.0)
        require_between("measured stretch: speed_std_m_s", self.speed_std_m_s, 0.0, 3.0)


@dataclass(frozen=True)
class AimScene:
    """One park position on one track, for one population of cuts.

    The position lies from `entrance_m` to `exit_m` from the crest; a cut is let go when its last axle is at `exit_m`.
    `coupling_speed_m_s`: more than this is over-speed. `threads` work on its cuts, 0: one a processor; they change no
    result.
    """

    population: CutPopulation
    track: RollTrack
    entrance_m: float
    exit_m: float
    stretch: MeasuredStretch
    coupling_speed_m_s: float = COUPLING_SPEED_M_S
    threads: int = 0

    def __post_init__(self) -> None:
        require_between("position: entrance_m", self.entrance_m, 0.0, 10_000.0)
        require(
            self.exit_m > self.entrance_m,
            f"position: exit_m is {self.exit_m:g}; it must be more than entrance_m, {self.entrance_m:g}",
        )
        require(
            self.exit_m < self.track.end_m,
            f"position: exit_m is {self.exit_m:g}; it must be before the end of the track, {self.track.end_m:g} m",
        )
        require(
            self.stretch.to_m <= self.entrance_m,
            f"measured stretch: to_m is {self.stretch.to_m:g}; it must not be beyond the entrance of the position, "
            f"{self.entrance_m:g} m",
        )
        require_between("coupling_speed_m_s", self.coupling_speed_m_s, 0.1, 5.0)

    def draw(self, category: WeightCategory, cars: int, seed: int, first: int, count: int) -> SceneCuts:
        """Cuts `first` … of the row `seed`, rolled to the position."""
        return self.draw_each(category, (cars,), seed, first, count)[0]

    def draw_each(
        self, category: WeightCategory, cars: Sequence[int], seed: int, first: int, count: int
    ) -> tuple[SceneCuts, ...]:
        """As `draw` for each of several numbers of cars, each car drawn once: the first are the same in all."""
        longest = self.population.draw(category, max(cars), seed, first, count)
        z = ndtri(uniform_numbers(seed, Purpose.BUNCH_EXIT, first, count, 1)[:, 0])
        begins = np.maximum(self.stretch.speed_mean_m_s + self.stretch.speed_std_m_s * z, SLOWEST_M_S)
        cuts = (longest.first_cars(n, self.population.weather) for n in cars)
        rolling = (rolling_cuts(self.population, self.track, self.exit_m, each, self.threads) for each in cuts)
        return tuple(SceneCuts(self, category, each, begins, seed, first) for each in rolling)


@frozen_arrays
class SceneCuts:
    """Cuts of a scene, all of one category and number of cars; `stretch_speed_m_s` (n,): where the stretch begins.

    `seed`, `first`: the row that they are of, so that everything else that is drawn for them is theirs.
    """

    scene: AimScene
    category: WeightCategory
    rolling: RollingCuts
    stretch_speed_m_s: Floats
    seed: int
    first: int

    def __len__(self) -> int:
        return len(self.rolling)

    @property
    def release_m(self) -> Floats:
        """Where each head is when the last axle leaves the position, (n,)."""
        return self.scene.exit_m + self.rolling.cuts.last_axle_m

    def resistance_at(self, speed_m_s: Floats, rows: Ints) -> Floats:
        """Resistance of the cuts `rows` on straight track at `speed_m_s`, air and wind included, N/kN."""
        return self.rolling.cuts.resistance_at(self.scene.population.law, rows, speed_m_s)

    @cached_property
    def measured_speeds_m_s(self) -> tuple[Floats, Floats]:
        """True speeds at both ends of the stretch, as the first axle passes them, each (n,); 0 if it stops before."""
        ends = np.full((len(self), 1), self.scene.stretch.to_m) + self.rolling.cuts.first_axle_m[:, None]
        return self.stretch_speed_m_s, self.rolling.roll_on(self.begin_m, self.stretch_speed_m_s, ends).speed_m_s[:, 0]

    @cached_property
    def unbraked_exit_m_s(self) -> Floats:
        """Speed at the release of cuts that nothing brakes, (n,); 0 if they stop before."""
        release = self.release_m[:, None]
        return self.rolling.roll_on(self.begin_m, self.stretch_speed_m_s, release).speed_m_s[:, 0]

    @property
    def begin_m(self) -> Floats:
        """Where the heads are when the first axles are at the begin of the stretch, (n,)."""
        return self.scene.stretch.from_m + self.rolling.cuts.first_axle_m

    def numbers(self, purpose: Purpose, columns: int) -> Floats:
        """Uniform numbers of these cuts, (n, columns)."""
        return uniform_numbers(self.seed, purpose, self.first, len(self), columns)

    def critical_speeds_m_s(self, arrival_m: Floats) -> Floats:
        """The highest exit speed of each cut that does not couple too fast at `arrival_m` (n,): one roll backwards.

        0 where even a cut from rest arrives too fast.
        """
        return self.rolling.roll_back(arrival_m, self.scene.coupling_speed_m_s, self.release_m)

    def stops_m(self, exit_speed_m_s: Floats) -> Floats:
        """Where the heads stop that leave with `exit_speed_m_s` (n,); infinite beyond the end of the track."""
        end = np.full((len(self), 1), self.scene.track.end_m)
        return self.rolling.roll_on(self.release_m, exit_speed_m_s, end).stop_m
