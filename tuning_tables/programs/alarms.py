"""What is wrong with a cut, or with what is known of it: the alarm word, and which table follows from it."""

from __future__ import annotations

from typing import Annotated, Final

from tuning_tables.language.records import whole
from tuning_tables.programs.estimate import BEGUN, DOUBTED, FACTOR, REPEATED, SPEED_VARIANCE, Estimate
from tuning_tables.programs.line_table import LineTable
from tuning_tables.programs.numbers import NOUGHT, ONE, Answer

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
