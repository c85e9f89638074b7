"""Reading declared settings: TOML → the model, every fault as one sentence about the file."""

from __future__ import annotations

from typing import TypeVar

from pydantic import ValidationError

from synth.frame.input_error import InputError
from synth.frame.settings.file_fault import faults_in
from synth.frame.settings.section import Section
from synth.frame.settings.toml_file import toml_tree

S = TypeVar("S", bound=Section)

BUILT_IN = "built-in configuration"


def parse_settings(model: type[S], text: str, place: str) -> S:
    """The settings that `text` holds; `InputError`."""
    try:
        return model.model_validate(toml_tree(text, place))
    except ValidationError as error:
        raise InputError(*(f"{place}: {sentence}" for sentence in faults_in(error, model))) from None
