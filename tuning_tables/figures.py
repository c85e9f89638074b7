"""The numbers that qualify a table: where it holds, what was predicted of it, what a closed-loop run confirmed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Final

import numpy as np

from tuning_tables.declared.members import require_declared
from tuning_tables.declared.numbers import Count, Number, Row
from tuning_tables.errors import InvalidTable
from tuning_tables.requirement import require_rising

SHORTEST_RANGE: Final = 1e-3
"""Of path in m, of speed in m/s."""
FARTHEST: Final = 1e6
"""Of path in m, of speed in m/s."""


@dataclass(frozen=True)
class ValidRange:
    """The path and the speeds on which the lines were fitted.

    The rule clamps the path into this range and does not look at the speed range (see `rule.decide`). Both rise.

    Examples
    --------
    >>> from tuning_tables import ValidRange
    >>> ValidRange(s_m=(0.0, 22.5), v_m_s=(0.5, 8.0))
    ValidRange(s_m=(0.0, 22.5), v_m_s=(0.5, 8.0))
    """

    s_m: Annotated[tuple[float, float], Row(Number("least and greatest path", -FARTHEST, FARTHEST), "end", 2, 2)]
    v_m_s: Annotated[tuple[float, float], Row(Number("least and greatest speed", 0.0, FARTHEST), "end", 2, 2)]

    def __post_init__(self) -> None:
        require_declared(self, "valid")
        for key, ends in (("valid.s_m", self.s_m), ("valid.v_m_s", self.v_m_s)):
            require_rising(ends, key)
            # Shorter ranges mean nothing on a track, and ratios of lengths stay finite.
            if not np.float32(ends[1]) - np.float32(ends[0]) >= SHORTEST_RANGE:
                raise InvalidTable(f"{key} is {ends!r}, but its ends must be at least {SHORTEST_RANGE:g} apart.")


@dataclass(frozen=True)
class Predicted:
    """What the solver expects of this table.

    Examples
    --------
    >>> from tuning_tables import Predicted
    >>> Predicted(
    ...     rms_m_s=0.025, bias_m_s=0.001, p_overspeed=0.0, switchings=7.1
    ... ).passes is None  # not sampled
    True
    """

    rms_m_s: Annotated[float, Number("error of the exit speed, root of its mean square", 0.0)]
    bias_m_s: Annotated[float, Number("mean error of the exit speed")]
    p_overspeed: Annotated[float, Number("probability of more than the target + 0.3 m/s", 0.0, 1.0)]
    switchings: Annotated[float, Number("changes of stage in a pass", 0.0)]
    p_stall: Annotated[
        float | None, Number("probability that the cut comes to a stand in the retarder; null: not computed", 0.0, 1.0)
    ] = None
    passes: Annotated[int | None, Count("simulated passes that the figures come from; null: exact", 1)] = None

    def __post_init__(self) -> None:
        require_declared(self, "predicted")


@dataclass(frozen=True)
class Validated:
    """What a closed loop confirmed; null before it was run.

    Examples
    --------
    >>> from tuning_tables import Validated
    >>> Validated(passes=20_000, rms_m_s=0.025, rms_ci95_m_s=(0.0247, 0.0253)).rms_m_s
    0.025
    """

    passes: Annotated[int, Count("simulated passes", 1)]
    rms_m_s: Annotated[float, Number("error of the exit speed, root of its mean square", 0.0)]
    rms_ci95_m_s: Annotated[tuple[float, float], Row(Number("95 % interval of it", 0.0), "end", 2, 2)]

    def __post_init__(self) -> None:
        require_declared(self, "validated")
        if self.rms_ci95_m_s[0] > self.rms_ci95_m_s[1]:
            raise InvalidTable(
                f"validated.rms_ci95_m_s is {self.rms_ci95_m_s!r}, but its first end must not exceed its second."
            )


def rms_in_words(predicted: Predicted, validated: Validated | None) -> str:
    """The figure that a table is judged by: as simulated, else as predicted."""
    if validated is None:
        return f"predicted rms {predicted.rms_m_s:.4f} m/s"
    low, high = validated.rms_ci95_m_s
    return f"rms {validated.rms_m_s:.4f} [{low:.4f}, {high:.4f}] m/s in {validated.passes} passes"
