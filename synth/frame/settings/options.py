"""Options of a command line as a declared model: flag, unit, range, meaning and default stand once.

A word of the command line is checked as a key of a file is, and refused in the same kind of sentence.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any, TypeVar

from pydantic import ConfigDict, Field, ValidationError
from pydantic.fields import FieldInfo

from synth.frame.settings.fault_words import ALLOWED, shown
from synth.frame.settings.section import Section, extra_of, setting_limits


class Options(Section):
    """The options of a command beside those of every command; values are read from words."""

    model_config = ConfigDict(extra="forbid", frozen=True, strict=False, allow_inf_nan=False)


O = TypeVar("O", bound=Options)  # noqa: E741  # the options of a command


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


def flag_of(field: FieldInfo) -> str:
    """As it is typed."""
    return extra_of(field, "flag")


def metavar_of(field: FieldInfo) -> str:
    """What stands for its value in the help."""
    return extra_of(field, "metavar")


def read_options(model: type[O], words: Mapping[str, str | None]) -> O:
    """The options from the words that were typed, by the keys of the model; None: not typed. `InputError`."""
    from synth.frame.input_error import InputError

    typed = {key: word for key, word in words.items() if word is not None}
    try:
        return model.model_validate(typed)
    except ValidationError as error:
        raise InputError(*refusals(error, model)) from None


def refusals(error: ValidationError, model: type[Options]) -> Iterator[str]:
    """A sentence for each option at fault."""
    for fault in error.errors(include_url=False):
        field = model.model_fields[str(fault["loc"][0])]
        yield f"{flag_of(field)} is {shown(fault['input'])}; it must be {allowed_of(field, fault)}"


def allowed_of(field: FieldInfo, fault: Mapping[str, Any]) -> str:
    """What the value of an option must be."""
    if fault["type"] == "value_error":
        return str(fault["ctx"]["error"])
    limits = setting_limits(field)
    if limits is None:
        return ALLOWED.get(fault["type"], str(fault["msg"]))
    number = "a number" if field.annotation in (float, float | None) else "a whole number"
    return f"{number} from {limits[0]:.15g} to {limits[1]:.15g}"
