"""Runs as they lie in their directories, and whether they humped the same trains."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from synth.frame.input_error import InputError
from synth.frame.results_directory import SUMMARY
from synth.hump.configuration.trial_file import INPUTS
from synth.hump.trains.outcome_file import TRAINS
from synth.hump.trains.outcomes import TrainOutcomes, some_of
from synth.hump.trains.resolved_trial import ResolvedTrial
from synth.hump.trains.stored_trains import stored_trains
from synth.hump.trains.trial_inputs import CONFIG


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
