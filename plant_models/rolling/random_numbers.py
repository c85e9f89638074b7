"""Uniform random numbers by purpose: what one study asks for does not move the numbers of another (common numbers)."""

from __future__ import annotations

from enum import IntEnum

import numpy as np

from plant_models.frozen_arrays import Floats

BLOCK = 1000
"""Cuts that share one random stream; fixed, because cut i must not depend on how many are asked for."""


class Purpose(IntEnum):
    """What numbers are for. The numbers stand for themselves: a new purpose gets a new one."""

    CARS = 1
    WIND = 2
    BENDS = 3
    BUNCH_EXIT = 4
    SPEED_NOISE = 5
    EXIT_ERROR = 6
    FRICTION = 7
    RECORDS = 8
    TRAIN = 9
    TRAIN_CARS = 10
    POSITION_ERROR = 11
    CUT_FRICTION = 12
    PASS_CLOCK = 13
    PASS_PATH = 14
    PASS_NOISE = 15
    TRAIN_RESISTANCE = 16
    TRAIN_WIND = 17
    SPEED_READING = 21
    STANDING = 22
    SENSOR_FAULT = 23
    PASS_LOSS = 24
    LOST_READING = 25


def uniform_numbers(seed: int, purpose: Purpose, first: int, count: int, columns: int) -> Floats:
    """Numbers in (0, 1) of cuts `first` … `first + count − 1` of the endless row `seed`, shape (count, columns).

    Row i is the same whatever `first` and `count`, and its first columns whatever `columns`.
    """
    if seed < 0 or first < 0 or count < 0 or columns < 0:
        raise ValueError(
            f"random cuts: seed {seed}, first {first}, count {count}, columns {columns} must not be negative"
        )
    drawn = np.empty((count, columns))
    for block in range(first // BLOCK, -(-(first + count) // BLOCK)):
        rng = np.random.Generator(np.random.SFC64(np.random.SeedSequence(seed, spawn_key=(int(purpose), block))))
        numbers = rng.random((columns, BLOCK)).T
        start = block * BLOCK
        low, high = max(first, start), min(first + count, start + BLOCK)
        drawn[low - first : high - first] = numbers[low - start : high - start]
    return drawn * (1.0 - 2.0**-52) + 2.0**-53  # neither 0 nor 1, whose quantiles are infinite
