"""Reading declared settings: TOML → the model, every fault as one sentence about the file."""

from __future__ import annotations

from pydantic import ValidationError

from synth.frame.input_error import InputError
from synth.frame.settings.changed import S
from synth.frame.settings.file_fault import faults_in
from synth.frame.settings.toml_file import Tree, toml_tree

BUILT_IN = "built-in configuration"


def parse_settings(model: type[S], text: str, place: str) -> S:
    """The settings that `text` holds; `InputError`."""
    return settings_in(model, toml_tree(text, place), place)


def settings_in(model: type[S], tree: Tree, place: str) -> S:
    """The settings in `tree`; `InputError` with a sentence for each fault, which begins with `place`."""
    try:
        return model.model_validate(tree)
    except ValidationError as error:
        raise InputError(*(f"{place}: {sentence}" for sentence in faults_in(error, model))) from None
