"""What one core can do at most now: loops over vectors of sixteen float32 that do nothing else."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

from scripts.studies.benchmark.kernels.roofline import loads, loads_a_turn, multiply_adds
from scripts.studies.timing.turns import Call
from synth.kernels.vector.packs import SIXTEEN

SUMS_A_TURN = 12
WORK = 2_500_000
"""Operations of one loop: about a millisecond."""

NEAREST_FLOATS = 4096
"""16 KB: less than the first-level cache of any processor that this runs on."""

CACHE_LINE_BYTES = 64


@dataclass(frozen=True)
class Loop:
    """A call, and how many operations on vectors of sixteen it makes."""

    call: Call
    operations: int


def multiply_add_loop() -> Loop:
    """Sums of products in registers."""
    turns = WORK // SUMS_A_TURN
    return Loop(partial(multiply_adds, turns, filled(SIXTEEN, 0.5), filled(SIXTEEN, 0.0)), SUMS_A_TURN * turns)


def load_loop(floats: int = NEAREST_FLOATS) -> Loop:
    """Loads from so many floats over and over."""
    a_turn = int(loads_a_turn(floats))
    turns = max(1, WORK // a_turn)
    return Loop(partial(loads, turns, filled(floats, 1.0), filled(SIXTEEN, 0.0)), a_turn * turns)


def filled(floats: int, number: float) -> NDArray[np.float32]:
    """The same number so many times, from the beginning of a cache line on: a load across two lines takes longer."""
    raw = np.empty(4 * floats + CACHE_LINE_BYTES, dtype=np.uint8)
    start = -raw.ctypes.data % CACHE_LINE_BYTES
    array = raw[start : start + 4 * floats].view(np.float32)
    array[:] = number
    return array
