"""Cuts that come up with the one ahead while it still rolls on its track: where, and how much faster they are."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from synth.yard.humping.motion import Cars, Moving

Floats = NDArray[np.float64]

PLACES = 48
"""Places on the track where both are compared; between two of them the rest of the way is linear in time."""


@frozen_arrays
@dataclass(frozen=True, eq=False)
class OnTrack:
    """n cuts on their last free rolls, (n,) each: `cars` from `start` to the places `end_m` of their heads."""

    cars: Cars
    start: Moving
    end_m: Floats


def closing_speed_m_s(ahead: OnTrack, behind: OnTrack, length_m: Floats) -> Floats:
    """How much faster the cuts `behind` are than those `ahead`, whose `length_m` (n,) is given, when they touch them:
    (n,), NaN where they do not while these roll.

    Both roll as if alone up to there; a cut that is pushed by one behind it is not followed further.
    """
    from_m = np.maximum(behind.start.head_m, ahead.start.head_m - length_m)
    to_m = np.maximum(ahead.end_m - length_m, from_m)
    places = from_m[:, None] + (to_m - from_m)[:, None] * np.linspace(0.0, 1.0, PLACES)
    first = rolled(ahead, places + length_m[:, None])
    second = rolled(behind, places)
    late = second[0] < first[0]
    touches = late.any(axis=1)
    at, rows = late.argmax(axis=1), np.arange(len(late))
    faster = second[1][rows, at] - first[1][rows, at]
    return np.where(touches, np.maximum(faster, 0.0), np.nan)


def rolled(cuts: OnTrack, heads_m: Floats) -> tuple[Floats, Floats]:
    """(times, speeds) of `cuts` when their heads pass `heads_m` (n, k); infinite and 0 behind a stop."""
    found = cuts.cars.rolls.roll_on(
        cuts.cars.rows,
        cuts.cars.routes,
        cuts.start.head_m,
        cuts.start.speed_m_s,
        np.maximum.accumulate(heads_m, axis=1),
    )
    here = heads_m <= cuts.start.head_m[:, None] + 1e-9
    return (
        np.where(here, cuts.start.time_s[:, None], cuts.start.time_s[:, None] + found.time_s),
        np.where(here, cuts.start.speed_m_s[:, None], found.speed_m_s),
    )
