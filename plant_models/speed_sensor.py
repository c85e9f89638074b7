"""Doppler (radar) speed sensor: sampled in time, noisy, quantised."""

from __future__ import annotations

import math
from dataclasses import dataclass

from plant_models.errors import require, require_between

FINEST_RESOLUTION_M_S = 1e-6
"""A thousand times finer than any Doppler sensor."""

MOST_MISSED = 0.5
"""Share of lost readings: with more, bursts of one reading would leave no room between them."""

LONGEST_BURST_S = 10.0
"""Mean burst of lost readings; a sensor that is silent for longer than a pass has failed."""


@dataclass(frozen=True)
class DopplerSensor:
    """Radar: measured speed = round((v + noise)/resolution)·resolution, once every period.

    Parameters
    ----------
    noise_m_s
        Standard deviation of white Gaussian noise, m/s.
    resolution_m_s
        Step of the readings, m/s, 1e-6 or more; 0: not quantised.
    sample_period_s
        Time between two readings, s.
    computing_delay_s
        From the sample to the command on the wires of the valves, s.
    missed_share
        Share of the readings that are lost.
    missed_burst_s
        They are lost in bursts of this mean length, s, of at least one reading each: a stationary Markov chain of two
        states, one step a sample.

    Raises
    ------
    PlantError
        A number out of range, or bursts shorter than a reading.

    Examples
    --------
    >>> from plant_models import DopplerSensor
    >>> radar = DopplerSensor(
    ...     noise_m_s=0.05, resolution_m_s=0.04, sample_period_s=0.1, computing_delay_s=0.02
    ... )
    >>> radar.exact, round(radar.reading_std_m_s, 4)
    (False, 0.0513)
    """

    noise_m_s: float
    resolution_m_s: float
    sample_period_s: float
    computing_delay_s: float
    missed_share: float = 0.0
    missed_burst_s: float = 0.6

    def __post_init__(self) -> None:
        require_between("sensor: noise_m_s", self.noise_m_s, 0.0, 1.0)
        require_between("sensor: resolution_m_s", self.resolution_m_s, 0.0, 1.0)
        require(
            self.resolution_m_s == 0.0 or self.resolution_m_s >= FINEST_RESOLUTION_M_S,
            f"sensor: resolution_m_s is {self.resolution_m_s!r}; it must be 0 (not quantised) or from "
            f"{FINEST_RESOLUTION_M_S:g} to 1",
        )
        require_between("sensor: sample_period_s", self.sample_period_s, 0.005, 2.0)
        require_between("sensor: computing_delay_s", self.computing_delay_s, 0.0, 2.0)
        require_between("sensor: missed_share", self.missed_share, 0.0, MOST_MISSED)
        require_between("sensor: missed_burst_s", self.missed_burst_s, 0.0, LONGEST_BURST_S)
        require(
            self.missed_share == 0.0 or self.missed_burst_s >= self.sample_period_s,
            f"sensor: missed_burst_s is {self.missed_burst_s!r}; it must be from {self.sample_period_s!r}, one reading "
            f"(sample_period_s), to {LONGEST_BURST_S:g} where readings are lost (missed_share)",
        )

    @property
    def missed_readings(self) -> float:
        """Mean number of readings in a burst of lost ones."""
        return self.missed_burst_s / self.sample_period_s

    @property
    def exact(self) -> bool:
        """Neither noisy nor quantised."""
        return self.noise_m_s == 0.0 and self.resolution_m_s == 0.0

    @property
    def reading_std_m_s(self) -> float:
        """Std of one reading, `measured_speed_std` of noise and quantisation together, m/s."""
        return measured_speed_std(self.noise_m_s, self.resolution_m_s)

    @property
    def repeat_probability(self) -> float:
        """Probability that two readings of one speed are equal.

        It is the mean of `max(0, 1 - |d|/resolution)`, d their noise: the chance of one cell for both, its place being
        uniform. 0 without quantisation, 1 without noise.
        """
        if self.resolution_m_s == 0.0:
            return 0.0
        if self.noise_m_s == 0.0:
            return 1.0
        cells = self.resolution_m_s / (2.0 * self.noise_m_s)  # one cell, in √2 standard deviations of the difference
        return math.erf(cells) - (1.0 - math.exp(-(cells**2))) / (cells * math.sqrt(math.pi))


def measured_speed_std(noise_m_s: float, resolution_m_s: float) -> float:
    """Std of the measured speed, m/s: noise and the equivalent of quantisation, resolution/√12; 1e-4 at least."""
    return max(math.hypot(noise_m_s, resolution_m_s / math.sqrt(12.0)), 1e-4)
