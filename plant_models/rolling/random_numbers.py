"""Uniform random numbers by purpose: what one study asks for does not move the numbers of another (common
numbers). And random numbers of a cut by its keys (train, cut, position): worked out for any cuts alone, in any
order.

Random numbers of a cut by its keys (train, cut, position): worked out for any cuts alone, in any order. Cuts of many
trains come to a position in no row that blocks could follow. So each number is a hash of what it is
for: the SplitMix64 sequence (G. L. Steele, D. Lea, C. H. Flood: Fast splittable pseudorandom number generators, OOPSLA
2014), begun for every cut at a place of its own.
"""

from __future__ import annotations

from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Floats, Ints

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


Words = NDArray[np.uint64]

GOLDEN = np.uint64(0x9E3779B97F4A7C15)
"""2^64 over the golden ratio, odd: the step of the sequence."""


def keyed_words(seed: int, purpose: Purpose, keys: tuple[Ints, ...], columns: int) -> Words:
    """Random words of n cuts, (columns, n); `keys`: arrays (n,), not negative, that tell the cuts apart.

    A word depends on seed, purpose, the keys of its cut and its column alone. `ValueError` for a negative number.
    """
    if seed < 0 or columns < 0 or any(len(key) and int(key.min()) < 0 for key in keys):
        raise ValueError(f"random numbers: seed {seed}, {columns} columns and all keys must not be negative")
    first = np.random.SeedSequence(seed, spawn_key=(int(purpose),)).generate_state(1, np.uint64)
    state = np.repeat(first, len(keys[0]))
    for key in keys:
        state = mixed(state + GOLDEN * (key.astype(np.uint64) + np.uint64(1)))
    return mixed(state + GOLDEN * np.arange(1, columns + 1, dtype=np.uint64)[:, None])


def keyed_uniform(seed: int, purpose: Purpose, keys: tuple[Ints, ...], columns: int) -> Floats:
    """Uniform numbers of n cuts, (columns, n), strictly between 0 and 1; see `keyed_words`."""
    words = keyed_words(seed, purpose, keys, columns) >> np.uint64(12)
    return (words.astype(np.float64) + 0.5) * 2.0**-52


def mixed(words: Words) -> Words:
    """The finaliser of SplitMix64, one to one."""
    words = (words ^ (words >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    words = (words ^ (words >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return words ^ (words >> np.uint64(31))
