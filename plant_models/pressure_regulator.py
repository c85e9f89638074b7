"""The pressure regulator of a retarder, one function for each of its parts (zhukovitsky-2012, figure 4).

The converter turns the pressure into the signal that is compared with the stage. The relay answers −1, 0 or +1. The
block of changing structure connects the drive to the supply, to the exhaust, or to itself; the valve delay before that
is `valve_drive.wait_after_command`. The drive is a link of first order whose time constant goes with the sign. Closed
on itself it is an integrator without an input, so the pressure stays.

`Pneumatics.respond` puts these parts together; `valve_drive.drive_on` states the flow once more for kernels.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from plant_models.valve_drive import ValveDrive

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
