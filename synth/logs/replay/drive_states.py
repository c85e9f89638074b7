"""Where in measured passes the drive rests, so that the regulator may command, and with what it braked before."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays
from plant_models.stage_regulator import Actuator, stage_locked_actuator
from synth.logs.fitting_passes import FittingPasses
from synth.simulation.closed_loop import SUBSTEP_S
from tuning_tables.pass_log.pass_log import PassLog


@frozen_arrays
class DriveStates:
    """Of n rows: `resting`: the command before has come to rest, by the model; `stage_before` in force until the row;
    `overpressure_kpa`: mean of max(0, P − P0) since the sample before, 0 at the first."""

    resting: Bools
    stage_before: Ints
    overpressure_kpa: Floats


def drive_states(passes: FittingPasses) -> DriveStates:
    """The drive along the passes. Rows are samples of the regulator; where some are missing, the clock counts on."""
    log, plant = passes.log, passes.plant
    period = plant.sensor.sample_period_s
    substeps = math.ceil(period / SUBSTEP_S)
    actuator = stage_locked_actuator(plant.position, plant.sensor, plant.position.top_stage, substeps)
    n = len(log.time_s)
    found = Columns(np.zeros(n, dtype=np.bool_), np.zeros(n, dtype=np.int64), np.zeros(n))
    for number in range(len(log)):
        fill_in(log, number, actuator, (period, plant.approach.initial_stage), found)
    return DriveStates(*found)


class Columns(NamedTuple):
    """Memory for `DriveStates`, while it is filled."""

    resting: Bools
    stage_before: Ints
    overpressure_kpa: Floats


def fill_in(log: PassLog, number: int, actuator: Actuator, begin: tuple[float, int], found: Columns) -> None:
    """The rows of pass `number`; `begin`: sampling period, and the stage in which the drive rests before."""
    period, stage = begin
    rows = log.rows(number)
    sample = np.rint((log.time_s[rows] - log.time_s[rows.start]) / period).astype(np.int64).tolist()
    parts = actuator.chain_overpressure_kpa.reshape(len(actuator.chain_mode), -1, actuator.substeps).mean(axis=2)
    mode, chain, since = actuator.mode_of(stage), -1, 0
    for row, at, told in zip(range(rows.start, rows.stop), sample, log.stage[rows].tolist(), strict=True):
        played = at - since
        if row > rows.start:
            found.overpressure_kpa[row] = (
                parts[chain, played - 1]
                if chain >= 0 and 0 < played <= actuator.chain_samples[chain]
                else actuator.mode_overpressure_kpa[mode]
            )
        found.stage_before[row] = stage
        found.resting[row] = chain < 0 or played >= actuator.chain_samples[chain]
        if told != stage:
            # A command that did not wait for rest is taken as if it had: the model has no other.
            chain, since, stage = int(actuator.command[mode, told]), at, told
            mode = int(actuator.chain_mode[chain])
