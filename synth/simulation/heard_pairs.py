"""The pulse pairs that a regulator with point sensors hears of n passes; faults turn one such value into another."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from plant_models import Plant, PointSensors, every_axle
from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from plant_models.point_sensors import deciding_passages
from synth.kernels.loop.passage_pulses import BASE_COLUMN, MOST_BASES, Heard, Pulses
from synth.simulation.controllers import fixed

BY_THE_CLOCK = -1


@frozen_arrays
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


TIMER_COLUMNS = BASE_COLUMN + 1 - MOST_BASES
"""Numbers of a pass that are the noise of the timer, one pulse pair each; beyond so many pairs they come again."""


def every_pulse(plant: Plant, sensors: PointSensors) -> Pulses:
    """The pulses of every axle over every sensor until the first axle is at the exit.

    Passages at which is decided take the first numbers of a pass for the noise of their timer, all others those behind:
    so a cut measures the same there, whether the others are heard or not.
    """
    deciding = {
        (each.sensor, each.axle): i for i, each in enumerate(deciding_passages(sensors, plant.cut, plant.exit_m))
    }
    met = deciding_passages(replace(sensors, axles=every_axle), plant.cut, plant.exit_m)
    decides = np.array([deciding.get((each.sensor, each.axle), -1) for each in met], dtype=np.int64)
    column = decides.copy()
    column[decides < 0] = len(deciding) + np.arange(np.count_nonzero(decides < 0))
    path = np.maximum(np.array([each.path_m for each in met]), plant.start_m)
    nothing = np.empty(0, dtype=np.int64)
    sensor, number = np.array([each.sensor for each in met]), np.arange(len(met))
    return in_order(
        Pulses(
            path, sensor, number, decides, column % TIMER_COLUMNS, nothing, nothing, nothing,
            sensors.base_m, sensors.base_tolerance, sensors.timer_noise_s, sensors.timer_resolution_s,
        )
    )  # fmt: skip


def deciding_pulses(pulses: Pulses) -> Pulses:
    """Those of `pulses` at whose passages is decided."""
    here = np.flatnonzero(pulses.decides >= 0)
    return in_order(
        pulses._replace(
            path_m=pulses.path_m[here],
            sensor=pulses.sensor[here],
            number=pulses.number[here],
            decides=pulses.decides[here],
            column=pulses.column[here],
        )
    )


def in_order(pulses: Pulses) -> Pulses:
    """`pulses` with the order of their coils and a row for each source."""
    half_m, sources = 0.5 * pulses.base_m, len(pulses.path_m)
    coils = np.argsort(np.concatenate([pulses.path_m - half_m, pulses.path_m + half_m]), kind="stable")
    sensor = fixed(pulses.sensor, np.int64)
    return pulses._replace(
        path_m=fixed(pulses.path_m, np.float64),
        sensor=sensor,
        number=fixed(pulses.number, np.int64),
        decides=fixed(pulses.decides, np.int64),
        column=fixed(pulses.column, np.int64),
        coils=fixed(coils, np.int64),
        first_row=fixed(np.arange(sources + 1), np.int64),
        told_sensor=sensor,
    )
