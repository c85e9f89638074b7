"""Readings that a radar loses, in bursts: which ones, pass by pass.

Whether a reading is lost is a Markov chain of two states, one step a sample (Gilbert 1960): a burst ends with
probability 1/L at each sample, L its mean length in readings, and a new one begins with the probability that makes the
stationary share what it is to be. The numbers that decide come from the key of the pass, so no other number of the
pass moves, and a pass loses the same readings under every controller.

The numbers of the sensor come again after so many readings, and with them the losses. So the chain runs round a ring:
it goes round twice with the same numbers, and the second turn, which ends as it began, is kept. A burst may thus last
over the place where they come again.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from plant_models import DopplerSensor
from plant_models.frozen_arrays import Bools, Ints
from plant_models.rolling.keyed_numbers import keyed_uniform
from plant_models.rolling.random_numbers import Purpose
from synth.simulation.random_passes import RandomPasses

BURSTS_A_TURN = 8
"""Mean bursts that a ring has room for at least: that its chain does not end as it began then has probability e⁻⁸."""


def readings_z(passes: RandomPasses, sensor: DopplerSensor) -> NDArray[np.float32]:
    """The numbers of the readings of `passes`, NaN where `sensor` loses one; (n, 256) or some times as many columns.

    Those of `passes` themselves where it loses none.
    """
    if sensor.missed_share == 0.0:
        return passes.noise_z
    samples = passes.noise_z.shape[1]
    turns = max(1, math.ceil(BURSTS_A_TURN * sensor.missed_readings / samples))
    lost = lost_readings(passes.loss_key, sensor, turns * samples)
    return np.where(lost, np.float32(np.nan), np.tile(passes.noise_z, (1, turns)))


def lost_readings(keys: Ints, sensor: DopplerSensor, samples: int) -> Bools:
    """Which of `samples` readings are lost in passes with these `keys` (n,), (n, samples)."""
    stay = 1.0 - 1.0 / sensor.missed_readings
    begin = (1.0 - stay) * sensor.missed_share / (1.0 - sensor.missed_share)
    first, *u = keyed_uniform(0, Purpose.LOST_READING, (keys,), samples + 1)
    lost = np.empty((samples, len(keys)), dtype=np.bool_)
    now = first < sensor.missed_share
    for _ in range(2):
        for sample in range(samples):
            now = u[sample] < np.where(now, stay, begin)
            lost[sample] = now
    return np.ascontiguousarray(lost.T)
