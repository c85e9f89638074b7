"""The alarm word of a cut in Python; how it comes about is `programs.alarms`."""

from __future__ import annotations

from enum import IntFlag

from tuning_tables.programs.alarms import HEAVIER_ALARM, LIGHTER_ALARM, LOST_ALARM, SENSOR_ALARM


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
