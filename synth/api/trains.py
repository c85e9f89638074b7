"""Trains over a whole hump."""

from __future__ import annotations

from pathlib import Path

from synth.api.as_a_command import as_a_command
from synth.frame.faults import InputError
from synth.hump.configuration.trial_file import read_trial_file
from synth.hump.rolling.outcomes import joined
from synth.hump.trains.humped_trial import HumpedTrial
from synth.hump.trial.made_trial import made_trial
from synth.hump.trial.resolved_trial import ResolvedTrial, resolve_trial
from synth.hump.trial.trial import BATCH


def load_trial(source: Path | str | None = None, seed: int | None = None) -> ResolvedTrial:
    """Read the configuration of a hump trial, or a hump, on which the default trial is run.

    Parameters
    ----------
    source
        A configuration (`retarder-synth init trial` writes one), a hump file, the name of a hump of the library, or
        None for the default trial.
    seed
        Which trains, in place of the seed of the configuration.

    Returns
    -------
    ResolvedTrial
        The trial with every default filled in: `hump`, `routes`, `positions`, `trains`, `settings`, `sha256`.

    Raises
    ------
    InputError
        A sentence for each fault of the file, or a negative seed.

    Examples
    --------
    >>> import synth
    >>> trial = synth.load_trial("medium")
    >>> len(trial.routes.tracks), len(trial.positions)
    (16, 3)
    """
    if seed is not None and seed < 0:
        raise InputError(f"seed is {seed}; it must not be negative")
    return resolve_trial(read_trial_file(None if source is None else Path(source)).with_trains(None, seed, None))


@as_a_command
def hump_trains(trial: ResolvedTrial, trains: int = 100) -> HumpedTrial:
    """Let trains roll over a hump.

    Parameters
    ----------
    trial
        What `load_trial` read.
    trains
        How many, 1 or more: trains 0 … `trains` − 1 of the seed of the trial.

    Returns
    -------
    HumpedTrial
        `figures`: catch-ups, couplings, cars an hour and others, each with unit, n and 95 % interval; `found`: what
        each train came to, arrays whose first axis is the train.

    Raises
    ------
    InputError
        No train, or tables that a position names and that do not fit it.
    TableError
        A file of tables is damaged.

    Examples
    --------
    >>> import synth
    >>> humped = synth.hump_trains(synth.load_trial("dumper"), trains=2)
    >>> [figure.name for figure in humped.figures][:3]
    ['hump_speed', 'cars_per_hour', 'catch_ups']
    """
    if trains < 1:
        raise InputError(f"trains is {trains}; one is needed at least")
    made = made_trial(trial)
    batches = [made.batch(first, min(BATCH, trains - first)) for first in range(0, trains, BATCH)]
    return HumpedTrial(trial, made, joined(batches))
