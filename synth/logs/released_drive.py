"""Whether a released drive is open to the air, or rests at the edge of its dead band as in every other stage.

The drive of `plant_models` has one regulator for all stages: coming from above, stage 0 rests at the upper edge of the
dead band. Many drives leave the exhaust valve open when they are released; then the pressure goes on to that of the
air. No number of the model makes one of the other, so it is told from the readings of the gauge.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from plant_models.frozen_arrays import Ints
from plant_models.pneumatics import Pneumatics
from tuning_tables.pass_log.pass_log import PassLog

REST_S: Final = 2.0
"""So long after a command the pressure is near where it stays: four usual time constants, and the delays."""

FEWEST_VISITS: Final = 10
"""Of a kind; of fewer the middle says nothing."""

OPEN_BAND_KPA: Final = 1e-3
"""Dead band of a drive that is open to the air: less than any gauge shows."""


def released_drive_vents(log: PassLog, stage_pressures_kpa: tuple[float, ...], pneumatics: Pneumatics) -> bool:
    """Whether stage 0 rests nearer to the pressure of the air than to the edge of the dead band.

    The dead band is that of the log: how far from their pressure the other stages rest. False where there is no gauge,
    or where too few visits to stage 0, or to the other stages, last long enough.
    """
    rows = last_rows_of_visits(log)
    stage, read = log.stage[rows], log.pressure_kpa[rows]
    released, braking = read[stage == 0], stage > 0
    if len(released) < FEWEST_VISITS or np.count_nonzero(braking) < FEWEST_VISITS:
        return False
    off = np.abs(read[braking] - np.asarray(stage_pressures_kpa)[stage[braking]])
    air, band = max(stage_pressures_kpa[0], pneumatics.exhaust_pressure_kpa), float(np.median(off))
    return bool(abs(np.median(released) - air) < 0.5 * band)


def last_rows_of_visits(log: PassLog) -> Ints:
    """The last row with a reading of each visit to a stage, of those that lasted `REST_S` by then."""
    begins = np.diff(log.stage, prepend=-1) != 0
    begins[log.first_row[:-1]] = True
    first = np.flatnonzero(begins)
    visit = np.cumsum(begins) - 1
    read = np.isfinite(log.pressure_kpa)
    last = np.full(len(first), -1)
    np.maximum.at(last, visit[read], np.flatnonzero(read))
    known = last >= 0
    long = log.time_s[last[known]] - log.time_s[first[known]] >= REST_S
    return np.asarray(last[known][long], dtype=np.int64)
