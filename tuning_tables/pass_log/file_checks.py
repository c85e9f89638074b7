"""Faults of a whole file: units, and a pressure that does not follow the stage. Each gives one sentence's end or none.

They look at all sound passes together, and say nothing where these are too few.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from tuning_tables.pass_log.pass_log import PassLog

FEWEST_STEPS: Final = 50
SLOWEST_M_S: Final = 0.5
USUAL_RATIO: Final = 1.25
FEWEST_PRESSURES: Final = 200
LOWEST_PRESSURE_KPA: Final = 20.0
LEAST_CORRELATION: Final = 0.3

UNIT_RATIOS: Final = (
    (3.6, "speed_m_s", 'in km/h: give [units] speed_m_s = "km/h" in a mapping'),
    (1.0 / 3.6, "speed_m_s", "divided by 3.6 once too often: take the unit km/h out of the mapping"),
    (2.237, "speed_m_s", 'in mph: give [units] speed_m_s = "mph" in a mapping'),
    (0.3048, "path_m", 'in feet: give [units] path_m = "ft" in a mapping'),
    (1000.0, "time_s", 'in milliseconds: give [units] time_s = "ms" in a mapping'),
    (0.001, "time_s", "divided by 1000 once too often: take the unit ms out of the mapping"),
)
"""Measured speed / path in time, the column that is suspected, and what it seems to be."""


def file_fault(log: PassLog) -> tuple[int, str, str] | None:
    """(row of the log, column, what is wrong with it) of the first fault of a whole file; None where it has none."""
    return speed_fault(log) or pressure_unit_fault(log) or stage_fault(log)


def speed_fault(log: PassLog) -> tuple[int, str, str] | None:
    """The measured speed is the path in time, but for a unit."""
    inner = np.ones(len(log.time_s), dtype=np.bool_)
    inner[log.first_row[:-1]] = False
    time = np.diff(log.time_s, prepend=np.nan)
    rolled = np.diff(log.path_m, prepend=np.nan)
    seen = 0.5 * (log.speed_m_s + np.concatenate(([np.nan], log.speed_m_s[:-1])))
    usable = inner & (rolled > 0.0) & (time > 0.0) & (seen > SLOWEST_M_S)
    if np.count_nonzero(usable) < FEWEST_STEPS:
        return None
    ratio = float(np.median(seen[usable] / (rolled[usable] / time[usable])))
    if 1.0 / USUAL_RATIO <= ratio <= USUAL_RATIO:
        return None
    known, column, remedy = min(UNIT_RATIOS, key=lambda entry: abs(math.log(ratio / entry[0])))
    if abs(math.log(ratio / known)) > math.log(USUAL_RATIO):
        column, remedy = "speed_m_s", "in another unit than m/s, or path_m than m: give their units in a mapping"
    what = f"the measured speed is {ratio:.3g} times the path in time; {column} seems to be {remedy}"
    return int(np.argmax(usable)), column, what


def pressure_unit_fault(log: PassLog) -> tuple[int, str, str] | None:
    """Where stages are commanded there is some pressure."""
    braking = np.isfinite(log.pressure_kpa) & (log.stage > 0)
    if np.count_nonzero(braking) < FEWEST_STEPS:
        return None
    highest = float(log.pressure_kpa[braking].max())
    if highest > LOWEST_PRESSURE_KPA:
        return None
    what = (
        f"never above {highest:.3g} kPa, though stages above 0 are commanded; if it is in bar, give [units] "
        'pressure_kpa = "bar" in a mapping, else look at the gauge'
    )
    return int(np.argmax(braking)), "pressure_kpa", what


def stage_fault(log: PassLog) -> tuple[int, str, str] | None:
    """The pressure follows the stage."""
    known = np.isfinite(log.pressure_kpa)
    stage, pressure = log.stage[known].astype(np.float64), log.pressure_kpa[known]
    if len(stage) < FEWEST_PRESSURES or np.ptp(stage) == 0.0:
        return None
    follows = 0.0 if np.ptp(pressure) == 0.0 else float(np.corrcoef(stage, pressure)[0, 1])
    if follows >= LEAST_CORRELATION:
        return None
    what = (
        f"the stage is without effect: the pressure does not follow it (correlation {follows:.2f}, at least "
        f"{LEAST_CORRELATION:g} is needed); look whether stage and gauge are of the same drive"
    )
    return int(np.argmax(known & (log.stage > 0))), "stage", what
