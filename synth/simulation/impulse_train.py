"""Ideal impulse element and zero-order hold: a row of impulses, and the value that is held from each to the next.

The impulse element makes an impulse of each command of the controller; its area is the signal of the stage that is
commanded. The zero-order hold makes steps of the impulses (zhukovitsky-2012, figure 4).
"""

from __future__ import annotations

import math

Impulse = tuple[float, float]
"""(instant in s, area)."""

ImpulseTrain = tuple[Impulse, ...]
"""Impulses in the order of time."""


def resting_train(value: float) -> ImpulseTrain:
    """The train of a signal that has had this value for ever."""
    return ((-math.inf, value),)


def with_command(
    train: ImpulseTrain, instant_s: float, stage: int, stage_pressures_kpa: tuple[float, ...]
) -> ImpulseTrain:
    """The train with one more impulse at its end, whose area is the pressure of `stage`.

    Raises `ValueError` for an instant before that of the last.
    """
    if instant_s < train[-1][0]:
        raise ValueError(f"impulse train: a command at {instant_s:g} s comes after that at {train[-1][0]:g} s")
    return (*train, (instant_s, stage_pressures_kpa[stage]))


def held(train: ImpulseTrain, time_s: float) -> float:
    """Zero-order hold: the area of the last impulse at or before `time_s`, which must not be before the first."""
    return next(value for instant, value in reversed(train) if instant <= time_s)
