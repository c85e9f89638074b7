"""The least speed of a computer at which no task waits longer than is allowed."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from synth.computer.sizing.demand_service import Discipline, mean_waits
from synth.computer.sizing.task import TaskMix
from synth.computer.sizing.waiting_tail import start_tail

LEAST_PROBABILITY = 1e-8
"""Below this the inversion of a transform tells nothing."""

RELATIVE_ERROR = 1e-9
"""Of the speed that is found, for the mean; the tail's own error comes on top."""


@dataclass(frozen=True)
class AllowedWait:
    """Every task's time from request to begin of service: mean at most `mean_s`, P(more than `long_s`) at most `share`.

    Either may be missing, but not both; `long_s` and `share` go together.
    """

    mean_s: float | None = None
    long_s: float | None = None
    share: float | None = None


def needed_speed(mix: TaskMix, discipline: Discipline, allowed: AllowedWait) -> float:
    """The least speed, op/s, that keeps `allowed` for every task of `mix`; it is always found.

    A faster computer makes every wait shorter, so each bound has one speed, and the greatest of them is the answer.
    """
    speeds = []
    if allowed.mean_s is not None:
        limit_s = allowed.mean_s
        speeds.append(_least_speed(mix, lambda speed: math.log(longest_mean_s(mix, discipline, speed) / limit_s)))
    if allowed.long_s is not None and allowed.share is not None:
        long_s, share = allowed.long_s, allowed.share

        def too_often(speed_op_s: float) -> float:
            return math.log(max(largest_tail(mix, discipline, speed_op_s, long_s), LEAST_PROBABILITY / 10) / share)

        speeds.append(_least_speed(mix, too_often))
    return max(speeds)


def longest_mean_s(mix: TaskMix, discipline: Discipline, speed_op_s: float) -> float:
    """The mean time to the begin of service of the task that has the longest."""
    return max(wait.start_s for wait in mean_waits(mix.streams(speed_op_s), discipline))


def largest_tail(mix: TaskMix, discipline: Discipline, speed_op_s: float, long_s: float) -> float:
    """P(time to the begin of service > `long_s`) of the task where it is largest."""
    streams = mix.streams(speed_op_s)
    alike = streams[:1] if discipline is Discipline.FIRST_COME else streams
    return max(start_tail(streams, discipline, stream.name, long_s).value for stream in alike)


def _least_speed(mix: TaskMix, excess: Callable[[float], float]) -> float:
    """The root of `excess`, which falls with the speed: from above 0 next to overload to below 0 for fast ones."""
    from scipy.optimize import brentq

    overload = mix.operations_per_s
    spare = overload
    while excess(overload + spare) > 0.0:
        spare *= 2.0
    above = spare
    while excess(overload + spare) <= 0.0:
        spare *= 0.5
    # the spare speed, not the speed, is the unknown: near overload it is what counts
    root = brentq(lambda log: excess(overload + math.exp(log)), math.log(spare), math.log(above), xtol=RELATIVE_ERROR)
    return overload + math.exp(float(root))
