"""All studies, in the order of their names. Listing them imports none of them."""

from __future__ import annotations

from plant_models.library.near_miss import near_miss
from synth.faults.input_error import InputError
from synth.studies.study import Study

STUDIES: tuple[Study, ...] = (
    Study(
        "interpolation",
        "What is lost by lines between two tables of a book, against a table tuned for the very speed commanded?",
        6.0,
        "controllers.md",
        "synth.studies.interpolation",
    ),
)


def study_named(name: str) -> Study:
    """The study called `name`. Raises `InputError` with a hint for another word."""
    known = {study.name: study for study in STUDIES}
    if name not in known:
        raise InputError(f"study: there is no study {name!r}; {near_miss(name, known)} ('study --list' tells all)")
    return known[name]
