"""Amounts that a configuration with a currency of its own leaves as they are: numbers of the usual currency."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

from synth.computer.economics.prices import Prices
from synth.computer.settings import ComputerSettings
from synth.frame.settings.numbers import numbers_of
from synth.frame.settings.section import Section

CURRENCY: Final = "currency"
"""Begins the unit of an amount."""


def unpriced(settings: ComputerSettings) -> Iterator[str]:
    """A sentence with the keys of all amounts that are not given, where the currency is another than the usual one."""
    usual, own = Prices.model_fields[CURRENCY].default, settings.prices.currency
    if own == usual:
        return
    amounts = [each.key for each in numbers_of(settings) if each.unit.startswith(CURRENCY)]
    missing = [key for key in amounts if not is_given(settings, key)]
    if "range" not in settings.model_fields_set:  # of a number that is given no usual range is taken
        missing += [f"[[range]] of {each.input}" for each in settings.range if each.input in missing]
    if missing:
        yield (
            f"prices.currency is {own!r}, but these amounts are not given and stay numbers of {usual}: "
            f"{', '.join(missing)}; give each of them in {own}"
        )


def is_given(settings: Section, key: str) -> bool:
    """Whether the file says the number under the dotted `key`."""
    name, _, rest = key.partition(".")
    if name not in settings.model_fields_set:
        return False
    inner = getattr(settings, name)
    return not rest or not isinstance(inner, Section) or is_given(inner, rest)
