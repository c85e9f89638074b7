"""What of an estimate the passes really tell, and why the rest cannot be told."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from synth.logs import unknowns as asked
from synth.logs.estimate import Estimate

MOST_LEFT = 0.7
"""Of what was unknown before: a number of which more than this is still unknown, is not identified."""

CLOSE = 0.9
"""Correlation of the errors of two numbers from which on they are identified together better than apart."""

ALWAYS = (
    "Force slope and mean friction act by their product: the slope is identified for a mean friction of 1.",
    "Grade and mean running resistance act by their difference: resistance is identified for the configured grade.",
    "Computing delay and valve delays act by their sums: valve delays are those for the configured computing delay.",
)
"""What no log of passes can part, however long."""

WITHOUT_GAUGE = (
    "Without a pressure gauge delays, time constants and dead band are seen only by the motion: they are identified "
    "together much better than one by one."
)

SPEED_AS_PATH = "The path was summed up from the measured speed: what the sensor shows too much cannot be identified."


@dataclass(frozen=True)
class Finding:
    """One number: estimate, 95 % interval, what was taken before, and how much of what was unknown is `left` (0 to 1).

    `with_others`: (key, correlation) of numbers whose errors go with its own.
    """

    key: str
    unit: str
    value: float
    interval: tuple[float, float]
    before: float
    left: float
    with_others: tuple[tuple[str, float], ...]

    @property
    def identified(self) -> bool:
        """The passes tell it; if not, it stays as it was."""
        return self.left <= MOST_LEFT

    @property
    def within(self) -> bool:
        """What was taken before is inside the interval."""
        return self.interval[0] <= self.before <= self.interval[1]


def findings_of(found: Estimate) -> tuple[Finding, ...]:
    """All numbers of `found`."""
    # Of the law after the passes: the sandwich tells how the estimate scatters, not how much is known.
    left = np.sqrt(np.diag(np.linalg.inv(np.eye(len(found.u)) + found.information)))
    correlation = found.correlation()
    return tuple(_findings(found, left, correlation))


def _findings(found: Estimate, left: np.ndarray, correlation: np.ndarray) -> Iterator[Finding]:
    for number, unknown in enumerate(found.unknowns):
        others = tuple(
            (found.unknowns[i].key, float(correlation[number, i]))
            for i in np.argsort(-np.abs(correlation[number]))
            if i != number and abs(correlation[number, i]) >= CLOSE
        )
        yield Finding(
            unknown.key,
            "" if unknown.unit == "1" else unknown.unit,
            unknown.value(float(found.u[number])),
            found.interval(number),
            unknown.value(0.0),
            float(left[number]),
            others,
        )


def reasons(found: Estimate, path_is_independent: bool) -> tuple[str, ...]:
    """Why some numbers cannot be told, for a reader."""
    keys = {unknown.key for unknown in found.unknowns}
    more = () if asked.GAUGE_NOISE in keys else (WITHOUT_GAUGE,)
    return (*ALWAYS, *more, *(() if path_is_independent else (SPEED_AS_PATH,)))
