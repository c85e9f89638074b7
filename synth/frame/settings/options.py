"""What is typed behind a command as a declared model: flag, unit, range, meaning and default stand once; and words
for values that are at fault, in files and on command lines.

A word of the command line is checked as a key of a file is, and refused in the same kind of sentence.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any, Final, TypeVar

from pydantic import ConfigDict, Field, JsonValue, ValidationError
from pydantic.fields import FieldInfo

from synth.frame.settings.section import Section, extra_of, setting_limits

ALLOWED = {
    "float_type": "a number",
    "int_type": "a whole number",
    "string_type": "a string in quotes",
    "bool_type": "true or false",
    "finite_number": "a finite number",
    "model_type": "a table",
    "dict_type": "a table",
    "tuple_type": "a list",
    "string_pattern_mismatch": "made of at most 61 letters, digits, dots, hyphens and underscores",
}
"""What a value must be, by pydantic's error type."""


def shown(value: Any) -> str:
    """A value as the file writes it, cut off if long."""
    text = str(value).lower() if isinstance(value, bool) else repr(value)
    return text if len(text) <= 80 else text[:77] + "…"


BY_PLACE: Final = ""
"""The flag of files that have none: where they are typed says which they are, in the order of the fields."""

NEEDED: Final = ...
"""The default of what must be typed."""

Words = str | Path | bool | Sequence[str | Path] | None
"""What was typed of an option: a word, several where it takes them, None for nothing; whether a flag was."""


def number_option(flag: str, metavar: str, default: float | None, low: float, high: float, meaning: str) -> Any:
    """A number from `low` to `high`."""
    return Field(default, ge=low, le=high, description=meaning, json_schema_extra={"flag": flag, "metavar": metavar})


def configured(flag: str, metavar: str, section: type[Section], key: str, meaning: str) -> Any:
    """The number `key` of `section` of the file, which stays as configured unless it is given."""
    limits = setting_limits(section.model_fields[key])
    assert limits is not None, key
    said = f"{meaning}; as configured unless given."
    return Field(
        None, ge=limits[0], le=limits[1], description=said, json_schema_extra={"flag": flag, "metavar": metavar}
    )


def word_option(flag: str, metavar: str, default: object, meaning: str) -> Any:
    """Words, a path, or a list in words that a validator of the field reads."""
    return Field(default, description=meaning, json_schema_extra={"flag": flag, "metavar": metavar})


def flag_option(flag: str, meaning: str) -> Any:
    """Whether the flag is typed; no word follows it."""
    return Field(False, description=meaning, json_schema_extra={"flag": flag, "metavar": ""})


def words_option(flag: str, metavar: str, default: object, meaning: str) -> Any:
    """A tuple of any length: its flag is typed again for each word, and `BY_PLACE` they follow one another."""
    extra: dict[str, JsonValue] = {"flag": flag, "metavar": metavar, "several": True}
    return Field(default, description=meaning, json_schema_extra=extra)


class Options(Section):
    """What is typed behind a command, but for what is the same of all (`-o`, `--json`); values are read from words.

    A path among them is that of a file, or of a folder of files, that the command reads. `config`: the configuration;
    a command that begins with other files declares it anew, with a flag.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, strict=False, allow_inf_nan=False)

    config: Path | None = word_option(BY_PLACE, "CONFIG.toml", None, "Built-in unless given.")

    @property
    def reads(self) -> tuple[Path, ...]:
        """All paths that were typed."""
        values = (getattr(self, key) for key in type(self).model_fields)
        typed = (value if isinstance(value, tuple) else (value,) for value in values)
        return tuple(each for words in typed for each in words if isinstance(each, Path))


O = TypeVar("O", bound=Options)  # noqa: E741  # the options of a command


def flag_of(field: FieldInfo) -> str:
    """As it is typed, or `BY_PLACE`."""
    return extra_of(field, "flag")


def metavar_of(field: FieldInfo) -> str:
    """What stands for its value in the help."""
    return extra_of(field, "metavar")


def takes_several(field: FieldInfo) -> bool:
    """Whether it is a tuple of what was typed, one word each."""
    return extra_of(field, "several") != ""


def read_options(model: type[O], words: Mapping[str, Words]) -> O:
    """The options from the words that were typed, by the keys of the model. `InputError`."""
    from synth.frame.faults import InputError

    typed = {key: word for key, word in words.items() if word is not None and word != []}
    try:
        return model.model_validate(typed)
    except ValidationError as error:
        raise InputError(*refusals(error, model)) from None


def refusals(error: ValidationError, model: type[Options]) -> Iterator[str]:
    """A sentence for each option at fault."""
    for fault in error.errors(include_url=False):
        field = model.model_fields[str(fault["loc"][0])]
        yield f"{flag_of(field) or metavar_of(field)} is {shown(fault['input'])}; it must be {allowed_of(field, fault)}"


def allowed_of(field: FieldInfo, fault: Mapping[str, Any]) -> str:
    """What the value of an option must be."""
    if fault["type"] == "value_error":
        return str(fault["ctx"]["error"])
    limits = setting_limits(field)
    if limits is None:
        return ALLOWED.get(fault["type"], str(fault["msg"]))
    number = "a number" if field.annotation in (float, float | None) else "a whole number"
    return f"{number} from {limits[0]:.15g} to {limits[1]:.15g}"
