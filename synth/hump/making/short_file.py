"""Reading a short hump file: every fault at once, those of its keys and those between them; and one to start from."""

from __future__ import annotations

from typing import Final

from pydantic import ValidationError

from plant_models.library.near_miss import close_name
from synth.frame.input_error import InputError
from synth.frame.settings.file_fault import faults_in
from synth.frame.settings.template import NOTHING, template
from synth.frame.settings.toml_file import read_toml
from synth.hump.file_kind import FileKind, require_kind
from synth.hump.making.short_hump import EXAMPLE, ShortHump
from synth.hump.making.short_rules import RULES

KEYS: Final = tuple(ShortHump.model_fields)


def read_short_hump(text: str, place: str) -> ShortHump:
    """The short hump that `text` describes; `place` is what messages call the file. `InputError`."""
    read = read_toml(text, place)
    tree = read.tree
    if tree is None:
        raise InputError(*read.faults)
    require_kind(tree, place, FileKind.SHORT)
    wrong: set[str] = set()
    told: list[str] = []
    try:
        short = ShortHump.model_validate(tree)
    except ValidationError as error:
        told += faults_in(error, ShortHump)
        wrong = {str(fault["loc"][0]) for fault in error.errors(include_url=False)}
        meant = {name for key in wrong - set(KEYS) if (name := close_name(key, KEYS)) is not None}
        sound = {key: value for key, value in tree.items() if key not in wrong}
        wrong |= meant
        short = ShortHump.model_validate({**{key: getattr(EXAMPLE, key) for key in NEEDED}, **sound})
    told += [sentence for rule in RULES if not rule.keys & wrong for sentence in rule.check(short)]
    if read.faults or told:
        raise InputError(*read.faults, *(f"{place}: {sentence}" for sentence in told))
    return short


NEEDED: Final = tuple(key for key, field in ShortHump.model_fields.items() if field.is_required())
"""Keys that stand in every short file."""

EXAMPLE_LINES = (
    "An example: put the numbers of your hump in place of its own.\n"
    f"# What may not be left out: tracks or bunches, {', '.join(NEEDED)}; of a position type and from_m."
)


def example_short_toml() -> str:
    """The hump `medium` of the library as a short file."""
    return template(EXAMPLE, "Short hump file", "hump make", NOTHING, (), EXAMPLE_LINES)
