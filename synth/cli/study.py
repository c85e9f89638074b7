"""`retarder-synth study`: asks the laboratory, which is no part of the product and comes with a checkout alone."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from pathlib import Path
from types import ModuleType

from synth.frame.faults import InputError
from synth.frame.terminal.manner import Manner

LABORATORY = "scripts.studies.command"


@dataclass(frozen=True)
class Wanted:
    """The switches of the command: where results go, and what else is asked for."""

    output: Path
    show_list: bool
    small: bool
    document: bool
    check: bool
    manner: Manner


def study_command(name: str | None, words: list[str], wanted: Wanted, general_help: Callable[[], str]) -> int:
    """Run the study `name` with the options in `words`, or tell what is asked; the exit code.

    Raises `InputError` where no checkout is installed.
    """
    code: int = laboratory().study_command(name, words, wanted, general_help)
    return code


def laboratory() -> ModuleType:
    """The module behind the command; named as text, for no import of ours may need it. Raises `InputError`."""
    try:
        return import_module(LABORATORY)
    except ModuleNotFoundError as fault:
        if not f"{LABORATORY}.".startswith(f"{fault.name}."):
            raise
        raise InputError(
            "study: studies come with a checkout of the source, not with the installed package; run 'scripts/setup' in "
            "a checkout, then its '.venv/bin/retarder-synth study'"
        ) from None
