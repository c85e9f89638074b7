"""Trains of one shift come to the same tracks, so they are not independent: a shift is what intervals count."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Floats, Ints
from synth.hump.trains.outcomes import TrainOutcomes


def in_shifts(found: TrainOutcomes) -> bool:
    """Whether some of the trains are of one shift."""
    return shifts_in(found) < len(found)


def shifts_in(found: TrainOutcomes) -> int:
    """How many shifts the trains are of."""
    return len(np.unique(found.shift))


def shift_sums(found: TrainOutcomes, values: NDArray[Any], shift: Ints | None = None) -> Floats:
    """The sum of `values` (n, …) of the trains `found` over each shift, (shifts, …); `shift` (n,): other shifts that
    the trains are counted in."""
    numbers = found.shift if shift is None else shift
    begins = np.flatnonzero(np.diff(numbers, prepend=numbers[:1] - 1))
    return np.asarray(np.add.reduceat(values.astype(float), begins, axis=0))


def longer_shifts(one: TrainOutcomes, other: TrainOutcomes) -> Ints:
    """The shifts of two runs of the same trains in which both are independent: the longer ones of both."""
    return one.shift if shifts_in(one) <= shifts_in(other) else other.shift
