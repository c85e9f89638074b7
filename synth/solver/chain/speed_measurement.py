"""How the solver takes what the regulator measures: as noise alone, or with the staircase of the quantisation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, Self

import numpy as np

from plant_models import DopplerSensor
from plant_models.frozen_arrays import Floats
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
