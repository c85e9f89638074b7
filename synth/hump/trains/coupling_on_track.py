"""Cuts that come up with the one ahead while it still rolls on its track: where, when, and how fast both are."""

from __future__ import annotations

import numpy as np

from plant_models.frozen_arrays import Floats, frozen_arrays
from synth.hump.trains.motion import Cars, Moving

PLACES = 48
"""Places on the track where both are compared, and once more about the one where they first touch, or come closest."""


@frozen_arrays
class OnTrack:
    """n cuts on their last free rolls, (n,) each: `cars` from `start` to the places `end_m` of their heads, where they
    stand from `still_s` on."""

    cars: Cars
    start: Moving
    end_m: Floats
    still_s: Floats


@frozen_arrays
class Contact:
    """Where the head of each of n cuts behind touches the tail ahead, when, and how fast both are then; (n,) each, NaN
    where they do not touch while that ahead rolls."""

    head_m: Floats
    time_s: Floats
    ahead_m_s: Floats
    behind_m_s: Floats

    @property
    def closing_m_s(self) -> Floats:
        """How much faster the cut behind is."""
        return np.maximum(self.behind_m_s - self.ahead_m_s, 0.0)


def contact_on_track(ahead: OnTrack, behind: OnTrack, length_m: Floats) -> Contact:
    """Where cuts `behind` touch those `ahead`, whose `length_m` (n,) is given. Both roll as if alone up to there."""
    from_m = np.maximum(behind.start.head_m, ahead.start.head_m - length_m)
    to_m = np.maximum(ahead.end_m - length_m, from_m)
    rows = np.arange(len(from_m))
    steps = np.linspace(0.0, 1.0, PLACES)
    places = from_m[:, None] + (to_m - from_m)[:, None] * steps
    later_s = compared(ahead, behind, places, length_m)[0]
    touches = (later_s < 0.0).any(axis=1)
    at = np.where(touches, (later_s < 0.0).argmax(axis=1), later_s.argmin(axis=1))
    begins, ends = places[rows, np.maximum(at - 1, 0)], places[rows, np.minimum(at + 1, PLACES - 1)]
    fine = begins[:, None] + (ends - begins)[:, None] * steps
    later_s, first, second = compared(ahead, behind, fine, length_m)
    late = later_s < 0.0
    at, none = (rows, late.argmax(axis=1)), ~late.any(axis=1)
    time = np.where(np.isfinite(first[0][at]), first[0][at], second[0][at])
    return Contact(*(np.where(none, np.nan, each) for each in (fine[at], time, first[1][at], second[1][at])))


Rolled = tuple[Floats, Floats]


def compared(ahead: OnTrack, behind: OnTrack, places_m: Floats, length_m: Floats) -> tuple[Floats, Rolled, Rolled]:
    """How much later the heads of the cuts `behind` are at `places_m` (n, k) than the tails `ahead`, infinitely where
    these stand already; and both, as `rolled` tells them."""
    first, second = rolled(ahead, places_m + length_m[:, None]), rolled(behind, places_m)
    with np.errstate(invalid="ignore"):  # neither comes: ∞ − ∞
        return np.where(second[0] < ahead.still_s[:, None], second[0] - first[0], np.inf), first, second


def rolled(cuts: OnTrack, heads_m: Floats) -> Rolled:
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
