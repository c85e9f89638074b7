"""Reading a configuration file: TOML → `Settings` → `ResolvedConfig`, every fault as one sentence."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any, get_args

from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo
from pydantic_core import ErrorDetails

from plant_models.library.near_miss import near_miss
from synth.configuration.own_types import with_own_types
from synth.configuration.resolved_config import ResolvedConfig, resolve, setting_limits
from synth.configuration.section import Section
from synth.configuration.settings import Settings
from synth.configuration.toml_file import Tree, read_text, toml_tree
from synth.faults.input_error import InputError
from tuning_tables.excerpt import excerpt

BUILT_IN = "built-in configuration"

ALLOWED = {
    "float_type": "a number",
    "int_type": "a whole number",
    "string_type": "a string in quotes",
    "bool_type": "true or false",
    "finite_number": "a finite number",
    "model_type": "a table",
    "tuple_type": "a list",
    "string_pattern_mismatch": "made of at most 61 letters, digits, dots, hyphens and underscores",
}
"""What a value must be, by pydantic's error type."""

LENGTHS = {
    "consist": "a list of 1 to 60 tables {car = …, cars = …, mass_per_car_t = …}",
    "library": "a list of at most 20 folders",
}
"""What a list that is too long or too short must be, by its key."""

Location = Sequence[str | int]


def load_config(path: Path | None) -> ResolvedConfig:
    """The configuration in the file `path`, or the built-in default; `InputError` on any fault."""
    if path is None:
        return resolve(Settings(), BUILT_IN)
    return parse_config(read_text(path), str(path))


def parse_config(text: str, file: str) -> ResolvedConfig:
    """The configuration written in `text`; `file`: what messages call it, and where paths in it begin."""
    tree, library = with_own_types(toml_tree(text, file), file)
    return resolve(valid_settings(tree, file), file, library)


def valid_settings(tree: Tree, where: str) -> Settings:
    """The settings in `tree`; `InputError` with a sentence for each fault, which begins with `where`."""
    try:
        return Settings.model_validate(tree)
    except ValidationError as error:
        raise InputError(*(f"{where}: {sentence}" for sentence in faults_in(error))) from None


def faults_in(error: ValidationError) -> list[str]:
    """Every fault as a sentence; mistyped keys come before missing ones."""
    found = error.errors(include_url=False)
    own = [fault for fault in found if fault["type"] != "too_short" or not fault["input"]]  # else a sequel of another
    return [fault_sentence(fault) for fault in sorted(own, key=lambda fault: fault["type"] != "extra_forbidden")]


def fault_sentence(fault: ErrorDetails) -> str:
    """One pydantic error as 'key is value; what is allowed'."""
    location, kind, value = fault["loc"], fault["type"], fault["input"]
    key = key_path(location)
    if kind == "extra_forbidden":
        return f"{key} = {shown(value)} is an unknown key; {hint(location)}"
    if kind == "missing":
        return f"{key} is missing; add it to {key_path(location[:-1]) or 'the file'}"
    return f"{key} is {shown(value)}; it must be {allowed(fault)}"


def allowed(fault: ErrorDetails) -> str:
    """What the value at fault must be."""
    kind, context = fault["type"], fault.get("ctx", {})
    if kind in ("greater_than_equal", "less_than_equal"):
        limits = setting_limits(field_at(fault["loc"]))
        return f"from {limits[0]:g} to {limits[1]:g}" if limits else fault["msg"]
    if kind == "value_error":
        return str(context["error"]).removeprefix("it must be ")
    if kind == "literal_error":
        return str(context["expected"])
    if kind in ("too_short", "too_long"):
        return LENGTHS.get(str(fault["loc"][-1]), "a list of 1 to 1000 [[cut]] tables")
    if fault["loc"] == ("cut",):
        return "a list of tables: write [[cut]], not [cut]"
    return ALLOWED.get(kind, fault["msg"])


def hint(location: Location) -> str:
    """Which key was meant: one of the section's, or the same name in another section, else all that the section has."""
    section, word = section_at(location[:-1]), str(location[-1])
    elsewhere = [key for key in dotted_keys(Settings, "") if key.split(".")[-1] == word]
    if elsewhere:
        return f"did you mean {elsewhere[0]}?"
    return near_miss(word, section.model_fields)


def section_at(location: Location) -> type[BaseModel]:
    """The section that a location leads to."""
    section: type[BaseModel] = Settings
    for part in location:
        if isinstance(part, str):
            section = next(iter(sections_in(section.model_fields[part])))
    return section


def field_at(location: Location) -> FieldInfo:
    """The field that a location ends at."""
    return section_at(location[:-1]).model_fields[str(location[-1])]


def sections_in(field: FieldInfo) -> list[type[Section]]:
    """The section that a field holds, or a list of; empty for a plain value."""
    return [c for c in parts_of(field.annotation) if isinstance(c, type) and issubclass(c, Section)]


def parts_of(annotation: Any) -> Iterator[Any]:
    """A type, and all that it is made of."""
    yield annotation
    for part in get_args(annotation):
        yield from parts_of(part)


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


def shown(value: Any) -> str:
    """A value as the file writes it, cut off if long."""
    text = str(value).lower() if isinstance(value, bool) else repr(value)
    return text if len(text) <= 80 else text[:77] + "…"
