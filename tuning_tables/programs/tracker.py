"""Which passage a pair of pulses was, or none that can be believed.

A sensor tells its own number, when it was passed and how fast; it does not tell which axle. The tracker holds what it
believes of the cut: the last passage, the speed there, the time since. A pulse pair belongs to the next passage over
that sensor that the cut can have reached in that time: with the speed there and the speed now, each as far off as
allowed, it rolls farthest if it gains speed first and loses it last, and least far if it loses first and gains last.
Passages over two sensors may lie so near to each other that their pairs come in either order: if none follows, the cut
may have been at the last one before. Where there is no such passage, or the speed now cannot follow from the speed
there, the pair is not believed: nothing is commanded. So a pulse too many, too early or from a sensor out of order is
not believed, unless a cut could have made it. Where pulses are lost, a pair may be taken for an earlier passage over
the same sensor, never for a later one.

A first pulse can be false itself, and then every true one would contradict it. So a pair that is not believed is kept
as a *rival*; a pair that follows from the rival and not from what was believed makes the regulator change its mind.

The passages must be those of every axle that gives pulses: the pulses of axles that the tracker does not know follow
from each other, and make it change its mind.

What faults cost: of a dead sensor its own passages alone. A pair that is not believed costs nothing. With one axle, a
lost pair costs its own passage alone, and a pair too many at most the next one. With several axles a lost pair may set
back those that follow, until they contradict.

All arithmetic is float32, one rounding an operation, in the order written.
"""

from __future__ import annotations

from typing import Annotated, Any, Final, TypeAlias

import numpy as np
import numpy.typing as npt

from tuning_tables.language.records import Record, reading, real, whole
from tuning_tables.programs.held import HALF, MINUS_ONE, NONE, NOUGHT, ONE, Answer, HeldPassages, Speed, f32

PASSAGE, SPEED_M_S, TIME_S, RIVAL, RIVAL_SPEED_M_S, RIVAL_TIME_S = range(6)

TRACKER: Final = Record(
    "tracker",
    "What is known of the cut in the retarder. Closed; one for each cut, begun before its first pulse.",
    {
        "passage": real("the last that is believed, a whole number; -1: none"),
        "speed_m_s": real("there, m/s"),
        "time_s": real("since, s"),
        "rival": real("passage of the last pair that was not believed; -1: none"),
        "rival_speed_m_s": real("there, m/s"),
        "rival_time_s": real("since, s"),
    },
    is_state=True,
)

Tracker: TypeAlias = Annotated[npt.NDArray[np.float32], TRACKER]
"""float32 (6,)."""

LONGEST_WAIT_S: Final = np.float32(1e6)
"""Times stop there."""

Sensor: TypeAlias = Annotated[int, whole("its number, from 0 in the order of the path")]
Since: TypeAlias = Annotated[
    Any, reading("from the second pulse of the pair before, of whatever sensor, or from the beginning of the cut, s")
]
Reading: TypeAlias = Annotated[Any, reading("base over the time between the two pulses, m/s")]
Last: TypeAlias = Annotated[Any, real("a passage; -1: none")]
There: TypeAlias = Annotated[Any, real("speed there, m/s")]
Elapsed: TypeAlias = Annotated[Any, real("time since, s")]


def begin_cut(tracker: Tracker) -> None:
    """Forget the last cut: to be called once for each cut before its first pulse."""
    tracker[PASSAGE] = MINUS_ONE
    tracker[SPEED_M_S] = NOUGHT
    tracker[TIME_S] = NOUGHT
    tracker[RIVAL] = MINUS_ONE
    tracker[RIVAL_SPEED_M_S] = NOUGHT
    tracker[RIVAL_TIME_S] = NOUGHT


def can_be(table: HeldPassages, last: Last, there: There, elapsed: Elapsed) -> Answer:
    """Whether a half of the state can be: its memory has not lost its content."""
    is_sound = False
    # No comparison with a NaN is true.
    if (
        MINUS_ONE <= last < f32(table.heard)
        and NOUGHT <= there <= table.greatest_m_s
        and NOUGHT <= elapsed <= LONGEST_WAIT_S
    ):
        number = f32(int(last))
        is_sound = number == last
    return is_sound


def ways(table: HeldPassages, there: There, elapsed: Elapsed, v: Speed) -> Answer:
    """Whether speed v can follow from the speed there; the least and the greatest way that the cut can have come."""
    more = ONE + table.speed_tolerance
    less = ONE - table.speed_tolerance
    fast = there * more
    slow = there * less
    fast_now = v * more
    slow_now = v * less
    gained = table.acceleration_m_s2 * elapsed
    lost = table.deceleration_m_s2 * elapsed
    fastest = fast + gained
    slowest = slow - lost
    follows = slow_now <= fastest and fast_now >= slowest
    nearest = NOUGHT
    farthest = NOUGHT
    if follows:
        both = table.acceleration_m_s2 + table.deceleration_m_s2
        half_gain = HALF * table.acceleration_m_s2
        half_loss = HALF * table.deceleration_m_s2
        # Farthest: it gains speed up to the turn, and loses it for the rest.
        turn = min(max((fast_now - fast + lost) / both, NOUGHT), elapsed)
        rest = elapsed - turn
        farthest = turn * (fast + half_gain * turn) + rest * (fast_now + half_loss * rest) + table.path_tolerance_m
        # Nearest: the other way round, and it may have stood in between.
        turn = min(max((slow - slow_now + gained) / both, NOUGHT), elapsed)
        rest = elapsed - turn
        if table.deceleration_m_s2 * turn > slow:
            turn = slow / table.deceleration_m_s2
            rest = slow_now / table.acceleration_m_s2
        nearest = turn * (slow - half_loss * turn) + rest * (slow_now - half_gain * rest) - table.path_tolerance_m
    return follows, nearest, farthest


def next_passage(table: HeldPassages, sensor: Sensor, v: Speed, last: Last, there: There, elapsed: Elapsed) -> Answer:
    """The passage over the sensor that follows from a last one: the first behind it, else the last one before it."""
    found = NONE
    if last >= NOUGHT:
        follows, nearest, farthest = ways(table, there, elapsed, v)
        if follows:
            here = int(last)
            met = table.heard
            while met > 0:
                met = met - 1
                way = table.path_m[met] - table.path_m[here]
                is_better = met > here or (met < here and found == NONE)
                if is_better and table.sensor[met] == sensor and nearest <= way <= farthest:
                    found = met
    return found


def first_over(table: HeldPassages, sensor: Sensor) -> Answer:
    """The first passage over a sensor."""
    first = NONE
    met = table.heard
    while met > 0:
        met = met - 1
        if table.sensor[met] == sensor:
            first = met
    return first


def take_pair(
    table: HeldPassages, tracker: Tracker, sensor: Sensor, v: Speed, first: Annotated[int, whole("its first passage")]
) -> Answer:
    """The passage that a credible pair is taken for; what is believed, or the rival, becomes this pair."""
    found = first
    if tracker[PASSAGE] >= NOUGHT or tracker[RIVAL] >= NOUGHT:
        found = next_passage(table, sensor, v, tracker[PASSAGE], tracker[SPEED_M_S], tracker[TIME_S])
    reached = max(f32(found), tracker[PASSAGE])
    if found == NONE:
        found = next_passage(table, sensor, v, tracker[RIVAL], tracker[RIVAL_SPEED_M_S], tracker[RIVAL_TIME_S])
        reached = max(f32(found), tracker[RIVAL])
    if found == NONE:
        tracker[RIVAL] = f32(first)
        tracker[RIVAL_SPEED_M_S] = v
        tracker[RIVAL_TIME_S] = NOUGHT
    else:
        tracker[PASSAGE] = reached
        tracker[SPEED_M_S] = v
        tracker[TIME_S] = NOUGHT
        tracker[RIVAL] = MINUS_ONE
    return found


def believed_passage(
    table: HeldPassages, tracker: Tracker, sensor: Sensor, since_s: Since, reading_m_s: Reading
) -> Answer:
    """The passage heard that a pair of pulses is taken for, from 0 on; -1: it is not believed.

    The tracker is brought up to date. A tracker that cannot be (a memory lost its content) is begun anew. A time that
    cannot be leaves it as it is; a speed that is not credible lets the time pass alone.
    """
    found = NONE
    # The size is looked at, too, so that no index leaves a damaged table.
    if 1 <= table.heard <= table.path_m.shape[0]:
        is_sound = can_be(table, tracker[PASSAGE], tracker[SPEED_M_S], tracker[TIME_S])
        is_rival_sound = can_be(table, tracker[RIVAL], tracker[RIVAL_SPEED_M_S], tracker[RIVAL_TIME_S])
        if not (is_sound and is_rival_sound):
            begin_cut(tracker)
        if NOUGHT <= since_s <= LONGEST_WAIT_S:
            tracker[TIME_S] = min(tracker[TIME_S] + f32(since_s), LONGEST_WAIT_S)
            tracker[RIVAL_TIME_S] = min(tracker[RIVAL_TIME_S] + f32(since_s), LONGEST_WAIT_S)
            if table.least_m_s <= reading_m_s <= table.greatest_m_s:
                first = first_over(table, sensor)
                if first >= 0:
                    found = take_pair(table, tracker, sensor, f32(reading_m_s), first)
    return found
