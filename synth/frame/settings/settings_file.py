"""Reading declared settings: TOML → the model, what pydantic finds at fault as one sentence each (key, value, what
is allowed); and settings with other values, checked as those of a file are.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from typing import Any, Final, TypeVar

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails

from plant_models.errors import PlantError, near_miss, require
from plant_models.library.hump_forms import words_for
from synth.frame.faults import InputError
from synth.frame.settings.options import ALLOWED, shown
from synth.frame.settings.section import (
    DIMENSIONLESS,
    Section,
    extra_of,
    length_limits,
    sections_in,
    setting_limits,
    setting_unit,
)
from synth.frame.settings.toml_file import Tree, toml_tree
from tuning_tables.errors import excerpt

Location = Sequence[str | int]

PER_CENT: Final = (2.5, 100.0)
"""Numbers that may be meant as per cent where a share is asked for."""

LONGEST_SENTENCE: Final = 400
"""Characters of what is said of a value, which the sentence may repeat."""


@contextmanager
def in_file(place: str) -> Iterator[None]:
    """Within, a `PlantError` becomes an `InputError` about the file that messages call `place`."""
    try:
        yield
    except PlantError as error:
        raise InputError(f"{place}: {excerpt(str(error), LONGEST_SENTENCE)}") from None


def faults_in(error: ValidationError, root: type[Section]) -> list[str]:
    """Every fault of a file that should be a `root` as a sentence; mistyped keys come before missing ones."""
    found = error.errors(include_url=False)
    own = [fault for fault in found if fault["type"] != "too_short" or not fault["input"]]  # else a sequel of another
    return [fault_sentence(fault, root) for fault in sorted(own, key=lambda fault: fault["type"] != "extra_forbidden")]


def fault_sentence(fault: ErrorDetails, root: type[Section]) -> str:
    """One pydantic error as 'key is value; what is allowed'."""
    location, kind, value = fault["loc"], fault["type"], fault["input"]
    key = key_path(location)
    if kind == "extra_forbidden":
        return f"{key} = {shown(value)} is an unknown key; {hint(location, root)}"
    if kind == "missing":
        return f"{key} is missing; add it to {key_path(location[:-1]) or 'the file'}"
    if kind == "value_error" and isinstance(value, dict | Section) and holds_section(location, root):
        # a rule between the keys of a table
        return rule_sentence(key, str(fault["ctx"]["error"]), section_at(location, root))
    return f"{key} is {shown(value)}; it must be {allowed(fault, root)}"


def rule_sentence(key: str, sentence: str, section: type[BaseModel]) -> str:
    """A sentence about the table at `key`; where it begins with one of its keys, that is told in full."""
    if not key:
        return sentence
    first = re.match(r"\w*", sentence)
    return f"{key}.{sentence}" if first and first[0] in section.model_fields else f"{key}: {sentence}"


def allowed(fault: ErrorDetails, root: type[Section]) -> str:
    """What the value at fault must be."""
    kind, context = fault["type"], fault.get("ctx", {})
    if kind in ("greater_than_equal", "less_than_equal"):
        limits = setting_limits(field_at(fault["loc"], root))
        return f"from {limits[0]:g} to {limits[1]:g}{share_words(fault, root)}" if limits else fault["msg"]
    if kind == "float_type" and words_for(fault["input"], setting_unit(field_at(fault["loc"], root))):
        return words_for(fault["input"], setting_unit(field_at(fault["loc"], root)))
    if kind == "value_error":
        return str(context["error"]).removeprefix("it must be ")
    if kind == "literal_error":
        return str(context["expected"])
    if kind in ("too_short", "too_long"):
        return allowed_length(field_at(fault["loc"], root), fault["input"])
    name = key_path(fault["loc"])
    if kind == "tuple_type" and "[" not in name and holds_section(fault["loc"], root):
        return f"a list of tables: write [[{name}]], not [{name}]"
    return ALLOWED.get(kind, fault["msg"])


def share_words(fault: ErrorDetails, root: type[Section]) -> str:
    """That a number is a share, where per cent may have been meant."""
    field, value = field_at(fault["loc"], root), fault["input"]
    limits = setting_limits(field)
    is_share = setting_unit(field) == DIMENSIONLESS and limits is not None and limits[0] >= 0.0 and limits[1] <= 1.0
    return (
        f"; this is a share: {value / 100.0:g} for {value:g} %"
        if is_share and PER_CENT[0] <= value <= PER_CENT[1]
        else ""
    )


def holds_section(location: Location, root: type[Section]) -> bool:
    """Whether a table is at `location`, or a list of tables."""
    names = [part for part in location if isinstance(part, str)]
    return not names or bool(sections_in(field_at(names, root)))


def allowed_length(field: FieldInfo, value: object) -> str:
    """How many entries a list or table must have."""
    low, high = length_limits(field)
    kind, number = "a table" if isinstance(value, dict) else "a list", f"{low} to {high}" if low else f"at most {high}"
    return f"{kind} of {number} {extra_of(field, 'entries')}"


def hint(location: Location, root: type[Section]) -> str:
    """Which key was meant: one of the section's, or the same name in another section, else all that the section has."""
    section, word = section_at(location[:-1], root), str(location[-1])
    if issubclass(section, Section) and word in section.MEANT:
        return f"did you mean {section.MEANT[word]}?"
    elsewhere = [key for key in dotted_keys(root, "") if key.split(".")[-1] == word]
    if elsewhere:
        return f"did you mean {elsewhere[0]}?"
    return near_miss(word, section.model_fields)


def section_at(location: Location, root: type[Section]) -> type[BaseModel]:
    """The section that a location leads to."""
    section: type[BaseModel] = root
    for part in location:
        if isinstance(part, str):
            section = next(iter(sections_in(section.model_fields[part])))
    return section


def field_at(location: Location, root: type[Section]) -> FieldInfo:
    """The field that a location ends at, or in: it may go on to an entry of a list or of a table by name."""
    section: type[BaseModel] = root
    keys = [part for part in location if isinstance(part, str)]
    for key in keys:
        field = section.model_fields[key]
        inner = sections_in(field)
        if not inner:
            break
        section = inner[0]
    return field


def dotted_keys(section: type[BaseModel], prefix: str) -> list[str]:
    """Every key that a file may hold, as a dotted path."""
    keys: list[str] = []
    for name, field in section.model_fields.items():
        inner = sections_in(field)
        keys += dotted_keys(inner[0], f"{prefix}{name}.") if inner else [prefix + name]
    return keys


def key_path(location: Location) -> str:
    """('cut', 0, 'mass_t') → 'cut[0].mass_t'."""
    path = "".join(f"[{part}]" if isinstance(part, int) else f".{excerpt(part)}" for part in location)
    return path.removeprefix(".")


S = TypeVar("S", bound=Section)


def changed(section: S, **values: Any) -> S:
    """`section` with other `values`; `PlantError` for one that its declaration does not allow."""
    held = {key: getattr(section, key) for key in type(section).model_fields}
    return made(type(section), **{**held, **values})


def made(model: type[S], **values: Any) -> S:
    """A section with these `values`; `PlantError` for one that its declaration does not allow."""
    try:
        return model.model_validate(values)
    except ValidationError as error:
        raise PlantError("; ".join(faults_in(error, model))) from None


def with_inputs(section: S, inputs: Mapping[str, float]) -> S:
    """`section` with other numbers: `{"prices.per_car_h": 2.0}` goes into its tables by their names.

    A number that is whole takes the nearest one. `PlantError` for a name that is none of its numbers, and for a number
    that is not allowed.
    """
    tables: dict[str, dict[str, float]] = {}
    given: dict[str, Any] = {}
    for name, number in inputs.items():
        head, _, rest = name.partition(".")
        held = getattr(section, head, None) if head in type(section).model_fields else None
        require(
            (isinstance(held, Section) and bool(rest)) or (isinstance(held, int | float) and not rest),
            f"{name!r} is no input of {type(section).__name__}; it has {', '.join(type(section).model_fields)}",
        )
        if rest:
            tables.setdefault(head, {})[rest] = number
        else:
            given[head] = round(number) if isinstance(held, int) else number
    for head, inner in tables.items():
        given[head] = with_inputs(getattr(section, head), inner)
    return changed(section, **given)


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
