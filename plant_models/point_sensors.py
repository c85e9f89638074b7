"""Point speed sensors (wheel sensors): speed is measured where a wheel rolls over a base of known length. What a
cut can do between two passages decides whether a regulator believes a pulse pair.

A sensor has two coils, `base_m` apart. The time t between their pulses gives v = base/t (zhukovitsky-2012, eq. (1)).
That is the mean speed over the base, which under constant acceleration a is the speed at its middle, to a²·t²/(8 v).
So a reading tells the speed half a base before the second coil, and is off by a·(base/2)/v from the speed there.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from plant_models.cut import Cut
from plant_models.errors import require, require_between
from plant_models.frozen_arrays import Floats
from plant_models.motion import path_breaks_m, path_coefficients
from plant_models.plant import Plant

MOST_SENSORS = 32
SHORTEST_SECTION_M = 0.3
ROUNDING_M = 1e-9
"""By so much a difference of places may be off: 1.2 − 0.9 is less than 0.3."""

Axles = Callable[[Cut], tuple[int, ...]]
"""Which axles of a cut the regulator decides on, by number from 0."""


def first_axle(cut: Cut) -> tuple[int, ...]:
    """The first axle alone, for `PointSensors.axles`.

    Parameters
    ----------
    cut
        A cut.

    Returns
    -------
    tuple of int
        Numbers of its axles, from 0.

    Examples
    --------
    >>> from plant_models import Cut, first_axle
    >>> first_axle(Cut("С", mass_t=26.0, axle_offsets_m=(0.0, 6.0), allowed_stage=3))
    (0,)
    """
    return (0,)


def every_axle(cut: Cut) -> tuple[int, ...]:
    """Every axle, for `PointSensors.axles`: the later version of [zhukovitsky-2012].

    Parameters
    ----------
    cut
        A cut.

    Returns
    -------
    tuple of int
        Numbers of its axles, from 0.

    Examples
    --------
    >>> from plant_models import Cut, every_axle
    >>> every_axle(Cut("С", mass_t=26.0, axle_offsets_m=(0.0, 6.0), allowed_stage=3))
    (0, 1)
    """
    return tuple(range(cut.axles))


@dataclass(frozen=True)
class PointSensors:
    """Sensors along a retarder position, and the regulator that listens to them.

    Parameters
    ----------
    path_m
        Middle of the base of each sensor, from the entrance of the first retarder, m, rising; negative ahead of it.
    base_m
        Distance of the two coils of a sensor, m.
    base_tolerance
        Standard deviation of the relative error of the base, lasting for each sensor and unknown to the regulator.
    timer_noise_s
        Standard deviation of a measured time, s.
    timer_resolution_s
        Times are whole multiples of it, s; 0: not quantised.
    computing_delay_s
        From the second pulse to the command on the wires, s.
    scan_period_s
        Step of the clock of the regulator, s; a transient is over at the first step after its end.
    missed_share
        Of the passages, each by itself, that the design of a table counts as not heard, so that a lost one costs less.
        A simulated pass loses none unless a fault says so.
    axles
        Those that the regulator decides on, `first_axle` or `every_axle`.

    Raises
    ------
    PlantError
        Sensors that overlap, or a number out of range.

    Examples
    --------
    >>> from plant_models import PointSensors, every_axle
    >>> sensors = PointSensors(path_m=(-1.0, 6.0, 13.0), axles=every_axle)
    >>> sensors.base_m, float(sensors.reading_std_m_s(5.0).round(4))
    (0.2, 0.0164)
    """

    path_m: tuple[float, ...]
    base_m: float = 0.2
    base_tolerance: float = 0.002
    timer_noise_s: float = 1e-4
    timer_resolution_s: float = 1e-4
    computing_delay_s: float = 0.02
    scan_period_s: float = 0.02
    missed_share: float = 0.003
    axles: Axles = first_axle

    def __post_init__(self) -> None:
        require(
            1 <= len(self.path_m) <= MOST_SENSORS,
            f"sensors: path_m has {len(self.path_m)} entries; 1 to {MOST_SENSORS} sensors are possible",
        )
        for number, place in enumerate(self.path_m):
            require_between(f"sensors: path_m[{number}]", place, -100.0, 500.0)
        for number, (before, after) in enumerate(pairwise(self.path_m)):
            require(
                after - before >= SHORTEST_SECTION_M - ROUNDING_M,
                f"sensors: path_m[{number + 1}] is {after:g}; it must be at least {SHORTEST_SECTION_M:g} m behind the "
                f"sensor before it, which stands at {before:g}",
            )
        require_between("sensors: base_m", self.base_m, 0.05, 1.0)
        require(
            self.base_m < SHORTEST_SECTION_M or all(b - a > self.base_m for a, b in pairwise(self.path_m)),
            f"sensors: base_m is {self.base_m:g}; the bases of neighbouring sensors must not overlap",
        )
        require_between("sensors: base_tolerance", self.base_tolerance, 0.0, 0.2)
        require_between("sensors: timer_noise_s", self.timer_noise_s, 0.0, 0.05)
        require_between("sensors: timer_resolution_s", self.timer_resolution_s, 0.0, 0.05)
        require_between("sensors: computing_delay_s", self.computing_delay_s, 0.0, 2.0)
        require_between("sensors: scan_period_s", self.scan_period_s, 0.001, 0.5)
        require_between("sensors: missed_share", self.missed_share, 0.0, 0.5)

    @property
    def sample_period_s(self) -> float:
        """Step of the clock in which durations of commands are counted, `scan_period_s`."""
        return self.scan_period_s

    @property
    def timing_std_s(self) -> float:
        """Std of a measured time, quantisation as an equivalent noise; 1 µs at least."""
        return max(math.hypot(self.timer_noise_s, self.timer_resolution_s / math.sqrt(12.0)), 1e-6)

    def reading_std_m_s(self, speed_m_s: Floats | float) -> Floats:
        """Standard deviation of a reading: v²·σ_t/base and v times the tolerance of the base, together.

        Parameters
        ----------
        speed_m_s
            True speeds, m/s, of any shape.

        Returns
        -------
        ndarray
            m/s, of that shape.
        """
        v = np.asarray(speed_m_s, dtype=np.float64)
        return np.hypot(v * v * self.timing_std_s / self.base_m, v * self.base_tolerance)


@dataclass(frozen=True)
class Passage:
    """Axle `axle` of a cut over sensor `sensor`: it is at the middle of the base when the first axle is at `path_m`."""

    sensor: int
    axle: int
    path_m: float


def passages(sensors: PointSensors, cut: Cut) -> tuple[Passage, ...]:
    """All passages of axles that the regulator looks at, in the order of the path; those behind the exit too."""
    met = [
        Passage(sensor, axle, place + cut.axle_offsets_m[axle])
        for sensor, place in enumerate(sensors.path_m)
        for axle in sensors.axles(cut)
    ]
    return tuple(sorted(met, key=lambda passage: (passage.path_m, passage.sensor)))


def deciding_passages(sensors: PointSensors, cut: Cut, exit_m: float) -> tuple[Passage, ...]:
    """The passages at which a command may still act: those before the exit."""
    return tuple(each for each in passages(sensors, cut) if each.path_m < exit_m - 1e-9)


LEAST_SPEED_M_S = 0.1
"""A slower reading is not believed; a cut so slow as to give one is about to stop."""

FAR_STDS = 4.0
"""How far from its mean a friction, a resistance or a reading may lie and still be believed."""

SPARE_ACCELERATION_M_S2, SPARE_PATH_M = 0.05, 0.1
"""Beyond what the model can do: wind, and the place of a sensor."""


@dataclass(frozen=True)
class CredibleMotion:
    """Limits of what a pulse pair may tell.

    `speed_m_s`: least and greatest; `acceleration_m_s2`, `deceleration_m_s2`: greatest; `speed_tolerance`: relative
    error allowed of a speed; `path_tolerance_m`: error allowed of a path.
    """

    speed_m_s: tuple[float, float]
    acceleration_m_s2: float
    deceleration_m_s2: float
    speed_tolerance: float
    path_tolerance_m: float


def credible_motion(plant: Plant, sensors: PointSensors) -> CredibleMotion:
    """The limits for `plant`, whatever its regulator commands.

    The greatest speed is that of a cut that is never braked and comes with the greatest speed that the position or the
    entry law takes; the acceleration that of a cut without resistance; the deceleration that at the top stage, reached
    from above, with much friction and resistance. The path may be off by one base: the speed of a reading is that at
    its middle, the time that of its second pulse.
    """
    position, law = plant.position, plant.resistance
    edges = path_breaks_m(position, plant.cut, plant.profile, plant.start_m)
    path = path_coefficients(position, plant.cut, plant.profile, edges)
    first_m_s = max(plant.entry.high_m_s, position.max_entry_speed_m_s)
    gained = 2.0 * float(np.maximum(path.gravity_m_s2, 0.0) @ np.diff(edges))
    fastest = math.sqrt(first_m_s**2 + gained)
    noise = FAR_STDS * float(sensors.reading_std_m_s(fastest)) / fastest
    factor = float(plant.friction.cut_factor(np.array([FAR_STDS]), plant.friction_cv)[0])
    factor *= 1.0 + FAR_STDS * plant.friction.path_std
    drag = path.resistance_m_s2_per_n_kn * (law.mean_n_per_kn + FAR_STDS * law.std_n_per_kn)
    highest_kpa = position.stage_pressures_kpa[plant.top_stage] + position.pneumatics.dead_band_kpa
    overpressure_kpa = max(0.0, highest_kpa - position.force.touch_pressure_kpa)
    slowed = drag - path.gravity_m_s2 + factor * overpressure_kpa * path.brake_m_s2_per_kpa
    return CredibleMotion(
        (LEAST_SPEED_M_S, fastest * (1.0 + noise)),
        max(0.0, float(path.gravity_m_s2.max())) + SPARE_ACCELERATION_M_S2,
        max(0.0, float(slowed.max())) + SPARE_ACCELERATION_M_S2,
        min(noise, 0.9),
        sensors.base_m + SPARE_PATH_M,
    )
