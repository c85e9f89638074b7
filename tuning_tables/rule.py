"""The decision rule of the regulator, stated once for the controller, the simulator and the generated code.

At the stage commanded last, with the path s of the first axle and the speed v:

    lower   if the stage has a  lower line and  v < lower(s)
    raise   if the stage has an upper line and  v > upper(s), but before the entrance only below the entrance stage
    hold    otherwise; so a tie, v equal to the line, holds

After lower or raise the same question is asked again at the next stage down or up, with the same s and v. It ends at
hold, at the opposite answer, or when the command has gone as far as it may: `farthest` stages. The stage where it ends
is the answer: the stage to command; it is the stage asked for where the first answer is hold.

How far one command may go follows from when a table decides. At rest: to any stage. At any time: one stage, as the
next sample asks again.

In a table with slopes the lines are surfaces: slope (P - P_k) is added to lower(s) and to upper(s). P is the pressure
of the gauge, clamped into the pressures from stage 0 to the highest stage that the table raises to; P_k is that of the
stage asked for. A pressure that is not finite counts as P_k: the gauge is silent, and the valves are going there. Only
tables that decide at any time have slopes.

The lower line is looked at first; as lower(s) < upper(s) in every `ControllerTable`, both can never ask at once. Before
the entrance is s < 0, after rounding and clamping; 0.0 and -0.0 are at the entrance. The entrance stage bounds what the
rule commands there. It lowers nothing: a cut that is taken over at a higher stage breaks the interlock (`approach`).

All arithmetic is float32, one rounding an operation, Horner's rule from the highest power down, no fused multiply-add:
c[r], then repeatedly (value * s) + c[i]; with slopes, last, value + slope * (P - P_k). A path outside the valid range
is clamped into it. The speed is compared as it is, however far outside the range of speeds the lines were fitted on:
far too fast must still brake.

Safe answer. A reading that cannot be true moves no valve: where path or speed is NaN, infinite or beyond the float32
numbers, where the speed is negative, or the stage does not exist, the answer is the stage asked for. A single false
reading is then harmless, as the pressure in force was right a sampling period ago; a lasting fault is for the
supervision above this rule, which alone knows whether braking fully or releasing is the safe side.
"""

from __future__ import annotations

import math
from typing import Any, Final

import numpy as np
import numpy.typing as npt

from tuning_tables.active_table import ActiveTable
from tuning_tables.estimator import alarms, hand_on, observe
from tuning_tables.table import ControllerTable

LARGEST_READING: Final = 3.4028234663852886e38  # the largest float32 number
NO_RISES: Final = (np.float32(0.0), np.float32(0.0))
NO_GAUGE: Final = math.nan
"""The pressure, kPa, of a controller without gauge, or whose gauge is out of order."""


def decide(
    coefficients: npt.NDArray[np.float32],
    has_line: npt.NDArray[np.bool_],
    valid_range: npt.NDArray[np.float32],
    limits: tuple[int, int],
    stage: int,
    s_m: float,
    v_m_s: float,
    rise: Any = NO_RISES,
) -> int:
    """The stage to command for one reading; the arrays are those of a `ControllerTable`, and only they are trusted.

    coefficients float32 (K+1, 2, degree+1), has_line bool (K+1, 2), valid_range float32 (4,); limits: the entrance
    stage, 0..K (K where there is no approach), and by how many stages the command may go, 1..K; stage 0..K, path and
    speed in any float width (rounded to float32 before use); `rise`: what `rises` gives for `stage`, none for a table
    without slopes. Pure; raises nothing for any number.

    `numba.njit(decide)` compiles this text as it stands and gives the same answers: hence one function without helpers,
    and no literal in the arithmetic, which would promote it to double precision.
    """
    # Written so that NaN fails it, and before the conversion, so that no number overflows in it.
    if not (-LARGEST_READING <= s_m <= LARGEST_READING and 0.0 <= v_m_s <= LARGEST_READING):
        return stage
    if stage < 0 or stage >= coefficients.shape[0]:
        return stage
    s = np.float32(s_m)
    v = np.float32(v_m_s)
    if s < valid_range[0]:
        s = valid_range[0]
    if s > valid_range[1]:
        s = valid_range[1]
    highest = coefficients.shape[2] - 1
    entrance_stage, farthest = limits
    reached, before = stage, 0
    for _ in range(farthest):
        step = 0
        if has_line[reached, 0]:
            line_speed = coefficients[reached, 0, highest]
            for power in range(highest - 1, -1, -1):
                line_speed = line_speed * s + coefficients[reached, 0, power]
            if v < line_speed + rise[0]:
                step = -1
        if step == 0 and has_line[reached, 1] and not (s < 0 and reached >= entrance_stage):
            line_speed = coefficients[reached, 1, highest]
            for power in range(highest - 1, -1, -1):
                line_speed = line_speed * s + coefficients[reached, 1, power]
            if v > line_speed + rise[1]:
                step = 1
        if step == 0 or step == -before:
            break
        before = step
        reached += step
    return reached


def rises(
    slopes: npt.NDArray[np.float32],
    pressures: npt.NDArray[np.float32],
    highest_raised: int,
    stage: int,
    pressure_kpa: float,
) -> Any:
    """What the pressure adds to the lower and to the upper line of `stage`, float32 m/s; 0 for no such stage.

    slopes float32 (K+1, 2), pressures float32 (K+1,), `highest_raised` the stage to whose pressure the reading is
    clamped. As `decide`, it can be compiled by numba as it stands.
    """
    if stage < 0 or stage >= pressures.shape[0] or not (-LARGEST_READING <= pressure_kpa <= LARGEST_READING):
        return NO_RISES
    p = np.float32(pressure_kpa)
    if p < pressures[0]:
        p = pressures[0]
    if p > pressures[highest_raised]:
        p = pressures[highest_raised]
    above = p - pressures[stage]
    return slopes[stage, 0] * above, slopes[stage, 1] * above


def decide_for(
    table: ControllerTable | ActiveTable, stage: int, s_m: float, v_m_s: float, pressure_kpa: float = NO_GAUGE
) -> int:
    """The stage to command by `table`, or by lines chosen from a book, for one reading of path and speed at `stage`.

    `stage` is the one commanded last; a table that decides at rest (`table.decisions`) may only be asked when its
    pressure is reached. `pressure_kpa`, gauge, is looked at where the table has slopes.
    """
    rise = rises(table.slopes, table.pressures, table.highest_raised, stage, pressure_kpa)
    limits = table.entrance_stage, table.farthest
    return decide(table.coefficients, table.has_line, table.valid_range, limits, stage, s_m, v_m_s, rise)


def speed_for(
    table: ControllerTable | ActiveTable,
    state: npt.NDArray[np.float32],
    s_m: float,
    v_m_s: float,
    overpressure_kpa: float,
) -> float:
    """The speed to ask `decide_for` with, m/s: that of the table's estimator, or the measured one if it has none.

    To be called once at every sample, also during a change of stage; `state` is the cut's own (`estimator.begin`), the
    overpressure the mean of max(0, P - P0) since the sample before. See `estimator.observe`; with either kind of table
    `estimator.unseen_samples` says for how long no reading was believed.
    """
    if table.estimator is None:
        return hand_on(state, v_m_s)
    return float(observe(table.estimator.parameters, table.estimator.work, state, s_m, v_m_s, overpressure_kpa))


def alarms_for(table: ControllerTable | ActiveTable, state: npt.NDArray[np.float32]) -> int:
    """The alarm word of a cut after `speed_for`, see `estimator.alarms`; 0 for a table without estimator."""
    return 0 if table.estimator is None else alarms(table.estimator.parameters, state)


def decide_many(
    table: ControllerTable | ActiveTable,
    stage: npt.ArrayLike,
    s_m: npt.ArrayLike,
    v_m_s: npt.ArrayLike,
    pressure_kpa: npt.ArrayLike = NO_GAUGE,
) -> npt.NDArray[np.integer[Any]]:
    """`decide_for` for whole arrays at once, with identical answers.

    stage (integers), s_m, v_m_s and pressure_kpa broadcast against each other; the result has the broadcast shape and
    the type of the stages. Raises `TypeError` where the stages are not integers.
    """
    with np.errstate(invalid="ignore"):  # a signalling NaN is an incredible reading like any other
        readings = (np.asarray(each, dtype=np.float64) for each in (s_m, v_m_s, pressure_kpa))
        stages, paths, speeds, kpa = np.broadcast_arrays(np.asarray(stage), *readings)
    if stages.dtype.kind not in "iu":
        raise TypeError(f"stage has dtype {stages.dtype}, but stages are integers.")
    credible = (np.abs(paths) <= LARGEST_READING) & (speeds >= 0) & (speeds <= LARGEST_READING)
    credible &= (stages >= 0) & (stages < table.coefficients.shape[0])
    # An incredible reading is replaced by one that is harmless to compute with; its answer is masked below.
    first = np.where(credible, stages, 0).astype(np.intp)
    s = np.where(credible, paths, 0).astype(np.float32)
    v = np.where(credible, speeds, 0).astype(np.float32)
    s = np.where(s < table.valid_range[0], table.valid_range[0], s)
    s = np.where(s > table.valid_range[1], table.valid_range[1], s)
    rise = table.slopes[first] * _above(table, first, kpa)[..., np.newaxis]
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


def _above(
    table: ControllerTable | ActiveTable, stage: npt.NDArray[np.intp], pressure_kpa: npt.NDArray[np.float64]
) -> npt.NDArray[np.float32]:
    """P - P_k, P clamped; 0 where no pressure is known."""
    known = np.abs(pressure_kpa) <= LARGEST_READING
    p = np.where(known, pressure_kpa, 0).astype(np.float32)
    p = np.where(p < table.pressures[0], table.pressures[0], p)
    p = np.where(p > table.pressures[table.highest_raised], table.pressures[table.highest_raised], p)
    above: npt.NDArray[np.float32] = np.where(known, p - table.pressures[stage], np.float32(0.0))
    return above
