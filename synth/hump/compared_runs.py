"""Runs as they lie in their directories, whether they humped the same trains, and which of these are worth a look in
all runs at once: where catch-ups differ most, this way and that.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

from plant_models.frozen_arrays import Ints
from synth.frame.faults import InputError
from synth.frame.results_directory import SUMMARY
from synth.hump.configuration.trial_file import INPUTS
from synth.hump.rolling.outcomes import TrainOutcomes, some_of
from synth.hump.trains.outcome_file import TRAINS, stored_trains
from synth.hump.trains.traced_train import TYPICAL_AMONG, ChosenTrain
from synth.hump.trial.asked_trial import CONFIG
from synth.hump.trial.resolved_trial import ResolvedTrial


@dataclass(frozen=True)
class HumpedRun:
    """A whole run: `name` tells it from the others; `found`: its trains."""

    name: str
    config: ResolvedTrial
    found: TrainOutcomes


Runs = tuple[HumpedRun, ...]
"""The first is what the others are compared with."""


def runs_in(folders: Sequence[Path]) -> Runs:
    """The runs in these directories, all with the same trains. `InputError`, `TableError` for a damaged file."""
    names = names_of(folders)
    runs = [run_in(folder, name) for folder, name in zip(folders, names, strict=True)]
    count = min(len(run.found) for run in runs)
    common = [replace(run, found=some_of(run.found, np.arange(count))) for run in runs]
    for run in common[1:]:
        require_same_trains(common[0], run)
    return tuple(common)


def names_of(folders: Sequence[Path]) -> list[str]:
    """The names of the directories; their paths where two have one name. `InputError` for one that is given twice."""
    resolved = [folder.resolve() for folder in folders]
    for place, folder in enumerate(resolved):
        if folder in resolved[:place]:
            raise InputError(f"{folders[place]} is given twice; give each run once")
    names = [folder.name for folder in resolved]
    return names if len(set(names)) == len(names) else [str(folder) for folder in folders]


def config_in(folder: Path) -> Path:
    """The configuration that a run left in its directory. `InputError` where there is no whole run."""
    config = folder / INPUTS / CONFIG
    for needed in (config, folder / TRAINS, folder / SUMMARY):
        if not needed.is_file():
            raise InputError(
                f"{folder}: there is no {needed.relative_to(folder)}; give a directory in which 'hump simulate' has "
                "come to its end"
            )
    return config


def run_in(folder: Path, name: str) -> HumpedRun:
    """The run in one directory."""
    config_in(folder)
    stored = stored_trains(folder, str(folder))
    return HumpedRun(name, stored.config, stored.found)


def require_same_trains(one: HumpedRun, other: HumpedRun) -> None:
    """`InputError` unless train by train both have as many cuts and cars, and both judge couplings alike."""
    ours, theirs = (run.config.settings.couplings.classes_m_s for run in (one, other))
    if ours != theirs:
        raise InputError(
            f"{other.name} judges couplings by {words(theirs)} m/s, and {one.name} by {words(ours)}; give both the "
            "same [couplings]"
        )
    for what in ("cuts", "cars"):
        ours, theirs = getattr(one.found, what), getattr(other.found, what)
        differ = np.flatnonzero(ours != theirs)
        if len(differ):
            train = int(differ[0])
            raise InputError(
                f"{other.name} humped other trains than {one.name}: train {train + 1} has {theirs[train]} {what}, not "
                f"{ours[train]}; runs are compared on the same trains, so give both the same [trains] and seed"
            )


def words(speeds_m_s: Sequence[float]) -> str:
    """'1.39, 1.5, 2'."""
    return ", ".join(f"{speed:.3g}" for speed in speeds_m_s)


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
