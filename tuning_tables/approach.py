"""The approach: the path before the entrance on which the regulator already acts, and what it may do there."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Annotated, Final

import numpy as np

from tuning_tables.declared.members import require_declared
from tuning_tables.declared.numbers import Count, Number
from tuning_tables.declared.texts import Word
from tuning_tables.stage import MOST_STAGES

LENGTH_RANGE_M: Final = (0.001, 100.0)


class Interlock(Enum):
    """When the regulator may take over a cut; the value is the word in files.

    `POSITION_CLEAR`: only when the cut ahead has left the position, its last axle out of it, and then only when the
    stage commanded is at most the entrance stage.
    """

    POSITION_CLEAR = "position_clear"


@dataclass(frozen=True)
class Approach:
    """The regulator acts from before the entrance, where the first axle is at s = -length_m.

    Before the entrance, s < 0, no stage above `entrance_stage` (0..K of its table) may be commanded; at the entrance
    and behind it, any. Raises `InvalidTable`.

    Examples
    --------
    >>> from tuning_tables import Approach
    >>> Approach(length_m=4.0, entrance_stage=2).interlock
    <Interlock.POSITION_CLEAR: 'position_clear'>
    """

    length_m: Annotated[float, Number("it acts from so far before the entrance", *LENGTH_RANGE_M)]
    entrance_stage: Annotated[int, Count("highest stage that may be commanded there", 0, MOST_STAGES - 1)]
    interlock: Annotated[Interlock, Word("when it may take over a cut", Interlock)] = Interlock.POSITION_CLEAR

    def __post_init__(self) -> None:
        require_declared(self, "approach")


def same_approach(one: Approach | None, other: Approach | None) -> bool:
    """Whether a controller holds the same of both, the length as float32; or there is neither."""
    if one is None or other is None:
        return one is other
    return np.float32(one.length_m) == np.float32(other.length_m) and one.entrance_stage == other.entrance_stage


def entrance_stage(approach: Approach | None, stages: int) -> int:
    """The highest stage that may be commanded before the entrance: the highest of `stages` without approach."""
    return stages - 1 if approach is None else approach.entrance_stage
