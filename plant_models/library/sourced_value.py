"""A number with its origin: unit, sensible range, source, confidence, and whether it is only assumed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from plant_models.errors import require

Value = float | tuple[float, ...] | tuple[tuple[float, float], ...]
"""A number, a list of numbers, or a list of pairs."""

CONFIDENCES = ("H", "M-H", "M", "L-M", "L")
"""High, medium, low; docs/reference/sources.md says what they stand for."""

JUDGEMENT = "engineering judgement"
"""How the source of a value begins that nobody can be cited for."""

SET_BY_USER = "configuration"
"""Source of a value that the user's configuration replaced."""


@dataclass(frozen=True)
class SourcedValue:
    """One parameter, named by its dotted `key` (the same in library and configuration files).

    `range` is the sensible one, each number of `value` inside it, or None; it warns, it does not forbid.
    `confidence` is one of `CONFIDENCES`, or '' for a choice that claims nothing about the world.
    """

    key: str
    value: Value
    unit: str
    range: tuple[float, float] | None
    source: str
    confidence: str

    @property
    def assumed(self) -> bool:
        """True if nothing citable stands behind the number: engineering judgement, or low confidence."""
        return self.source.startswith(JUDGEMENT) or self.confidence in ("L", "L-M")

    @property
    def fixed(self) -> bool:
        """The sensible range holds no more than the value itself."""
        numbers = flat_numbers(self.value)
        return bool(numbers) and self.range == (min(numbers), max(numbers))

    @property
    def span(self) -> str:
        """The sensible range in words, '' if there is none."""
        if self.range is None:
            return ""
        return "fixed" if self.fixed else f"{self.range[0]:g} to {self.range[1]:g}"

    @property
    def in_range(self) -> bool:
        """Every number of `value` is inside the sensible range."""
        if self.range is None:
            return True
        low, high = self.range
        numbers = flat_numbers(self.value)
        if self.unit.startswith("permille") and isinstance(self.value, tuple):
            numbers = numbers[1::2]  # pieces of a profile are (start in m, grade): only the grade has this range
        return all(low <= x <= high for x in numbers)

    def replaced(self, value: Value) -> SourcedValue:
        """The same parameter with the user's value; a value that repeats this one keeps its origin."""
        if value == self.value:
            return self
        return replace(self, value=value, source=SET_BY_USER, confidence="")


@dataclass(frozen=True)
class SourcedTable:
    """Sourced values by dotted key, in the order of their file."""

    values: tuple[SourcedValue, ...]

    def __getitem__(self, key: str) -> SourcedValue:
        return next(v for v in self.values if v.key == key)

    def number(self, key: str) -> float:
        """The number under `key`."""
        value = self[key].value
        assert isinstance(value, float), key
        return value

    def numbers(self, key: str) -> tuple[float, ...]:
        """The list of numbers under `key`."""
        value = self[key].value
        assert isinstance(value, tuple), key
        return tuple(x for x in value if isinstance(x, float))

    def pairs(self, key: str) -> tuple[tuple[float, float], ...]:
        """The list of pairs under `key`."""
        value = self[key].value
        assert isinstance(value, tuple), key
        return tuple(x for x in value if isinstance(x, tuple))

    def replaced(self, overrides: Mapping[str, Value]) -> SourcedTable:
        """The table with some values replaced; every key of `overrides` must be in the table."""
        unknown = overrides.keys() - {v.key for v in self.values}
        require(not unknown, f"{min(unknown, default='')}: there is no such parameter")
        return SourcedTable(tuple(v.replaced(overrides[v.key]) if v.key in overrides else v for v in self.values))


def flat_numbers(value: Value) -> tuple[float, ...]:
    """All numbers of `value`, in order."""
    if isinstance(value, float):
        return (value,)
    return tuple(x for item in value for x in flat_numbers(item))
