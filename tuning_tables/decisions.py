"""When a regulator with lines over the path decides."""

from __future__ import annotations

from enum import Enum


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
