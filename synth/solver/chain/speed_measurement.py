"""How the solver takes what the regulator measures: as noise alone, or with the staircase of the quantisation."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from plant_models import DopplerSensor
from plant_models.speed_sensor import measured_speed_std

Lines = NDArray[np.float64]


class SpeedMeasurement(Protocol):
    """A measured speed as command probabilities need it."""

    @property
    def std_m_s(self) -> float:
        """Standard deviation of the measured speed about the true one, quantisation included."""
        ...

    def thresholds(self, lower_m_s: Lines, upper_m_s: Lines) -> tuple[Lines, Lines, float]:
        """(lower, upper, standard deviation): the same commands follow from comparing true speed + noise with them."""
        ...


@dataclass(frozen=True)
class SmoothMeasurement:
    """White noise of `std_m_s`, quantisation counted in: the cost stays differentiable in the lines."""

    std_m_s: float

    def thresholds(self, lower_m_s: Lines, upper_m_s: Lines) -> tuple[Lines, Lines, float]:
        """The lines themselves."""
        return lower_m_s, upper_m_s, self.std_m_s


@dataclass(frozen=True)
class QuantisedMeasurement:
    """White noise, then rounding to multiples of `resolution_m_s` > 0, as the sensor does it."""

    noise_m_s: float
    resolution_m_s: float

    @property
    def std_m_s(self) -> float:
        """Standard deviation of the measured speed, quantisation as an equivalent noise."""
        return measured_speed_std(self.noise_m_s, self.resolution_m_s)

    def thresholds(self, lower_m_s: Lines, upper_m_s: Lines) -> tuple[Lines, Lines, float]:
        """Half a step off the multiples of the resolution: there a rounded speed changes sides."""
        q = self.resolution_m_s
        lower, upper = q * (np.ceil(lower_m_s / q) - 0.5), q * (np.floor(upper_m_s / q) + 0.5)
        return lower, upper, measured_speed_std(self.noise_m_s, 0.0)


def smooth_measurement(sensor: DopplerSensor) -> SmoothMeasurement:
    """What lines are designed on."""
    return SmoothMeasurement(sensor.reading_std_m_s)


def quantised_measurement(sensor: DopplerSensor) -> SpeedMeasurement:
    """What a finished table is predicted with; a sensor that does not round has no staircase."""
    if sensor.resolution_m_s == 0.0:
        return smooth_measurement(sensor)
    return QuantisedMeasurement(sensor.noise_m_s, sensor.resolution_m_s)
