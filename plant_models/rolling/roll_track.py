"""The way on which a cut rolls: falls, switches and curves, from the crest to the standing cars, and the weather
that it meets: air temperature, head wind and snow.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from plant_models.errors import require, require_between
from plant_models.frozen_arrays import Floats
from plant_models.track_profile import TrackProfile

AIR_NORM = 17.8
"""kgf/t · (273 + t) · t / (m² · (m/s)²): [hump-norm]; half the density of air, 353/(273 + t), over g gives 17.99."""


@dataclass(frozen=True)
class Weather:
    """`head_wind_mean_m_s` and `head_wind_std_m_s`: normal law of the wind along the track, positive against the cut;
    one draw a cut ([kozachenko-aimed] has the law and no figures). `snow_n_per_kn`: added resistance of snow and frost
    behind the park position."""

    temperature_c: float = 10.0
    head_wind_mean_m_s: float = 0.0
    head_wind_std_m_s: float = 3.0
    snow_n_per_kn: float = 0.0

    def __post_init__(self) -> None:
        require_between("weather: temperature_c", self.temperature_c, -60.0, 60.0)
        require_between("weather: head_wind_mean_m_s", self.head_wind_mean_m_s, -30.0, 30.0)
        require_between("weather: head_wind_std_m_s", self.head_wind_std_m_s, 0.0, 15.0)
        require_between("weather: snow_n_per_kn", self.snow_n_per_kn, 0.0, 10.0)

    def air_n_per_kn(self, drag_area_m2: float) -> float:
        """Resistance of the air to C_x·S = `drag_area_m2` at 1 m/s against it, times the mass in tonnes, N/kN · t."""
        return AIR_NORM * drag_area_m2 / (273.0 + self.temperature_c)

    def head_winds_m_s(self, z: Floats) -> Floats:
        """Winds against cuts for standard normal `z`."""
        return np.asarray(self.head_wind_mean_m_s + self.head_wind_std_m_s * z)


LONGEST_TRACK_M = 10_000.0


@dataclass(frozen=True)
class Bend:
    """A stretch on which wheels are turned: `switches` points and `turn_deg` degrees of curve, switch curves included.

    Its resistance is spread evenly over [`from_m`, `to_m`], metres from the crest.
    """

    from_m: float
    to_m: float
    switches: int
    turn_deg: float

    def __post_init__(self) -> None:
        require_between("bend: from_m", self.from_m, 0.0, LONGEST_TRACK_M)
        require_between("bend: to_m", self.to_m, 0.0, LONGEST_TRACK_M)
        require(self.to_m > self.from_m, f"bend: to_m is {self.to_m:g}; it must be more than from_m, {self.from_m:g}")
        require(0 <= self.switches <= 20, f"bend: switches is {self.switches}; it must be from 0 to 20")
        require_between("bend: turn_deg", self.turn_deg, 0.0, 360.0)
        require(
            self.switches > 0 or self.turn_deg > 0.0,
            f"bend: switches and turn_deg are both 0 at {self.from_m:g} m; a bend must have one of them",
        )


@dataclass(frozen=True)
class RollTrack:
    """Track from the crest (0 m) to `end_m`: grades in permille, downhill positive, and bends in order.

    Grade before the crest is 0: that part of a long cut stands on the flat behind it.
    """

    profile: TrackProfile
    end_m: float
    bends: tuple[Bend, ...] = ()

    def __post_init__(self) -> None:
        require_between("track: end_m", self.end_m, 1.0, LONGEST_TRACK_M)
        require(self.profile.starts_m[0] == 0.0, f"track: starts_m is {self.profile.starts_m}; it must begin with 0")
        require(
            self.profile.starts_m[-1] < self.end_m,
            f"track: the last element begins at {self.profile.starts_m[-1]:g} m; it must begin before the end, "
            f"{self.end_m:g} m",
        )
        for ahead, behind in pairwise(self.bends):
            require(
                behind.from_m >= ahead.to_m,
                f"track: the bend from {behind.from_m:g} m overlaps the one that ends at {ahead.to_m:g} m",
            )
        if self.bends:
            require(
                self.bends[-1].to_m <= self.end_m,
                f"track: the last bend ends at {self.bends[-1].to_m:g} m, after the end of the track, {self.end_m:g} m",
            )

    @property
    def breaks_m(self) -> tuple[float, ...]:
        """Where the grade changes, and the end."""
        return (*self.profile.starts_m, self.end_m)

    def fall_m(self, x_m: Floats) -> Floats:
        """How far the track has fallen from the crest to `x_m`; before the crest 0, after the end as far as there."""
        breaks = np.asarray(self.breaks_m)
        falls = np.concatenate(([0.0], np.cumsum(np.diff(breaks) * np.asarray(self.profile.grades_permille) * 1e-3)))
        return np.interp(x_m, breaks, falls)
