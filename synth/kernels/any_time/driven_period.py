"""Kernel of the drive over one sampling period when commands may come during a transient.

The drive's own functions are compiled here unchanged (`plant_models.valve_drive`): solver, simulator and the tests of
the physics share one text. The kernels' fingerprint covers `plant_models`.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from plant_models import valve_drive
from plant_models.frozen_arrays import Floats
from synth.kernels.compiling import kernel, raising

wait_after_command = raising(valve_drive.wait_after_command)
drive_on = raising(valve_drive.drive_on)


class SampledDrive(NamedTuple):
    """`valves` (`plant_models.valve_drive.ValveDrive`), pressures of the stages (K + 1,).

    A pass begins with `initial_stage` at rest at `initial_kpa`; before the entrance no higher stage than
    `entrance_stage` is commanded.
    """

    valves: Any
    stage_kpa: Floats
    initial_stage: int
    initial_kpa: float
    entrance_stage: int
    computing_delay_s: float
    parts: int


@kernel
def play_period(pressure, wait, old_kpa, new_kpa, computing_delay, period, drive, over):
    """From one sample to the next; `old_kpa` is commanded until `computing_delay`, then `new_kpa`.

    `over` (S,) becomes the exact mean overpressure in each of S equal parts of the period. Returns (pressure, wait).
    """
    parts = over.shape[0]
    part = period / parts
    commanded = False
    for i in range(parts):
        total, start = 0.0, i * part
        if commanded:
            pressure, wait, total = drive_on(pressure, wait, new_kpa, part, drive)
        elif computing_delay >= start + part * (1.0 - 1e-9):
            pressure, wait, total = drive_on(pressure, wait, old_kpa, part, drive)
        else:
            before = max(computing_delay - start, 0.0)
            pressure, wait, total = drive_on(pressure, wait, old_kpa, before, drive)
            wait = wait_after_command(pressure, wait, old_kpa, new_kpa, drive)
            pressure, wait, after = drive_on(pressure, wait, new_kpa, part - before, drive)
            total += after
            commanded = True
        over[i] = total / part
    return pressure, wait
