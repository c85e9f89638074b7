"""What a regulator does when an axle has rolled over a point sensor: the reading, the tracker and the rule as one step.

A controller calls it at the second pulse of every pair, whatever sensor it is of. The pair counts for the stage only if
the tracker believes it and the change of stage before it had ended by the middle of the reading; for the tracker it
counts in any case.

The rule: a passage has a row of K switching speeds t[0] ≤ … ≤ t[K − 1] for every stage in force; t[j] parts wanting
stage j from wanting stage j + 1. From the stage in force the regulator goes up while v > t[j], or down while v < t[j];
so a tie, v equal to a switching speed, holds. A command may pass over several stages: a cut meets few sensors.
Infinitely small below the stage in force: never lower so far; infinitely large from it on: never raise so far.

All arithmetic is float32. Safe answer: where the speed is NaN, infinite or negative, or where there is no such passage
or stage, the stage in force is held; see `decide` for why.
"""

from __future__ import annotations

from typing import Annotated, Any, Final

import numpy as np

from tuning_tables.language.records import flag, reading, whole
from tuning_tables.programs.held import LARGEST_NUMBER, MINUS_ONE, NOUGHT, Answer, HeldPassages, Stage, f32
from tuning_tables.programs.tracker import LONGEST_WAIT_S, Reading, Sensor, Since, Tracker, believed_passage

SHORTEST_READING_S: Final = np.float32(2.0**-20)
"""About 1 µs."""

OverBase = Annotated[Any, reading("from the first pulse of the pair to the second, s")]
Ended = Annotated[bool, flag("1: the change to that stage had ended by the middle between the two pulses")]


def wanted_stage(
    table: HeldPassages,
    passage: Annotated[int, whole("at which is decided, from 0 on")],
    stage: Stage,
    reading_m_s: Reading,
) -> Answer:
    """The stage wanted at a passage at which is decided; the stage itself: hold."""
    wanted = stage
    # The sizes are looked at, too, so that no index leaves a damaged table.
    is_there = 0 <= passage < table.passages <= table.switching_m_s.shape[0]
    has_stage = 0 <= stage < table.stages <= table.switching_m_s.shape[1]
    if is_there and has_stage and NOUGHT <= reading_m_s <= LARGEST_NUMBER:
        v = f32(reading_m_s)
        highest = table.stages - 1
        # Before the entrance no stage above the entrance stage is entered.
        if passage < table.before_entrance and table.entrance_stage < highest:
            highest = table.entrance_stage
        threshold = stage
        while threshold < highest:
            if v > table.switching_m_s[passage, stage, threshold]:
                threshold = threshold + 1
                wanted = threshold
            else:
                threshold = highest
        if wanted == stage:
            threshold = stage
            while threshold > 0:
                if v < table.switching_m_s[passage, stage, threshold - 1]:
                    threshold = threshold - 1
                    wanted = threshold
                else:
                    threshold = 0
    return wanted


def hear(table: HeldPassages, tracker: Tracker, sensor: Sensor, since_s: Since, over_base_s: OverBase) -> Answer:
    """The passage heard that a pair of pulses is taken for, or -1, and its speed."""
    v = MINUS_ONE
    if SHORTEST_READING_S <= over_base_s <= LONGEST_WAIT_S:
        v = table.base_m / f32(over_base_s)
    heard = believed_passage(table, tracker, sensor, since_s, v)
    return heard, v


def stage_after(
    table: HeldPassages,
    heard: Annotated[int, whole("the passage heard, -1: none")],
    stage: Stage,
    reading_m_s: Reading,
    transient_ended: Ended,
) -> Answer:
    """The stage wanted after a pair that is taken for this passage."""
    wanted = stage
    if heard >= 0 and transient_ended:
        wanted = wanted_stage(table, table.deciding[heard], stage, reading_m_s)
    return wanted


def at_pulse(
    table: HeldPassages,
    tracker: Tracker,
    sensor: Sensor,
    since_s: Since,
    over_base_s: OverBase,
    stage: Stage,
    transient_ended: Ended,
) -> Answer:
    """The stage to command at the second pulse of a pair; the stage itself: command nothing.

    To be called for every pair, of whatever sensor and axle, also while a change of stage is under way. The stage
    itself is the answer where the pair is not believed, decides nothing or comes during a change of stage, and to
    whatever cannot be true.
    """
    heard, v = hear(table, tracker, sensor, since_s, over_base_s)
    wanted = stage_after(table, heard, stage, v, transient_ended)
    return wanted
