"""Faults of a radar, as data: what they do to the numbers that the readings of a pass are made of.

A reading is speed + noise·z. A shifted z is a bias, z = NaN a reading that is missing, a z far below 0 a reading of 0.
A frozen radar tells its last reading again. That depends on the speed, so no finite z can stand for it: z = ∞ asks the
closed loop for it (`watched_passes`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
from numpy.typing import NDArray

from plant_models import DopplerSensor, Plant
from plant_models.frozen_arrays import Floats
from synth.kernels.loop.passes import LONGEST_PASS_S
from synth.simulation.random_passes import RandomPasses

Numbers = NDArray[np.float32]

Change = Callable[[Numbers, DopplerSensor, np.random.Generator], Numbers]
"""(z of all readings (n, m), sensor, chance) → z with the fault at every reading."""

FROZEN: Final = np.float32(np.inf)
"""Stands for the last reading again."""

BELOW_EVERY_SPEED_M_S: Final = -1000.0


@dataclass(frozen=True)
class RadarFault:
    """`change` happens to the readings for `duration_s`, from a moment of the pass on, or from its beginning."""

    name: str
    change: Change
    duration_s: float = math.inf
    from_beginning: bool = False

    def happens_to(
        self, passes: RandomPasses, plant: Plant, starts_s: Floats, chance: np.random.Generator
    ) -> RandomPasses:
        """`passes` with the fault from the moments `starts_s` (n,) on; as many readings as the longest pass has.

        Raises `ValueError` where the sensor has no noise, of which faults are made.
        """
        sensor = plant.sensor
        if sensor.noise_m_s == 0.0:
            raise ValueError("radar faults: the sensor has no noise, so no number of it can stand for a fault")
        z = lasting(passes.noise_z, sensor)
        time_s = (passes.phase_u[:, None] + np.arange(z.shape[1])) * sensor.sample_period_s
        since_s = time_s if self.from_beginning else time_s - starts_s[:, None]
        faulty = (since_s >= 0.0) & (since_s < self.duration_s)
        return replace(passes, noise_z=np.where(faulty, self.change(z, sensor, chance), z))


def lasting(noise_z: Numbers, sensor: DopplerSensor) -> Numbers:
    """The same numbers, which the closed loop takes round and round, for a whole longest pass: a fault must not."""
    readings = math.ceil(LONGEST_PASS_S / sensor.sample_period_s) + 1
    return np.tile(noise_z, (1, -(-readings // noise_z.shape[1])))


def as_it_is(z: Numbers, sensor: DopplerSensor, chance: np.random.Generator) -> Numbers:
    """No fault."""
    return z


def missing(z: Numbers, sensor: DopplerSensor, chance: np.random.Generator) -> Numbers:
    """No reading."""
    return np.full_like(z, np.nan)


def frozen(z: Numbers, sensor: DopplerSensor, chance: np.random.Generator) -> Numbers:
    """The last reading before, again and again."""
    return np.full_like(z, FROZEN)


def standing(z: Numbers, sensor: DopplerSensor, chance: np.random.Generator) -> Numbers:
    """A reading of 0."""
    return np.full_like(z, BELOW_EVERY_SPEED_M_S / sensor.noise_m_s)


@dataclass(frozen=True)
class Biased:
    """Every reading is off by so much, before the sensor rounds."""

    bias_m_s: float

    def __call__(self, z: Numbers, sensor: DopplerSensor, chance: np.random.Generator) -> Numbers:
        """See `Change`."""
        return z + np.float32(self.bias_m_s / sensor.noise_m_s)


@dataclass(frozen=True)
class Spikes:
    """This share of the readings is off, each by itself, evenly up to `largest_m_s` either way."""

    share: float
    largest_m_s: float

    def __call__(self, z: Numbers, sensor: DopplerSensor, chance: np.random.Generator) -> Numbers:
        """See `Change`."""
        off = chance.random(z.shape, dtype=np.float32) < self.share
        height = (2.0 * chance.random(z.shape, dtype=np.float32) - 1.0) * np.float32(self.largest_m_s)
        return z + np.where(off, height / np.float32(sensor.noise_m_s), np.float32(0.0))


RADAR_FAULTS: Final = (
    RadarFault("none", as_it_is),
    RadarFault("no reading for 0.3 s", missing, 0.3),
    RadarFault("no reading for 1 s", missing, 1.0),
    RadarFault("no reading for 3 s", missing, 3.0),
    RadarFault("no reading for good", missing),
    RadarFault("frozen for 1 s", frozen, 1.0),
    RadarFault("frozen for good", frozen),
    RadarFault("reading 0 for 1 s", standing, 1.0),
    RadarFault("reading 0 for good", standing),
    RadarFault("spikes: 5 % of the readings off by up to 3 m/s", Spikes(0.05, 3.0), from_beginning=True),
    RadarFault("bias +0.3 m/s for good", Biased(0.3)),
    RadarFault("bias +0.6 m/s for good", Biased(0.6)),
    RadarFault("bias −0.6 m/s for good", Biased(-0.6)),
    RadarFault("bias +0.6 m/s for 1 s", Biased(0.6), 1.0),
)
"""All that are tried, none first."""
