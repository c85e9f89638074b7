"""What is told of a key of a configuration: its value, unit, range and origin, for the template and for documents."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from enum import Enum
from typing import Any, Literal, get_args, get_origin

from pydantic.fields import FieldInfo

from plant_models.library import SourcedValue
from plant_models.library.sourced_value import JUDGEMENT
from synth.frame.settings.section import parts_of, setting_limits, setting_source, setting_unit


@dataclass(frozen=True)
class Told:
    """`value` as TOML can hold it, None for none; '' for what is not told of it: a word has neither unit nor origin.

    `source`: with the confidence, where the value is of the library; `assumed`: nothing citable stands behind it.
    """

    value: Any
    unit: str = ""
    range: str = ""
    source: str = ""
    assumed: bool = False

    @property
    def origin(self) -> str:
        """Unit; range; source of a number; '' of a word."""
        source = f"ASSUMED, {self.source}" if self.assumed else self.source
        parts = (self.unit, self.range or "any", source) if self.unit else ()
        return "; ".join(part for part in parts if part)


Usual = Mapping[str, Told]
"""What stands for keys that a file leaves out, by dotted key, 'cut[0].mass_t' in lists of tables."""


def told_numbers(values: Iterable[SourcedValue]) -> dict[str, Told]:
    """Of numbers of the library."""
    return {value.key: told_number(value) for value in values}


def told_number(number: SourcedValue) -> Told:
    """Of a number of the library; its range is the sensible one."""
    confidence = f" (confidence {number.confidence})" if number.confidence else ""
    return Told(number.value, number.unit, number.span, number.source + confidence, number.assumed)


def told_key(value: Any, field: FieldInfo, usual: Told | None) -> Told:
    """Of a key that has this `value`, or without one that of the library; its origin as it is declared."""
    if value is None and usual is not None:
        return replace(usual, value=whole(usual.value, field))
    held = value.value if isinstance(value, Enum) else value
    unit, limits, source = setting_unit(field), setting_limits(field), setting_source(field)
    span = f"{limits[0]:g} to {limits[1]:g}" if limits else ""
    return Told(held, unit, span, source, source.startswith(JUDGEMENT))


def whole(value: Any, field: FieldInfo) -> Any:
    """A number of the library, which are all floats, as a key for whole numbers takes it."""
    kinds = set(parts_of(field.annotation))
    return int(value) if int in kinds and float not in kinds else value


def words_of(field: FieldInfo) -> tuple[str, ...]:
    """The words that a field may be, or that a list may hold, if they are a few."""
    for kind in parts_of(field.annotation):
        if get_origin(kind) is Literal:
            return get_args(kind)
        if isinstance(kind, type) and issubclass(kind, Enum):
            return tuple(each.value for each in kind)
    return ()
