"""The pulse pairs that a regulator with point sensors hears of n passes; faults turn one such value into another."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from synth.kernels.loop.passage_pulses import Heard
from synth.simulation.controllers import fixed

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

BY_THE_CLOCK = -1


@frozen_arrays
@dataclass(frozen=True, eq=False)
class HeardPairs:
    """R rows, each a pulse pair that may be heard in each of n passes.

    `source` (R,): the axle over a sensor that the pair comes from, not falling, then `BY_THE_CLOCK`; `sensor` (R,): the
    number under which it is heard. `after_s` (n, R): from the second pulse of the source on, or the time in the pass;
    NaN: not heard. `told_m_s` (n, R): the speed told; NaN: that which is measured.
    """

    source: Ints
    sensor: Ints
    after_s: Floats
    told_m_s: Floats

    def __len__(self) -> int:
        return len(self.after_s)

    def of_sensor(self, sensor: int | None) -> NDArray[np.bool_]:
        """Marks the rows that are heard from `sensor`, or all, (R,)."""
        return np.ones(len(self.sensor), dtype=np.bool_) if sensor is None else self.sensor == sensor

    def without(self, lost: NDArray[np.bool_]) -> HeardPairs:
        """The pairs but those that `lost`, of a shape like (n, R), marks."""
        return replace(self, after_s=np.where(lost, np.nan, self.after_s))

    def taken(self, rows: NDArray[np.bool_]) -> HeardPairs:
        """The rows alone that `rows` (R,) marks."""
        return HeardPairs(self.source[rows], self.sensor[rows], self.after_s[:, rows], self.told_m_s[:, rows])

    def also(self, more: HeardPairs) -> HeardPairs:
        """These rows and those of `more`, of the same passes, in the order that the kernel wants."""
        source = np.concatenate([self.source, more.source])
        order = np.argsort(np.where(source == BY_THE_CLOCK, np.iinfo(np.int64).max, source), kind="stable")
        return HeardPairs(
            source[order],
            np.concatenate([self.sensor, more.sensor])[order],
            np.concatenate([self.after_s, more.after_s], axis=1)[:, order],
            np.concatenate([self.told_m_s, more.told_m_s], axis=1)[:, order],
        )

    def first_row(self, sources: int) -> Ints:
        """First row of each source, and of those by the clock, (`sources` + 1,)."""
        return np.searchsorted(self.source[self.source != BY_THE_CLOCK], np.arange(sources + 1)).astype(np.int64)

    def for_kernel(self) -> Heard:
        """What differs from pass to pass."""
        return Heard(fixed(self.after_s, np.float64), fixed(self.told_m_s, np.float64))


def as_given(sensor: Ints, passes: int) -> HeardPairs:
    """Every axle over a sensor is heard once, at once, as it was measured; `sensor` (E,) of each."""
    shape = (passes, len(sensor))
    return HeardPairs(np.arange(len(sensor)), np.array(sensor), np.zeros(shape), np.full(shape, np.nan))
