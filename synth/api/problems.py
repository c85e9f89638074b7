"""Where a design begins: a configuration, and one problem of it."""

from __future__ import annotations

import hashlib
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

from plant_models.errors import near_miss
from synth.frame.faults import InputError
from synth.problem.problem import Aim, Problem
from synth.problem.resolution import Resolution
from synth.retarder.configuration.config_file import load_config as load_config_file
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.configuration.settings import GridSettings
from tuning_tables.json_text import canonical_json

Config = ResolvedConfig | Path | str | None
"""A configuration, the file that it is in, or None for the built-in one."""


def load_config(path: Path | str | None = None) -> ResolvedConfig:
    """Read a configuration, as `retarder-synth init` prints one.

    Parameters
    ----------
    path
        A TOML file, or None for the built-in configuration.

    Returns
    -------
    ResolvedConfig
        The configuration with every default filled in. `plants()` gives (label, plant) of each cut class;
        `resolution`, `criterion`, `fit`, `validation` are what a design is made with; `sha256` is its hash.

    Raises
    ------
    InputError
        A sentence for each fault of the file.

    Examples
    --------
    >>> import synth
    >>> config = synth.load_config()
    >>> [label for label, plant in config.plants()]
    ['gondola-4-22t', 'gondola-4-36t', 'gondola-4-52t', 'gondola-4-66t', 'gondola-4-85t']
    >>> config.fit.degree
    3
    """
    return load_config_file(None if path is None else Path(path))


def load_problem(cut: str, target_m_s: float, config: Config = None) -> Problem:
    """Take one cut class of a configuration, to be let go at one exit speed.

    Parameters
    ----------
    cut
        The label of the cut class.
    target_m_s
        The commanded exit speed, m/s. It need not be a target of the configuration.
    config
        A configuration, its file, or None for the built-in one. The criterion is the one in it.

    Returns
    -------
    Problem
        The plant of the class, and its aim.

    Raises
    ------
    InputError
        There is no such class, or the file is at fault.
    PlantError
        The target is not below the highest entry speed, or out of range.

    Examples
    --------
    >>> import synth
    >>> problem = synth.load_problem("gondola-4-52t", target_m_s=3.0)
    >>> problem
    Problem(knp-5-bunch, 52 t on 4 axles, entry 5 to 6.5 m/s, to 3 m/s)
    >>> synth.load_problem("gondola-4-52", 3.0)
    Traceback (most recent call last):
    ...
    synth.frame.faults.InputError: the configuration has no cut class 'gondola-4-52'; did you mean gondola-4-52t?
    """
    known = resolved(config)
    plants = dict(known.plants())
    if cut not in plants:
        raise InputError(f"the configuration has no cut class {cut!r}; {near_miss(cut, plants)}")
    return Problem(plants[cut], Aim(target_m_s, known.criterion))


def resolved(config: Config) -> ResolvedConfig:
    """The configuration itself, read where only its file is given."""
    return config if isinstance(config, ResolvedConfig) else load_config(config)


def usual_resolution(problem: Problem) -> Resolution:
    """The grid of the built-in configuration, with the transients of this sensor's sampling period."""
    return GridSettings().resolution_for(problem.plant)


def problem_sha256(problem: Problem) -> str:
    """SHA-256 of the canonical form of everything that `problem` consists of."""
    return hashlib.sha256(canonical_json(tree_of(problem))).hexdigest()


def tree_of(value: Any) -> Any:
    """A value of values as dictionaries and lists, with the names of the types."""
    if is_dataclass(value):
        parts = {field.name: tree_of(getattr(value, field.name)) for field in fields(value)}
        return {"type": type(value).__name__, **parts}
    if isinstance(value, tuple | np.ndarray):
        return [tree_of(part) for part in value]
    return value.item() if isinstance(value, np.generic) else value
