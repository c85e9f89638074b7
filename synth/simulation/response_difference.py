"""How far two computations of one pass are apart: python-control's response and the simulator's trace."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from synth.simulation.nominal_response import NominalResponse
from synth.simulation.passes import PassTrace

SAME_SAMPLE_S = 1e-6
"""Commands nearer to each other than this belong to one sample."""

SAME_PASSAGE_S = 1e-3
"""And to one passage: the time of a passage depends on the motion before it, that of a sample does not."""


@dataclass(frozen=True)
class ResponseDifference:
    """Response less trace, m/s: the largest in size of the whole pass, or of its part before `parted_s`.

    `parted_s`: the first sample at which the two command different stages, None where there is none. A regulator is a
    relay: where the speed of a sample lies on a line, rounding decides, and from then on these are two passes.
    """

    largest_m_s: float
    exit_m_s: float
    parted_s: float | None


def response_difference(
    response: NominalResponse, trace: PassTrace, same_s: float = SAME_SAMPLE_S
) -> ResponseDifference:
    """`response` less `trace`, at the events of the trace; commands nearer to each other than `same_s` are one."""
    parted = parting(response.commands, commands_of(trace), same_s)
    time = trace.time_s
    counted = time <= min(float(response.time_s[-1]), math.inf if parted is None else parted)
    if response.stalled and trace.stalled:
        counted &= time < time[-1]  # at rest both are 0, but a response ends at one of its points shortly after
    speed = np.interp(time[counted], response.time_s, response.speed_m_s)
    apart = speed - trace.speed_m_s[counted]
    largest = float(apart[np.argmax(np.abs(apart))])
    return ResponseDifference(largest, response.exit_speed_m_s - trace.exit_speed_m_s, parted)


def commands_of(trace: PassTrace) -> tuple[tuple[float, int], ...]:
    """(time of the sample in s, stage commanded) of every change of stage."""
    changed = np.flatnonzero(np.diff(trace.stage)) + 1
    return tuple((float(trace.time_s[i]), int(trace.stage[i])) for i in changed)


def parting(
    one: tuple[tuple[float, int], ...], other: tuple[tuple[float, int], ...], same_s: float = SAME_SAMPLE_S
) -> float | None:
    """Time of the first command that is not in both; None if all are."""
    for (time, stage), (later, wanted) in zip(one, other, strict=False):
        if stage != wanted or abs(time - later) > same_s:
            return min(time, later)
    rest = one[len(other) :] or other[len(one) :]
    return rest[0][0] if rest else None
