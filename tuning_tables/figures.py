"""The numbers that qualify a table: where it holds, what was predicted of it, what a closed-loop run confirmed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from tuning_tables.errors import InvalidTable
from tuning_tables.requirement import (
    require_between,
    require_count,
    require_finite,
    require_rising,
    require_tuple,
)

SHORTEST_RANGE: Final = 1e-3
"""Of path in m, of speed in m/s."""


@dataclass(frozen=True)
class ValidRange:
    """The rectangle of path (m) and speed (m/s) on which the lines were fitted; (smallest, largest) each, speed >= 0.

    The rule clamps the path into this range and does not look at the speed range (see `rule.decide`).
    """

    s_m: tuple[float, float]
    v_m_s: tuple[float, float]

    def __post_init__(self) -> None:
        for key, ends in (("valid.s_m", self.s_m), ("valid.v_m_s", self.v_m_s)):
            require_tuple(ends, key, 2)
            require_rising(ends, key)
            require_between(ends[0], key, -1e6, 1e6)
            require_between(ends[1], key, -1e6, 1e6)
            # Shorter ranges mean nothing on a track, and ratios of lengths stay finite.
            if not np.float32(ends[1]) - np.float32(ends[0]) >= SHORTEST_RANGE:
                raise InvalidTable(f"{key} is {ends!r}, but its ends must be at least {SHORTEST_RANGE:g} apart.")
        require_between(self.v_m_s[0], "valid.v_m_s[0]", 0.0)


@dataclass(frozen=True)
class Predicted:
    """Quality that the solver expects of this table; speeds in m/s, probabilities in [0, 1], switchings per pass.

    `p_stall`: probability that the cut comes to a stand in the retarder; None where it was not computed. `passes`:
    simulated passes that the figures come from, None where they were computed exactly.
    """

    rms_m_s: float
    bias_m_s: float
    p_overspeed: float
    switchings: float
    p_stall: float | None = None
    passes: int | None = None

    def __post_init__(self) -> None:
        require_between(self.rms_m_s, "predicted.rms_m_s", 0.0)
        require_finite(self.bias_m_s, "predicted.bias_m_s")
        require_between(self.p_overspeed, "predicted.p_overspeed", 0.0, 1.0)
        require_between(self.switchings, "predicted.switchings", 0.0)
        if self.p_stall is not None:
            require_between(self.p_stall, "predicted.p_stall", 0.0, 1.0)
        if self.passes is not None:
            require_count(self.passes, "predicted.passes", 1)


@dataclass(frozen=True)
class Validated:
    """Quality seen in a closed loop of `passes` (>= 1) simulated passes: rms and its 95 % interval, in m/s."""

    passes: int
    rms_m_s: float
    rms_ci95_m_s: tuple[float, float]

    def __post_init__(self) -> None:
        require_count(self.passes, "validated.passes", 1)
        require_between(self.rms_m_s, "validated.rms_m_s", 0.0)
        require_tuple(self.rms_ci95_m_s, "validated.rms_ci95_m_s", 2)
        for index, end in enumerate(self.rms_ci95_m_s):
            require_between(end, f"validated.rms_ci95_m_s[{index}]", 0.0)
        if self.rms_ci95_m_s[0] > self.rms_ci95_m_s[1]:
            raise InvalidTable(
                f"validated.rms_ci95_m_s is {self.rms_ci95_m_s!r}, but its first end must not exceed its second."
            )
