"""Which of three kinds a TOML file of the hump is: people give one to the command that reads another."""

from __future__ import annotations

from collections.abc import Mapping
from enum import Enum
from typing import Any

from plant_models.library.hump_entry import FORMAT
from synth.frame.input_error import InputError
from synth.hump.configuration.settings import HumpTrialSettings
from synth.hump.making.short_hump import ShortHump


class FileKind(Enum):
    """What messages call it."""

    HUMP = "hump file"
    TRIAL = "hump trial"
    SHORT = "short hump file"


READ_BY = {FileKind.HUMP: "check", FileKind.TRIAL: "simulate", FileKind.SHORT: "make"}
"""The command behind `hump` that reads each kind."""


def require_kind(tree: Mapping[str, Any], file: str, wanted: FileKind) -> None:
    """`InputError` where the tables `tree` of `file` are of another kind, which tells the command that reads it."""
    found = kind_of(tree)
    if found not in (None, wanted):
        raise InputError(
            f"{file}: this is a {found.value}, not a {wanted.value}; use 'retarder-synth hump {READ_BY[found]} {file}'"
        )


def kind_of(tree: Mapping[str, Any]) -> FileKind | None:
    """By the keys at the top; None where they tell nothing."""
    if tree.get("format") == FORMAT or isinstance(tree.get("hump"), dict):
        return FileKind.HUMP
    trial, short = set(HumpTrialSettings.model_fields), set(ShortHump.model_fields)
    if tree.keys() & (short - trial):
        return FileKind.SHORT
    return FileKind.TRIAL if tree.keys() & (trial - short) else None
