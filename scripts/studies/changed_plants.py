"""Plants that differ from the one that a table was tuned for, by friction, valves or single values; and faults of the
speed sensor, as data: what they do to the random numbers that a pass's readings are made of.

The sizes are assumed, like the values they act on; none was measured. The closed loop knows nothing of faults: a
reading is speed + noise·z, and z = NaN is a reading that is missing, to which the tables' rule answers HOLD. Random
numbers repeat after 256 readings (25.6 s at 0.1 s), and a fault with them.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from plant_models import Plant
from plant_models.frozen_arrays import Bools, Floats
from synth.kernels.loop.passes import LONGEST_PASS_S
from synth.retarder.configuration.plant_values import SLOPES, nominal_value, with_values
from synth.simulation.random_passes import RandomPasses

AIR: Final = "retarder.pneumatics."


def times(key: str, factor: float) -> Callable[[Plant], Plant]:
    """The value under `key` times `factor`."""

    def change(plant: Plant) -> Plant:
        return with_values(plant, {key: factor * known(plant, key)})

    return change


def friction(mean: float, spread: float) -> Callable[[Plant], Plant]:
    """Friction factor with another mean, and its CV per cut times `spread`.

    ξ_cut and the slope K enter the force as their product: another mean of ξ, its floor in proportion, is another K.
    """

    def change(plant: Plant) -> Plant:
        slope = next(key for key in SLOPES if nominal_value(plant, key) is not None)
        cv = spread * plant.friction.common_cv
        return with_values(plant, {slope: mean * known(plant, slope), "friction.common_cv": cv})

    return change


def aged_valves(plant: Plant) -> Plant:
    """All valve delays doubled, filling and exhausting half as slow again."""
    slower = {"brake_delay_s": 2.0, "touch_delay_s": 2.0, "release_delay_s": 2.0}
    slower |= {"fill_time_constant_s": 1.5, "exhaust_time_constant_s": 1.5}
    return with_values(plant, {AIR + name: factor * known(plant, AIR + name) for name, factor in slower.items()})


def known(plant: Plant, key: str) -> float:
    """The value of `plant` under `key`, which it has."""
    value = nominal_value(plant, key)
    assert value is not None, key
    return value


SensorFault = Callable[[RandomPasses, Plant, Floats], RandomPasses]
"""(passes, plant, time that each pass takes without the fault, s) → the same passes with the fault."""

FAULT_STREAM = 0x7A11
"""Spawn key of the random numbers of faults: none of those that passes are made of (blocks count from 0)."""


def no_fault(passes: RandomPasses, plant: Plant, transit_s: Floats) -> RandomPasses:
    """The passes as they are."""
    return passes


@dataclass(frozen=True)
class DropOut:
    """No reading for `duration_s` in every pass, from the moments on that `starts_s` gives for the transit times."""

    duration_s: float
    starts_s: Callable[[Floats], Floats]

    def __call__(self, passes: RandomPasses, plant: Plant, transit_s: Floats) -> RandomPasses:
        """See `SensorFault`."""
        time = reading_times_s(passes, plant)
        since = time - self.starts_s(transit_s)[:, None]
        return without_readings(passes, (since >= 0.0) & (since < self.duration_s))


@dataclass(frozen=True)
class LostForGood:
    """No reading in any pass from the moments on that `starts_s` gives for the transit times."""

    starts_s: Callable[[Floats], Floats]

    def __call__(self, passes: RandomPasses, plant: Plant, transit_s: Floats) -> RandomPasses:
        """See `SensorFault`; with as many readings as the longest pass has, for repeated ones would come back."""
        readings = math.ceil(LONGEST_PASS_S / plant.sensor.sample_period_s) + 1
        repeats = -(-readings // passes.noise_z.shape[1])
        longer = replace(passes, noise_z=np.tile(passes.noise_z, (1, repeats)))
        return without_readings(longer, reading_times_s(longer, plant) >= self.starts_s(transit_s)[:, None])


@dataclass(frozen=True)
class LostReadings:
    """Every reading is missing with probability `share`, independently."""

    share: float
    seed: int

    def __call__(self, passes: RandomPasses, plant: Plant, transit_s: Floats) -> RandomPasses:
        """See `SensorFault`."""
        return without_readings(passes, stream(self.seed).random(passes.noise_z.shape) < self.share)


def at_random(seed: int) -> Callable[[Floats], Floats]:
    """Moments uniform over the pass; pass i has the same share of its time for every fault with this seed."""

    def starts_s(transit_s: Floats) -> Floats:
        return stream(seed).random(len(transit_s)) * transit_s

    return starts_s


def reading_times_s(passes: RandomPasses, plant: Plant) -> Floats:
    """Time of every reading from the entrance on, of the shape of `passes.noise_z`."""
    count = passes.noise_z.shape[1]
    return np.asarray((passes.phase_u[:, None] + np.arange(count)) * plant.sensor.sample_period_s)


def without_readings(passes: RandomPasses, missing: Bools) -> RandomPasses:
    """`passes` with NaN where a reading is `missing`, of the shape of `passes.noise_z`."""
    return replace(passes, noise_z=np.where(missing, np.float32(np.nan), passes.noise_z).astype(np.float32))


def stream(seed: int) -> np.random.Generator:
    """Random numbers of faults."""
    return np.random.Generator(np.random.SFC64(np.random.SeedSequence(seed, spawn_key=(FAULT_STREAM, 1))))
