"""Which trains of many are worth a look: the one in which most went wrong, a typical one, the first."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from synth.hump.trains.outcomes import TrainOutcomes

TYPICAL_AMONG: Final = 20
"""A typical train is one of so many, which are humped again together with the first one in no more time than it."""


@dataclass(frozen=True)
class ChosenTrain:
    """The train `number`, from 0, and why it is shown."""

    number: int
    why: str

    @property
    def title(self) -> str:
        """What a menu calls it."""
        return f"train {self.number + 1}: {self.why}"


def chosen_trains(found: TrainOutcomes) -> tuple[ChosenTrain, ...]:
    """The worst train first, then a typical one and the first one; each train once.

    Worst: most catch-ups; of these most contacts in a last position and stops, then most over-speeds, then the first.
    Typical, of the first few: the median of catch-ups and, of such trains, the one of the usual pace.
    """
    gone_wrong = found.caught_in_last + found.stopped
    order = np.lexsort((found.train, -found.overspeed.sum(axis=1), -gone_wrong, -found.caught))
    worst = int(order[0])
    usual = np.abs(found.caught - np.sort(found.caught)[len(found) // 2])
    pace = found.span_s / np.maximum(found.span_cars, 1.0)
    few = slice(0, TYPICAL_AMONG)
    typical = int(np.lexsort((found.train[few], np.abs(pace - np.median(pace))[few], usual[few]))[0])
    caught = int(found.caught[worst])
    why = f"most catch-ups, {caught}" if caught else "none caught up; most other alarms"
    chosen = (
        ChosenTrain(int(found.train[worst]), why),
        ChosenTrain(int(found.train[typical]), "typical"),
        ChosenTrain(int(found.train[0]), "the first"),
    )
    return tuple({each.number: each for each in reversed(chosen)}.values())[::-1]
