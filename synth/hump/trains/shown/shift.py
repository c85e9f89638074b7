"""How tracks fill in a shift, and what that changes: a row for each place of a train in its shift."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, Final

import numpy as np

from synth.frame.exhibits import Column, Exhibit, Row, Sentence, Table
from synth.hump.trains.humped_trial import HumpedTrial
from synth.hump.trains.outcomes import TrainOutcomes, some_of
from synth.hump.trains.shift_sums import shifts_in
from synth.hump.trains.shown.figures import in_hundred
from synth.hump.trains.train_figures import figures_told

MOST_ROWS: Final = 12
"""Rows of the table; the trains of longer shifts are told together, as many in each row."""

COLUMNS: Final = (
    Column("trains", "trains of the shift", words=True),
    Column("occupied_share", "tracks taken before", "%", in_hundred),
    Column("pushed_up_per_train", "pushed up before"),
    Column("pulled_per_train", "pulled before"),
    Column("no_room", "cuts without room", "%", in_hundred),
    Column("stopped_on_the_way", "stopped on the way", "%", in_hundred),
    Column("contacts_in_last_position", "in contact in the last position", "%", in_hundred),
    Column("overspeed", "over-speeds", "%", in_hundred),
    Column("gap_per_cut", "gap a cut", "m"),
)


def shift(result: HumpedTrial) -> Iterator[Exhibit]:
    """The table, and by which rule tracks are pushed up and pulled."""
    found, share = result.found, result.trial.tracks.pulled_from_share
    yield Table("shift", "The trains of a shift", COLUMNS, list(rows(found)))
    yield Sentence(
        f"{shifts_in(found)} shifts are independent; their first trains find tracks as drawn. Between two trains a "
        f"track whose cars take {100.0 * share:.3g} % of its length is pulled, all its cars at once. One without room "
        "for the cars of the next train is pushed up, so that no gap is left between its cars; where that is not "
        "enough, it is pulled, too. Taken: by cars, and by gaps between them. Without room: less of the track was free "
        "than the cut is long. Brackets: 95 % intervals of whole shifts."
    )


def rows(found: TrainOutcomes) -> Iterator[Row]:
    """From the first train of a shift to the last."""
    begins = np.flatnonzero(np.diff(found.shift, prepend=found.shift[:1] - 1))
    place = np.arange(len(found)) - np.repeat(begins, np.diff(np.append(begins, len(found))))
    for places in np.array_split(np.arange(place.max() + 1), min(MOST_ROWS, place.max() + 1)):
        first, last = int(places[0]) + 1, int(places[-1]) + 1
        told: dict[str, Any] = {"trains": f"{first}" if first == last else f"{first} to {last}"}
        chosen = some_of(found, np.flatnonzero(np.isin(place, places)))
        shown = {column.key for column in COLUMNS}
        yield told | {each.name: each.figure(chosen).told for each in figures_told(found) if each.name in shown}
