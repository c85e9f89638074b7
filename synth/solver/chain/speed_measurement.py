"""How the solver takes what is measured: of a radar as noise alone or with the staircase, and of a point sensor."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol, Self

import numpy as np

from plant_models import DopplerSensor, PointSensors
from plant_models.frozen_arrays import Floats, frozen_arrays
from plant_models.speed_sensor import measured_speed_std


class SpeedMeasurement(Protocol):
    """What is measured of a speed, as command probabilities need it.

    A *reading* rises with the speed, and its error has one standard deviation at all speeds: of a radar it is the
    measured speed itself. Lines (C, R, K + 1) are by command, decision and stage.
    """

    @property
    def std(self) -> float:
        """Standard deviation of a reading about what is read of the true speed, quantisation included."""
        ...

    def readings(self, speed_m_s: Floats) -> Floats:
        """What is read of true speeds at the decision, (E,), but for the error."""
        ...

    def thresholds(self, lines_m_s: Floats) -> tuple[Floats, float]:
        """(lines, standard deviation) in readings: reading + noise compared with them gives the same commands."""
        ...

    def slopes(self, lines_m_s: Floats) -> Floats:
        """Derivatives of the thresholds by the lines."""
        ...

    def speeds(self, lines: Floats) -> Floats:
        """Lines in m/s of lines in readings."""
        ...

    def behind(self, first: int, speed_m_s: Floats) -> SpeedMeasurement:
        """The same at the decisions from number `first` on, on a grid of other speeds."""
        ...


class _SpeedItself:
    """Of a radar, a reading is the measured speed."""

    def readings(self, speed_m_s: Floats) -> Floats:
        """The speeds."""
        return speed_m_s

    def slopes(self, lines_m_s: Floats) -> Floats:
        """Ones."""
        return np.ones_like(lines_m_s)

    def speeds(self, lines: Floats) -> Floats:
        """The lines."""
        return lines

    def behind(self, first: int, speed_m_s: Floats) -> Self:
        """This one: it is the same everywhere."""
        return self


@dataclass(frozen=True)
class SmoothMeasurement(_SpeedItself):
    """White noise of `std_m_s`, quantisation counted in: the cost stays differentiable in the lines."""

    std_m_s: float

    @property
    def std(self) -> float:
        """Standard deviation of the measured speed, m/s."""
        return self.std_m_s

    def thresholds(self, lines_m_s: Floats) -> tuple[Floats, float]:
        """The lines themselves."""
        return lines_m_s, self.std_m_s


@dataclass(frozen=True)
class QuantisedMeasurement(_SpeedItself):
    """White noise, then rounding to multiples of `resolution_m_s` > 0, as the sensor does it."""

    noise_m_s: float
    resolution_m_s: float

    @property
    def std(self) -> float:
        """Standard deviation of the measured speed, m/s, quantisation as an equivalent noise."""
        return measured_speed_std(self.noise_m_s, self.resolution_m_s)

    def thresholds(self, lines_m_s: Floats) -> tuple[Floats, float]:
        """Half a step off the multiples of the resolution: there a rounded speed changes sides."""
        q = self.resolution_m_s
        moved = np.empty_like(lines_m_s)
        moved[0::2] = q * (np.ceil(lines_m_s[0::2] / q) - 0.5)
        moved[1::2] = q * (np.floor(lines_m_s[1::2] / q) + 0.5)
        return moved, measured_speed_std(self.noise_m_s, 0.0)


def smooth_measurement(sensor: DopplerSensor) -> SmoothMeasurement:
    """What lines are designed on."""
    return SmoothMeasurement(sensor.reading_std_m_s)


def quantised_measurement(sensor: DopplerSensor) -> SpeedMeasurement:
    """What a finished table is predicted with; a sensor that does not round has no staircase."""
    if sensor.resolution_m_s == 0.0:
        return smooth_measurement(sensor)
    return QuantisedMeasurement(sensor.noise_m_s, sensor.resolution_m_s)


SHARE_OF_CELL = 0.4
"""Std of a cell of the speed grid, as part of its width, about what a probability that is put into cells forgets."""

SLOWEST_M_S = 1e-2


@frozen_arrays
class PassageMeasurement:
    """Readings are ∫ dv/σ(v), so that every reading has std 1; σ: error of the sensor and width of a cell together.

    The errors of a good sensor are smaller than the cells of the grid. Without the width of the cell, a command would
    come or go for the mass of a whole cell at once, and the cost would be no smooth function of the lines.
    `speed_m_s` (E,) of the grid.
    """

    sensors: PointSensors
    speed_m_s: Floats

    @property
    def std(self) -> float:
        """1."""
        return 1.0

    @cached_property
    def _table(self) -> tuple[Floats, Floats]:
        """(speeds, readings): the integral at speeds much denser than the grid, from the slowest on."""
        v = np.linspace(SLOWEST_M_S, float(self.speed_m_s[-1]) + 1.0, 4000)
        energy_step = 0.5 * float(self.speed_m_s[1]) ** 2
        std = np.hypot(self.sensors.reading_std_m_s(v), SHARE_OF_CELL * np.minimum(energy_step / v, v))
        steps = 0.5 * (1.0 / std[1:] + 1.0 / std[:-1]) * np.diff(v)
        return v, np.concatenate([[0.0], np.cumsum(steps)])

    def readings(self, speed_m_s: Floats) -> Floats:
        """The integral up to the speeds; below the slowest as if the error were the same there."""
        v, integral = self._table
        below = np.minimum(speed_m_s - v[0], 0.0) * (integral[1] - integral[0]) / (v[1] - v[0])
        found: Floats = np.interp(speed_m_s, v, integral) + below
        found.setflags(write=False)  # as the speeds of the grid are: kernels are compiled once for both
        return found

    def thresholds(self, lines_m_s: Floats) -> tuple[Floats, float]:
        """Lines in readings; infinite ones stay so."""
        finite = np.isfinite(lines_m_s)
        found = np.array(lines_m_s)
        found[finite] = self.readings(lines_m_s[finite])
        return found, 1.0

    def slopes(self, lines_m_s: Floats) -> Floats:
        """Derivatives of the thresholds by the lines; 0 where a line is infinite."""
        v, integral = self._table
        finite = np.isfinite(lines_m_s)
        cell = np.clip(np.searchsorted(v, np.where(finite, lines_m_s, v[0])) - 1, 0, len(v) - 2)
        found: Floats = np.where(finite, (integral[cell + 1] - integral[cell]) / (v[cell + 1] - v[cell]), 0.0)
        return found

    def speeds(self, lines: Floats) -> Floats:
        """Lines in m/s of lines in readings."""
        v, integral = self._table
        finite = np.isfinite(lines)
        found: Floats = np.where(finite, np.interp(np.where(finite, lines, 0.0), integral, v), lines)
        return found

    def behind(self, first: int, speed_m_s: Floats) -> PassageMeasurement:
        """The same on another grid."""
        return PassageMeasurement(self.sensors, speed_m_s)
