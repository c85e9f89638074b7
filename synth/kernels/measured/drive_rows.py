"""Kernel: the pressure of the drive along logged passes, from the commands that are logged."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from plant_models import valve_drive
from plant_models.frozen_arrays import Floats, Ints
from plant_models.valve_drive import ValveDrive
from synth.kernels.compiling import kernel, raising

drive_on = raising(valve_drive.drive_on)
wait_after_command = raising(valve_drive.wait_after_command)


class Commands(NamedTuple):
    """What the drive was told in passes of n rows in all.

    `time_s`, `stage` (n,) of the rows; `first_row` (m + 1,) of the passes; `initial_stage` that the drive rests in
    before the first row, reached from below; `stage_kpa` (K + 1,); `delay_s` from a row to the command on the wires;
    `settled`: each command is taken to have come when the pressure rested, whatever the numbers of the drive say.
    """

    time_s: Floats
    stage: Ints
    first_row: Ints
    initial_stage: int
    stage_kpa: Floats
    delay_s: float
    settled: bool


@kernel
def drive_rows(
    commands: Commands,
    drive: ValveDrive,
    released: ValveDrive,
    first: int,
    last: int,
    overpressure_kpa: Floats,
    pressure_kpa: Floats,
) -> None:
    """Fill in, for the passes `first` … `last` − 1, the pressure at each row and the mean of max(0, P − P0) over each
    part of the time to the next row; `overpressure_kpa` (n, parts), `pressure_kpa` (n,). Nothing follows a last row.

    `released`: the drive as it is while stage 0 is commanded."""
    parts = overpressure_kpa.shape[1]
    for number in range(first, last):
        begin, end = commands.first_row[number], commands.first_row[number + 1]
        told = commands.stage_kpa[commands.initial_stage]
        if commands.initial_stage > 0:
            now, kpa = drive, told - drive.band_kpa
        else:
            now, kpa = released, told + released.band_kpa
        wait, coming, in_s, after = 0.0, told, np.inf, now
        before = commands.initial_stage
        for row in range(begin, end):
            if commands.stage[row] != before:
                before = commands.stage[row]
                coming, in_s = commands.stage_kpa[before], commands.delay_s
                after = drive if before > 0 else released
            pressure_kpa[row] = kpa
            if row == end - 1:
                overpressure_kpa[row] = 0.0
                break
            part = (commands.time_s[row + 1] - commands.time_s[row]) / parts
            for j in range(parts):
                total, left = 0.0, part
                if in_s < left:
                    kpa, wait, total = drive_on(kpa, wait, told, in_s, now)
                    left -= in_s
                    if commands.settled:
                        kpa, wait = min(max(kpa, told - now.band_kpa), told + now.band_kpa), 0.0
                    # Where it rests, no valve is open, however narrow the dead band of the next stage is.
                    held = kpa if abs(told - kpa) <= now.band_kpa * (1.0 + 1e-12) else told
                    wait = wait_after_command(kpa, wait, held, coming, after)
                    told, in_s, now = coming, np.inf, after
                in_s -= left
                kpa, wait, more = drive_on(kpa, wait, told, left, now)
                overpressure_kpa[row, j] = (total + more) / part
