"""The decision rule as Python asks it, for one reading or for whole arrays, and the alarm word of a cut; the rules
themselves are `programs.decide` and `programs.alarms`.
"""

from __future__ import annotations

import math
from enum import IntFlag
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from tuning_tables.active_table import ActiveTable
from tuning_tables.programs.decide import HEAVIER_ALARM, LIGHTER_ALARM, LOST_ALARM, SENSOR_ALARM, alarms, decide
from tuning_tables.programs.observe import observe
from tuning_tables.table import ControllerTable


class Alarm(IntFlag):
    """What is wrong with a cut, or with what is known of it; the values are those of C and Structured Text.

    `LOST`: the standard deviation of the speed is beyond its limit, answers are cautious. `SENSOR`: readings are
    doubted, or one repeats itself. `LIGHTER`, `HEAVIER`: the brake works more, or less, on this cut than on any of the
    category of the table; its weight may be wrong.
    """

    LOST = LOST_ALARM
    SENSOR = SENSOR_ALARM
    LIGHTER = LIGHTER_ALARM
    HEAVIER = HEAVIER_ALARM


NO_GAUGE: Final = math.nan
"""The pressure, kPa, of a controller without gauge, or whose gauge is out of order."""


def decide_for(
    table: ControllerTable | ActiveTable, stage: int, s_m: float, v_m_s: float, pressure_kpa: float = NO_GAUGE
) -> int:
    """Ask a table for one reading.

    Parameters
    ----------
    table
        A table, or lines chosen from a book.
    stage
        The stage commanded last. A table that decides at rest (`table.decisions`) may only be asked when the pressure
        of this stage is reached.
    s_m
        Path of the first axle, m.
    v_m_s
        Measured speed, m/s; of a table with estimator what `speed_for` gives.
    pressure_kpa
        Gauge pressure, kPa. It is looked at where the table has slopes; NaN: no gauge.

    Returns
    -------
    int
        The stage to command; `stage` itself: command nothing. That is the answer to a reading that cannot be true, too.

    Notes
    -----
    The rule is that of the page "Table formats", section "The rule", in float32; C and Structured Text give the same
    bits.

    Examples
    --------
    With `table` from the example of `ControllerTable`:

    >>> from tuning_tables import decide_for
    >>> (
    ...     decide_for(table, stage=0, s_m=5.0, v_m_s=5.0),
    ...     decide_for(table, stage=1, s_m=5.0, v_m_s=3.5),
    ... )
    (1, 0)
    >>> decide_for(table, stage=0, s_m=5.0, v_m_s=float("nan"))
    0
    """
    return int(decide(table.held, stage, *readings(s_m, v_m_s, pressure_kpa)))


def readings(*numbers: float) -> list[np.float32]:
    """The numbers as a controller has them, float32; infinite where float32 cannot hold them."""
    with np.errstate(over="ignore", invalid="ignore"):  # a signalling NaN is an incredible reading like any other
        return [np.float32(number) for number in numbers]


def speed_for(
    table: ControllerTable | ActiveTable,
    state: npt.NDArray[np.float32],
    s_m: float,
    v_m_s: float,
    overpressure_kpa: float,
) -> float:
    """Take one sample into the estimate of a cut, and tell the speed to ask `decide_for` with.

    To be called once at every sample, also during a change of stage.

    Parameters
    ----------
    table
        A table, or lines chosen from a book.
    state
        The state of the cut, float32 (16,), which is brought up to date; `begin` makes it.
    s_m
        Path of the first axle, m.
    v_m_s
        Measured speed, m/s; NaN: the reading is lost.
    overpressure_kpa
        Mean of max(0, P - P0) since the sample before, kPa.

    Returns
    -------
    float
        The speed of the table's estimator, m/s; that which was measured, rounded to float32, where the table has none.
        -1 as long as no speed was measured.

    Notes
    -----
    The estimator is a Kalman filter of speed, friction and resistance; see the page "Table formats".

    Examples
    --------
    With `table` from the example of `ControllerTable`:

    >>> from tuning_tables import begin, speed_for
    >>> state = begin()
    >>> speed_for(table, state, s_m=0.4, v_m_s=5.25, overpressure_kpa=0.0)
    5.25
    """
    return float(observe(table.held, state, *readings(s_m, v_m_s, overpressure_kpa)))


def alarms_for(table: ControllerTable | ActiveTable, state: npt.NDArray[np.float32]) -> Alarm:
    """What is wrong with a cut, or with what is known of it, after `speed_for`.

    Parameters
    ----------
    table
        A table, or lines chosen from a book.
    state
        The state of the cut, float32 (16,).

    Returns
    -------
    Alarm
        The alarms, added up; 0 for none, and for a table without estimator.

    Examples
    --------
    With `table` from the example of `ControllerTable`:

    >>> from tuning_tables import alarms_for, begin
    >>> alarms_for(table, begin())
    <Alarm: 0>
    """
    return Alarm(int(alarms(table.held, state)))


def decide_many(
    table: ControllerTable | ActiveTable,
    stage: npt.ArrayLike,
    s_m: npt.ArrayLike,
    v_m_s: npt.ArrayLike,
    pressure_kpa: npt.ArrayLike = NO_GAUGE,
) -> npt.NDArray[np.integer[Any]]:
    """Ask a table for whole arrays of readings, with the answers of `decide_for`.

    Parameters
    ----------
    table
        A table, or lines chosen from a book.
    stage
        Integers: the stages commanded last.
    s_m
        Paths, m.
    v_m_s
        Speeds, m/s.
    pressure_kpa
        Gauge pressures, kPa; NaN: no gauge. All four broadcast against each other.

    Returns
    -------
    ndarray
        The stages to command, of the broadcast shape and of the type of `stage`.

    Raises
    ------
    TypeError
        Stages that are not integers.

    Examples
    --------
    With `table` from the example of `ControllerTable`:

    >>> from tuning_tables import decide_many
    >>> decide_many(table, [0, 1], 5.0, [[5.0, 5.0], [3.5, 3.5]])
    array([[1, 1],
           [0, 0]])
    """
    with np.errstate(over="ignore", invalid="ignore"):
        wide = (np.asarray(each, dtype=np.float64) for each in (s_m, v_m_s, pressure_kpa))
        stages, paths, speeds, kpa = np.broadcast_arrays(np.asarray(stage), *(each.astype(np.float32) for each in wide))
    if stages.dtype.kind not in "iu":
        raise TypeError(f"stage has dtype {stages.dtype}, but stages are integers.")
    credible = np.isfinite(paths) & (speeds >= 0) & np.isfinite(speeds)
    credible &= (stages >= 0) & (stages < table.coefficients.shape[0])
    # An incredible reading is replaced by one that is harmless to compute with; its answer is masked below.
    first = np.where(credible, stages, 0).astype(np.intp)
    s = np.where(credible, paths, np.float32(0.0))
    v = np.where(credible, speeds, np.float32(0.0))
    s = np.where(s < table.valid_range[0], table.valid_range[0], s)
    s = np.where(s > table.valid_range[1], table.valid_range[1], s)
    rise = rises_at(table, first, kpa)
    reached, before, asked = first, np.zeros_like(first), credible
    for _ in range(table.farthest):
        step = _steps(table, reached, s, v, rise)
        asked = asked & (step != 0) & (step != -before)
        if not asked.any():
            break
        before = step
        reached = np.where(asked, reached + step, reached)
    return np.where(credible, reached, stages).astype(stages.dtype)


def _steps(
    table: ControllerTable | ActiveTable,
    stage: npt.NDArray[np.intp],
    s: npt.NDArray[np.float32],
    v: npt.NDArray[np.float32],
    rise: npt.NDArray[np.float32],
) -> npt.NDArray[np.intp]:
    """-1 lower, 0 hold, 1 raise at each stage, s clamped; `rise` (..., 2): what the pressure adds to its lines."""
    line_speed = table.coefficients[stage, :, -1]
    for power in range(table.coefficients.shape[2] - 2, -1, -1):
        line_speed = line_speed * s[..., np.newaxis] + table.coefficients[stage, :, power]
    line_speed = line_speed + rise
    has_line = table.has_line[stage]
    is_gated = (s < 0) & (stage >= table.entrance_stage)
    raises = has_line[..., 1] & (v > line_speed[..., 1]) & ~is_gated
    lowers = has_line[..., 0] & (v < line_speed[..., 0])
    return np.where(lowers, -1, np.where(raises, 1, 0))


def rises_at(
    table: ControllerTable | ActiveTable, stage: int | npt.NDArray[np.intp], pressure_kpa: npt.NDArray[Any]
) -> npt.NDArray[np.float32]:
    """What pressures add to the lower and to the upper line of `stage`, (..., 2), m/s: slope (P - P_k), P clamped.

    0 where no pressure is known.
    """
    with np.errstate(over="ignore", invalid="ignore"):  # infinite where float32 cannot hold it: not known
        kpa = np.asarray(pressure_kpa).astype(np.float32)
    known = np.isfinite(kpa)
    p = np.where(known, kpa, np.float32(0.0))
    p = np.where(p < table.pressures[0], table.pressures[0], p)
    p = np.where(p > table.pressures[table.highest_raised], table.pressures[table.highest_raised], p)
    above: npt.NDArray[np.float32] = np.where(known, p - table.pressures[stage], np.float32(0.0))
    return table.slopes[stage] * above[..., np.newaxis]
