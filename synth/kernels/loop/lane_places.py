"""Where passes that run side by side keep their state (for `closed_loop`)."""

from __future__ import annotations

from typing import NamedTuple

from plant_models.frozen_arrays import Floats, Ints

LANES = 64
"""Passes side by side: enough to hide what one waits for. They move in packs of eight."""

PLACES = LANES + 8
"""Numbers of a field; nobody is in the places after the lanes, which fill up the last pack of a list of lanes."""

# A lane without a pass has no speed: NaN, which fails every comparison, so that it neither moves nor waits.
FLOATS, INTS = 7, 8
S, V, LEFT_S, DRAG, FIRST_S, SLOPE, BEFORE = range(0, FLOATS * PLACES, PLACES)
CELL, ROW, PIECE, SAMPLE, STAGE, SWITCHINGS, PASS, NUMBER = range(0, INTS * PLACES, PLACES)


class Work(NamedTuple):
    """Memory of the lanes: `floats` (FLOATS · PLACES,) and `ints` (INTS · PLACES,); lists of lanes, (PLACES,) each.

    `read` (PLACES,): speed that each of the lanes of `waiting` has measured or estimated; `heard` (PLACES,): speed that
    the regulator compares in each of the lanes of `told`.
    """

    floats: Floats
    ints: Ints
    waiting: Ints
    read: Floats
    ended: Ints
    told: Ints
    heard: Floats
