"""What simulated passes with point sensors leave behind: exits, and what came of every passage."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.kernels.loop.passage_regulator import DECIDED, NO_DECISION, NOT_BELIEVED, NOT_HEARD, UNFINISHED
from synth.simulation.passes import ExitSample, PassTrace
from synth.simulation.replicates import Interval, share_of

__all__ = [
    "DECIDED",
    "HEARD",
    "MISTAKEN",
    "NOT_BELIEVED",
    "NOT_HEARD",
    "NO_DECISION",
    "TAKEN",
    "UNFINISHED",
    "PassReadings",
    "PassageSample",
    "PassageTrace",
    "shares_of_outcomes",
]

TAKEN: Final = (DECIDED, UNFINISHED)
"""Outcomes of pulses that were taken for a passage at which is decided."""

MISTAKEN: Final = (NOT_BELIEVED, NO_DECISION)
"""Of those that were taken for none."""

HEARD: Final = (*TAKEN, *MISTAKEN)


@frozen_arrays
class PassageSample(ExitSample):
    """Exits of n passes, and `outcome` uint8 (n, M): what came of the first pulse pair of each deciding passage.

    `NOT_HEARD`: the cut did not come there, or no pair was heard; `DECIDED`: the rule was asked; `UNFINISHED`: a
    transient had not ended by the middle of the reading; `NOT_BELIEVED`: the tracker took the pair for no passage;
    `NO_DECISION`: it took the pair for a passage at which nothing is decided.
    """

    outcome: NDArray[np.uint8]


@frozen_arrays
class PassReadings:
    """The pulse pairs that the regulator heard in one pass, in their order, arrays (pairs,).

    `time_s` of the second pulse as heard and `middle_s` of the reading; `told_sensor`; `passage`, the true one, −1 if
    the pair was none; `believed`, the passage that the regulator took it for, −1: none; both are numbers among all
    passages heard, as in `PassageTable.heard_path_m`. `reading_m_s` as told; `outcome` as in `PassageSample`; `stage`
    commanded from then on.
    """

    time_s: Floats
    middle_s: Floats
    told_sensor: Ints
    passage: Ints
    believed: Ints
    reading_m_s: Floats
    outcome: NDArray[np.uint8]
    stage: Ints


@frozen_arrays
class PassageTrace(PassTrace):
    """One pass event by event, and what the regulator heard; `measured_m_s` is that of a pulse pair, else NaN."""

    readings: PassReadings


def shares_of_outcomes(
    sample: PassageSample, of: Sequence[int], among: Sequence[int]
) -> tuple[tuple[float, Interval], ...]:
    """For every passage the share of cuts that met one of the outcomes `of`, and its 95 % interval.

    Of those that met one of the outcomes `among` there; NaN where none did.
    """
    nothing = (float("nan"), (float("nan"), float("nan")))
    found = []
    for outcome in sample.outcome.T:
        weight = np.where(np.isin(outcome, among), sample.weight, 0.0)
        found.append(share_of(np.isin(outcome, of), weight) if weight.any() else nothing)
    return tuple(found)
