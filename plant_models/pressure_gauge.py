"""Pressure gauge on the drive of a retarder: noisy, quantised."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from plant_models.errors import require_between
from plant_models.frozen_arrays import Floats

USUAL_NOISE_KPA = 2.0
"""Of a gauge that nobody has measured: 0.2 % of a range of 1000 kPa. ASSUMED, engineering judgement: a usual
transmitter. Simulated logs are written with it, and an identification begins with it."""


@dataclass(frozen=True)
class PressureGauge:
    """Reading = round((P + noise)/resolution)·resolution, at the samples of the regulator.

    `noise_kpa`: std of white Gaussian noise; `resolution_kpa`: 0 means not quantised. It follows at once: what a pipe
    between drive and gauge does is part of the noise. Raises `PlantError` for values outside 0 … 100 kPa.
    """

    noise_kpa: float
    resolution_kpa: float = 0.0

    def __post_init__(self) -> None:
        require_between("gauge: noise_kpa", self.noise_kpa, 0.0, 100.0)
        require_between("gauge: resolution_kpa", self.resolution_kpa, 0.0, 100.0)

    def reading_kpa(self, pressure_kpa: Floats, z: Floats) -> Floats:
        """What it shows at `pressure_kpa`, with the standard normal numbers `z` of the same shape."""
        shown = pressure_kpa + self.noise_kpa * z
        if self.resolution_kpa > 0.0:
            shown = np.rint(shown / self.resolution_kpa) * self.resolution_kpa
        return shown
