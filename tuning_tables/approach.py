"""The approach: the path before the entrance on which the regulator already acts, and what it may do there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from tuning_tables.requirement import require_between, require_count

LENGTH_RANGE_M: Final = (0.001, 100.0)

INTERLOCK: Final = "position_clear"
"""The regulator takes over a cut only when the cut ahead has left the position, its last axle out of it."""


@dataclass(frozen=True)
class Approach:
    """The regulator acts from `length_m` (1 mm to 100 m) before the entrance, where the first axle is at s = -length_m.

    Before the entrance, s < 0, no stage above `entrance_stage` (0..K of its table) may be commanded; at the entrance
    and behind it, any. The interlock is the same for all (see `INTERLOCK`): the regulator may take over a cut only when
    the cut ahead has left the position, and then only when the stage commanded is at most `entrance_stage`.

    Raises `InvalidTable`.
    """

    length_m: float
    entrance_stage: int

    def __post_init__(self) -> None:
        require_between(self.length_m, "approach.length_m", *LENGTH_RANGE_M)
        require_count(self.entrance_stage, "approach.entrance_stage", 0)


def same_approach(one: Approach | None, other: Approach | None) -> bool:
    """Whether a controller holds the same of both, the length as float32; or there is neither."""
    if one is None or other is None:
        return one is other
    return np.float32(one.length_m) == np.float32(other.length_m) and one.entrance_stage == other.entrance_stage


def entrance_stage(approach: Approach | None, stages: int) -> int:
    """The highest stage that may be commanded before the entrance: the highest of `stages` without approach."""
    return stages - 1 if approach is None else approach.entrance_stage
