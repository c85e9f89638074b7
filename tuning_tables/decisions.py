"""When and where a regulator with lines over the path decides: its clock, its decisions, and the approach, the
path before the entrance on which it already acts.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Annotated, Final

import numpy as np

from tuning_tables.declared.members import require_declared
from tuning_tables.declared.numbers import Count, Number
from tuning_tables.declared.texts import Word
from tuning_tables.stage import MOST_STAGES

DELAY_RANGE_S: Final = (0.0, 2.0)


@dataclass(frozen=True)
class RegulatorClock:
    """The clock of the regulator that the table was made for; with another one its figures do not hold.

    Raises `InvalidTable`.

    Examples
    --------
    >>> from tuning_tables import RegulatorClock
    >>> RegulatorClock(sample_period_s=0.1, computing_delay_s=0.02).sample_period_s
    0.1
    """

    sample_period_s: Annotated[float, Number("time from sample to sample", 0.001, 2.0)]
    computing_delay_s: Annotated[
        float, Number("from the sample to the command on the wires of the valves", *DELAY_RANGE_S)
    ]

    def __post_init__(self) -> None:
        require_declared(self, "clock")

    def __str__(self) -> str:
        return in_words("sampled", self.sample_period_s, self.computing_delay_s)


def in_words(what: str, period_s: float, delay_s: float) -> str:
    """A clock for the eye: `what` it does every period, and how soon a command is on the wires."""
    return f"{what} every {period_s:g} s; a command is on the wires of the valves {delay_s:g} s later"


class Decisions(Enum):
    """The samples at which a table is asked; the values are those of its JSON.

    `AT_REST`: only those at which no change of stage is under way. `AT_ANY_TIME`: every sample; the stage asked for is
    then the one commanded last, whatever pressure it has reached.
    """

    AT_REST = "at_rest"
    AT_ANY_TIME = "at_any_time"


def farthest(decisions: Decisions, stages: int) -> int:
    """By how many of its `stages` one command of a table may go: to any at rest, one at any time, as it is asked again.

    See `tuning_tables.rule`.
    """
    return stages - 1 if decisions is Decisions.AT_REST else 1


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
