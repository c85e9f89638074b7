"""Which trains are worth a look in several runs at once: where catch-ups differ most, this way and that."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from plant_models.frozen_arrays import Ints
from synth.hump.comparison.compared_runs import HumpedRun
from synth.hump.trains.chosen_trains import TYPICAL_AMONG, ChosenTrain

MOST_CUTS: Final = 400
"""Cuts of all runs and trains on one page; each takes 7 kB."""


def compared_trains(runs: Sequence[HumpedRun]) -> tuple[ChosenTrain, ...]:
    """The train with the largest difference in catch-ups first; then the one with the largest the other way, where
    there is one, a usual one, and the first. Each train once, and no more than a page can hold.

    The largest is that between the first run and any other; of equal ones the most over-speeds in all runs, then the
    first train. A usual one, of the first few: as many catch-ups in the first run, and as large a difference, as in the
    median.
    """
    caught = np.stack([run.found.caught for run in runs])
    over = np.stack([run.found.overspeed.sum(axis=1) for run in runs]).sum(axis=0)
    more = caught[1:] - caught[0]
    distance = np.abs(more).max(axis=0)
    largest = first_of_largest(distance, over)
    run = int(np.abs(more[:, largest]).argmax())
    other_way = (-np.sign(more[run, largest]) * more).max(axis=0)
    opposite = first_of_largest(other_way, over)
    unusual = sum(np.abs(each - np.median(each)) for each in (caught[0], *more))
    why = {largest: "largest difference in catch-ups" if distance[largest] else "all alike in catch-ups"}
    if other_way[opposite] > 0:
        why[opposite] = "largest difference the other way"
    why.setdefault(int(np.argmin(unusual[:TYPICAL_AMONG])), "usual")
    why.setdefault(0, "the first")
    room = MOST_CUTS // (len(runs) * int(runs[0].found.cuts.max()))
    chosen = list(why.items())[: max(room, 1)]
    return tuple(ChosenTrain(number, f"{said}, {counts_of(runs, number)}") for number, said in chosen)


def first_of_largest(differences: Ints, overspeeds: Ints) -> int:
    """The train with the largest difference; of equal ones the most over-speeds, then the first."""
    return int(np.lexsort((np.arange(len(differences)), -overspeeds, -differences))[0])


def counts_of(runs: Sequence[HumpedRun], number: int) -> str:
    """'4 in today, 1 in new' of a train."""
    return ", ".join(f"{run.found.caught[number]} in {run.name}" for run in runs)
