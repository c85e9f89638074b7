"""Kernel of forecasts: all choices of exit speeds of a few positions, compared by the margins to the neighbours."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from plant_models.frozen_arrays import Bools, Floats, Ints
from synth.kernels.compiling import borrowing, part_inline


class Legs(NamedTuple):
    """m cuts ahead of q positions, each with k exit speeds at most; s = 2 · elements marks: first axle in, last out.

    `time_s`, `speed_m_s` (m,) at the first entrance, `before_s` (m, s) times of marks that are over by then. Of a
    position and the free roll behind it: `choices` (q,); `speeds_m_s` (q, m, k); `won_m2_s2` (q, m), gain of v² in the
    pass without brake; `path_m` (q, m) of the pass, of which `share` (q, m, s) is behind the cut at a mark; `roll_s`
    (q, m, k, s), times after the pass; `ends_s`, `ends_m_s` (q, m, k), duration of the roll and speed at its end;
    `most_entry_m_s`, `least_entry_m_s`, `braked_m2_s2` (q, m), most loss of v² to the brake. NaN where a mark is not on
    that stretch.
    """

    time_s: Floats
    speed_m_s: Floats
    before_s: Floats
    choices: Ints
    speeds_m_s: Floats
    won_m2_s2: Floats
    path_m: Floats
    share: Floats
    roll_s: Floats
    ends_s: Floats
    ends_m_s: Floats
    most_entry_m_s: Floats
    least_entry_m_s: Floats
    braked_m2_s2: Floats


class Work(NamedTuple):
    """Memory of one call of `compare` for q positions and s marks: what is known ahead of each position (q + 1,), the
    choice that is looked at (q,), the marks of each stretch (q, s) and how many they are (q,)."""

    time_s: Floats
    speed_m_s: Floats
    ahead_s: Floats
    behind_s: Floats
    able: Bools
    beyond_m_s: Floats
    at: Ints
    met: Ints
    met_to: Ints


def work_for(legs: Legs) -> Work:
    """Memory for `compare`."""
    levels, marks = len(legs.choices), legs.before_s.shape[1]
    return Work(
        time_s=np.empty(levels + 1),
        speed_m_s=np.empty(levels + 1),
        ahead_s=np.empty(levels + 1),
        behind_s=np.empty(levels + 1),
        able=np.empty(levels + 1, dtype=np.bool_),
        beyond_m_s=np.zeros(levels + 1),
        at=np.zeros(levels, dtype=np.int64),
        met=np.empty((levels, marks), dtype=np.int64),
        met_to=np.empty(levels, dtype=np.int64),
    )


@part_inline
def mark_time(legs, q, i, k, s, time, speed, out):
    """When mark `s` is passed on stretch `q` that begins at `time` with `speed`, and whose pass ends at `out`; NaN if
    it is not there."""
    share = legs.share[q, i, s]
    if math.isnan(share):
        return out + legs.roll_s[q, i, k, s]
    if not math.isfinite(out):
        return math.inf
    return time + time_to(legs, q, i, k, speed, share)


@part_inline
def pass_end(legs, q, i, k, time, speed):
    """When the pass ends; infinite where the cut stops."""
    if speed > 0.0 and legs.speeds_m_s[q, i, k] > 0.0:
        return time + time_to(legs, q, i, k, speed, 1.0)
    return math.inf


@part_inline
def time_to(legs, q, i, k, speed, share):
    """How long a cut takes that comes with `speed` for this share of the path of the pass, on which v² falls evenly."""
    exit_speed = legs.speeds_m_s[q, i, k]
    between = math.sqrt(max(speed * speed + share * (exit_speed * exit_speed - speed * speed), 0.0))
    return 2.0 * legs.path_m[q, i] * share / (speed + between)


@part_inline
def is_able(legs, q, i, k, speed):
    """Whether a cut that comes to the position with `speed` can leave it with the choice `k`."""
    exit_speed = legs.speeds_m_s[q, i, k]
    unbraked = speed * speed + legs.won_m2_s2[q, i] + 1e-6
    return unbraked - legs.braked_m2_s2[q, i] <= exit_speed * exit_speed <= unbraked


@borrowing
def compare(legs, free_from_s, free_by_s, first, last, work, ahead_s, behind_s, able, beyond_m_s, arrival_s):
    """Fill, for cuts `first` … `last` − 1 and every combination c of choices, the least margins to the cuts ahead and
    behind, whether the cut is able to, how far its worst entry is beyond the limits, and when it arrives: all (m, c),
    the last position's choice running fastest."""
    levels, marks = len(legs.choices), legs.before_s.shape[1]
    time, speed, ahead, behind = work.time_s, work.speed_m_s, work.ahead_s, work.behind_s
    can, beyond, at, met, met_to = work.able, work.beyond_m_s, work.at, work.met, work.met_to
    for i in range(first, last):
        list_marks(legs, i, met, met_to)
        time[0], speed[0], can[0] = legs.time_s[i], legs.speed_m_s[i], True
        ahead[0], behind[0] = math.inf, math.inf
        for s in range(marks):
            ahead[0], behind[0] = nearer(legs.before_s[i, s], s, i, free_from_s, free_by_s, ahead[0], behind[0])
        for q in range(levels):
            at[q] = 0
        column, level = 0, 0
        while level >= 0:
            if level == levels:
                late = behind[level]
                for e in range(marks // 2):
                    if unknown_out(legs, i, e):
                        late = min(late, free_by_s[i, e] - time[level])
                ahead_s[i, column], behind_s[i, column] = ahead[level], late
                able[i, column], beyond_m_s[i, column], arrival_s[i, column] = can[level], beyond[level], time[level]
                column += 1
                level -= 1
                at[level] += 1
            elif at[level] == legs.choices[level]:
                at[level] = 0
                level -= 1
                if level >= 0:
                    at[level] += 1
            else:
                k = at[level]
                out = pass_end(legs, level, i, k, time[level], speed[level])
                near, far = ahead[level], behind[level]
                for j in range(met_to[level]):
                    s = met[level, j]
                    passed = mark_time(legs, level, i, k, s, time[level], speed[level], out)
                    near, far = nearer(passed, s, i, free_from_s, free_by_s, near, far)
                ahead[level + 1], behind[level + 1] = near, far
                can[level + 1] = can[level] and is_able(legs, level, i, k, speed[level])
                slow, fast = legs.least_entry_m_s[level, i], legs.most_entry_m_s[level, i]
                beyond[level + 1] = max(beyond[level], slow - speed[level], speed[level] - fast)
                time[level + 1], speed[level + 1] = out + legs.ends_s[level, i, k], legs.ends_m_s[level, i, k]
                level += 1


@part_inline
def list_marks(legs, i, met, met_to):
    """Fill the marks that cut `i` meets on each stretch, `met` (q, s), and how many, `met_to` (q,)."""
    for q in range(met.shape[0]):
        count = 0
        for s in range(met.shape[1]):
            if not (math.isnan(legs.share[q, i, s]) and math.isnan(legs.roll_s[q, i, 0, s])):
                met[q, count] = s
                count += 1
        met_to[q] = count


@part_inline
def nearer(passed, s, i, free_from_s, free_by_s, ahead, behind):
    """Least margins so far, and that of a mark that is passed at `passed`."""
    if math.isnan(passed):
        return ahead, behind
    if s % 2 == 0:
        margin = passed - free_from_s[i, s // 2]
        return (margin if margin < ahead else ahead), behind
    margin = free_by_s[i, s // 2] - passed
    return ahead, (margin if margin < behind else behind)


@part_inline
def unknown_out(legs, i, e):
    """Whether the first axle comes to element `e` on the way that is forecast, but the last one does not leave it."""
    comes, leaves = not math.isnan(legs.before_s[i, 2 * e]), not math.isnan(legs.before_s[i, 2 * e + 1])
    for q in range(len(legs.choices)):
        comes = comes or not math.isnan(legs.share[q, i, 2 * e]) or not math.isnan(legs.roll_s[q, i, 0, 2 * e])
        leaves = leaves or not math.isnan(legs.share[q, i, 2 * e + 1])
        leaves = leaves or not math.isnan(legs.roll_s[q, i, 0, 2 * e + 1])
    return comes and not leaves


@borrowing
def follow(legs, taken, first, last, times_s, ended_s):
    """Fill the times of all marks (m, s) and of the ends of passes (m, q) with the choices `taken` (q, m)."""
    levels, marks = len(legs.choices), legs.before_s.shape[1]
    for i in range(first, last):
        time, speed = legs.time_s[i], legs.speed_m_s[i]
        for s in range(marks):
            times_s[i, s] = legs.before_s[i, s]
        for q in range(levels):
            k = taken[q, i]
            ended_s[i, q] = out = pass_end(legs, q, i, k, time, speed)
            for s in range(marks):
                if math.isnan(times_s[i, s]):
                    times_s[i, s] = mark_time(legs, q, i, k, s, time, speed, out)
            time, speed = out + legs.ends_s[q, i, k], legs.ends_m_s[q, i, k]
        for e in range(marks // 2):
            if unknown_out(legs, i, e):
                times_s[i, 2 * e + 1] = time
