"""A study by its name, as the user writes it."""

from __future__ import annotations

from plant_models.library.near_miss import near_miss
from scripts.studies.registry import STUDIES
from scripts.studies.study import Study
from synth.frame.input_error import InputError


def study_named(name: str) -> Study:
    """The study called `name`. Raises `InputError` with a hint for another word."""
    known = {study.name: study for study in STUDIES}
    if name not in known:
        raise InputError(f"study: there is no study {name!r}; {near_miss(name, known)} ('study --list' tells all)")
    return known[name]
