"""Which stage to command: the decision rule of a table with switching lines. And what is wrong with a cut, or with
what is known of it: the alarm word, and which table follows from it.

At the stage commanded last, with the path s of the first axle and the speed v:

    lower   if the stage has a  lower line and  v < lower(s)
    raise   if the stage has an upper line and  v > upper(s), but before the entrance only below the entrance stage
    hold    otherwise; so a tie, v equal to the line, holds

After lower or raise the same question is asked again at the next stage down or up, with the same s and v. It ends at
hold, at the opposite answer, or when the command has gone as far as it may: at rest to any stage; at any time one
stage, as the next sample asks again.

In a table with slopes the lines are surfaces: slope (P - P_k) is added to lower(s) and to upper(s). P is the pressure
of the gauge, clamped into the pressures from stage 0 to the highest stage that the table raises to; P_k is that of the
stage asked for. A pressure that is not finite counts as P_k: the gauge is silent, and the valves are going there.

Before the entrance is s < 0, after rounding and clamping; 0.0 and -0.0 are at the entrance. The entrance stage bounds
what the rule commands there. It lowers nothing: a cut that is taken over at a higher stage breaks the interlock.

All arithmetic is float32, one rounding an operation. The speed is compared as it is, however far outside the range of
speeds the lines were fitted on: far too fast must still brake.

Safe answer. A reading that cannot be true moves no valve: where path or speed is NaN, infinite or beyond the float32
numbers, where the speed is negative, or the stage does not exist, the answer is the stage asked for. A single false
reading is then harmless, as the pressure in force was right a sampling period ago; a lasting fault is for the
supervision above this rule, which alone knows whether braking fully or releasing is the safe side.
"""

from __future__ import annotations

from typing import Annotated, Any, Final

from tuning_tables.language.records import real, whole
from tuning_tables.programs.held import (
    BEGUN,
    DOUBTED,
    FACTOR,
    LARGEST_NUMBER,
    LEAST_NUMBER,
    LOWER,
    NOUGHT,
    ONE,
    REPEATED,
    SPEED_VARIANCE,
    UPPER,
    Answer,
    Estimate,
    LineTable,
    ObservedSpeed,
    Path,
    PathReading,
    Pressure,
    Speed,
    Stage,
    f32,
)


def line_speed(
    table: LineTable,
    stage: Stage,
    side: Annotated[int, whole("0: the lower line, 1: the upper one")],
    s: Path,
) -> Answer:
    """Speed of a line at path s, by Horner's rule from the highest power down."""
    power = table.powers - 1
    line = table.coefficient[stage, side, power]
    while power > 0:
        power = power - 1
        line = line * s + table.coefficient[stage, side, power]
    return line


def pressure_above(table: LineTable, stage: Stage, pressure_kpa: Pressure) -> Answer:
    """By how much the pressure, clamped, exceeds that of the stage, kPa; 0 where the gauge is silent."""
    above = NOUGHT
    # No comparison with a NaN is true.
    if LEAST_NUMBER <= pressure_kpa <= LARGEST_NUMBER:
        pressure = min(max(f32(pressure_kpa), table.pressure_kpa[0]), table.highest_kpa)
        above = pressure - table.pressure_kpa[stage]
    return above


def answer_at(
    table: LineTable,
    stage: Stage,
    s: Path,
    v: Speed,
    lower_rise: Annotated[Any, real("what the pressure adds to the lower line, m/s")],
    upper_rise: Annotated[Any, real("what it adds to the upper one, m/s")],
) -> Answer:
    """What the rule answers at one stage: -1 lower, 0 hold, 1 raise."""
    answer = 0
    if table.has_line[stage, LOWER] == 1:
        lower = line_speed(table, stage, LOWER, s)
        if table.has_gauge == 1:
            lower = lower + lower_rise
        if v < lower:
            answer = -1
    # Before the entrance a stage is raised only below the entrance stage.
    if answer == 0 and table.has_line[stage, UPPER] == 1 and (s >= NOUGHT or stage < table.entrance_stage):
        upper = line_speed(table, stage, UPPER, s)
        if table.has_gauge == 1:
            upper = upper + upper_rise
        if v > upper:
            answer = 1
    return answer


def decide(table: LineTable, stage: Stage, s_m: PathReading, v_m_s: ObservedSpeed, pressure_kpa: Pressure) -> Answer:
    """The stage to command; the stage itself: command nothing.

    At a stage: below its lower line, down to the next stage; above its upper line, up to the next; else hold, also on a
    line. After a step the same is asked at the stage reached, until it holds, or answers the opposite: so one command
    goes as far as any stage at rest, and one stage at any time. Before the entrance no stage above `entrance_stage` is
    asked for. The stage itself is the answer to whatever cannot be true: no such stage, a path or speed that is not
    finite, a negative speed.
    """
    wanted = stage
    # The sizes are looked at, too, so that no index leaves a damaged table.
    has_stage = (
        0 <= stage < table.stages <= table.coefficient.shape[0] and 1 <= table.powers <= table.coefficient.shape[2]
    )
    is_credible = LEAST_NUMBER <= s_m <= LARGEST_NUMBER and NOUGHT <= v_m_s <= LARGEST_NUMBER
    if has_stage and is_credible:
        s = min(max(f32(s_m), table.path_min_m), table.path_max_m)
        v = f32(v_m_s)
        lower_rise = NOUGHT
        upper_rise = NOUGHT
        if table.has_gauge == 1:
            above = pressure_above(table, stage, pressure_kpa)
            lower_rise = table.slope[stage, LOWER] * above
            upper_rise = table.slope[stage, UPPER] * above
        remaining = table.stages - 1
        if table.at_any_time == 1:
            remaining = 1
        before = 0
        while remaining > 0:
            remaining = remaining - 1
            answer = answer_at(table, wanted, s, v, lower_rise, upper_rise)
            after = wanted + answer
            # A damaged table may ask for a stage that it has not.
            if answer == 0 or answer + before == 0 or after < 0 or after >= table.stages:
                remaining = 0
            else:
                wanted = after
                before = answer
    return wanted


LOST_ALARM: Final = 1
SENSOR_ALARM: Final = 2
LIGHTER_ALARM: Final = 4
HEAVIER_ALARM: Final = 8
"""Bits of the alarm word. Lost: the standard deviation of the speed is beyond its limit, answers are cautious. Sensor:
readings are doubted, or one repeats itself. Lighter, heavier: the brake works more, or less, on this cut than on any
of the table's category; its weight may be wrong."""


def alarms(table: LineTable, estimate: Estimate) -> Answer:
    """The alarm word of a cut: 1 lost, 2 sensor doubted, 4 lighter, 8 heavier than its category, added up."""
    raised = 0
    if table.breaks > 0 and estimate[BEGUN] > NOUGHT:
        if estimate[SPEED_VARIANCE] > table.lost_variance:
            raised = raised + LOST_ALARM
        if estimate[DOUBTED] > NOUGHT or estimate[REPEATED] >= table.frozen:
            raised = raised + SENSOR_ALARM
        off = estimate[FACTOR] - ONE
        if off > table.unlikely:
            raised = raised + LIGHTER_ALARM
        off = NOUGHT - off
        if off > table.unlikely:
            raised = raised + HEAVIER_ALARM
    return raised


def table_after(
    raised: Annotated[int, whole("what `alarms` says of the cut by table `present`")],
    present: Annotated[int, whole("the table that brakes the cut")],
    last: Annotated[int, whole("the tables are 0 to last, from the lightest category to the heaviest")],
) -> Answer:
    """Which of several tables brakes a cut from now on.

    Each table's own estimator observes every sample. A neighbour takes over where the weight alone is in doubt: a radar
    that is doubted may be what is wrong.
    """
    after = present
    if raised == LIGHTER_ALARM and present > 0:
        after = present - 1
    if raised == HEAVIER_ALARM and present < last:
        after = present + 1
    return after
