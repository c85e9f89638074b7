"""The pressure regulator of a retarder, one function for each of its parts (zhukovitsky-2012, figure 4), the gauge that
it reads, noisy and quantised, and the brake pads.

The pads touch the wheels at a pressure P0, so the drive has a dead zone below it. What force follows from the pressure
above that, by the number N of braked wheel pairs, is `retarder.ForceLaw`; what deceleration,
`motion.path_coefficients`; how the slope varies by chance, `friction.Friction`.

The converter turns the pressure into the signal that is compared with the stage. The relay answers −1, 0 or +1. The
block of changing structure connects the drive to the supply, to the exhaust, or to itself; the valve delay before that
is `valve_drive.wait_after_command`. The drive is a link of first order whose time constant goes with the sign. Closed
on itself it is an integrator without an input, so the pressure stays.

`Pneumatics.respond` puts these parts together; `valve_drive.drive_on` states the flow once more for kernels.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from plant_models.errors import require_between
from plant_models.frozen_arrays import Floats
from plant_models.valve_drive import ValveDrive


def overpressure_kpa(pressure_kpa: Floats | float, touch_kpa: float) -> Floats:
    """p = max(0, P − P0), kPa, of the same shape."""
    return np.maximum(0.0, np.asarray(pressure_kpa, dtype=np.float64) - touch_kpa)


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


CONVERTER_FACTOR = 1.0
"""K4: the signal of a stage is its pressure in kPa, and so is the signal that is compared with it."""


class Connection(NamedTuple):
    """What the drive is connected to: the pressure that it tends to, kPa gauge, and its time constant, s."""

    input_kpa: float
    constant_s: float


def converted_kpa(pressure_kpa: float, factor: float = CONVERTER_FACTOR) -> float:
    """U_P = K4·P: the signal of a pressure."""
    return factor * pressure_kpa


def mismatch_kpa(stage_kpa: float, shown_kpa: float) -> float:
    """ε_U = U_k − U_P: how much pressure is missing to that of the stage; negative where there is too much."""
    return stage_kpa - shown_kpa


def relay(error_kpa: float, band_kpa: float) -> int:
    """sign(ε_U) outside the dead zone ±ε, 0 inside and at its edge."""
    if abs(error_kpa) <= band_kpa * (1.0 + 1e-12):  # at the edge, whatever rounding brought it there
        return 0
    return 1 if error_kpa > 0.0 else -1


def connected(sign: int, pressure_kpa: float, drive: ValveDrive) -> Connection:
    """Block of changing structure: supply for +1, exhaust for −1; for 0 the drive is closed on itself."""
    if sign > 0:
        return Connection(drive.supply_kpa, drive.fill_s)
    if sign < 0:
        return Connection(drive.exhaust_kpa, drive.exhaust_s)
    return Connection(pressure_kpa, 1.0)


def flowed_kpa(pressure_kpa: float, connection: Connection, time_s: float) -> float:
    """Pneumatic link of first order: the pressure after `time_s` with this connection."""
    asymptote, constant = connection
    return float(asymptote + (pressure_kpa - asymptote) * np.exp(-time_s / constant))


def flowing_time_s(pressure_kpa: float, connection: Connection, until_kpa: float) -> float:
    """Time for which the link flows from one pressure to another that lies on its way."""
    asymptote, constant = connection
    return float(constant * np.log((asymptote - pressure_kpa) / (asymptote - until_kpa)))
