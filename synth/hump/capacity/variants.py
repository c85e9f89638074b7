"""Changes to a trial, by its keys: every combination of the values that were typed is a trial of its own."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from copy import deepcopy
from dataclasses import dataclass
from itertools import product
from typing import Any, Final

from synth.frame.faults import InputError
from synth.frame.settings.template import toml_text, value_text
from synth.frame.settings.toml_file import Tree, toml_tree

Changes = Mapping[str, Any]
"""New values by key: 'weather.head_wind_mean_m_s', 'position.2.exit_std_m_s' of the position with that number."""

LISTED: Final = "position"
"""The key of tables that are told by their number."""

MOST_DOTS, MOST_DIGITS = 8, 4
"""In a key, and in the number of a position: no trial has more, and a word of any length may be typed."""


@dataclass(frozen=True)
class KeyValues:
    """A key of the trial and its values, as `option` said."""

    option: str
    keys: tuple[str, ...]
    values: tuple[Any, ...]

    @property
    def choices(self) -> Iterator[tuple[Any, Changes]]:
        """Each value with the changes that it stands for."""
        for value in self.values:
            yield value, dict.fromkeys(self.keys, value)


@dataclass(frozen=True)
class Variant:
    """One combination: `told` tells by option what it is, `changes` what is written into the trial."""

    told: Mapping[str, Any]
    changes: Changes

    @property
    def name(self) -> str:
        """'exit_std_m_s 0.2, weather.head_wind_mean_m_s 6'; '' where nothing is changed."""
        return ", ".join(
            f"{key} {value if isinstance(value, str) else value_text(value)}" for key, value in self.told.items()
        )


def variants(asked: Sequence[KeyValues]) -> tuple[Variant, ...]:
    """All combinations, the last key changing first; the trial as it is where no key is asked."""
    found = []
    for chosen in product(*(each.choices for each in asked)):
        told = {each.option: value for each, (value, _) in zip(asked, chosen, strict=True)}
        changes = {key: value for _, changed in chosen for key, value in changed.items()}
        found.append(Variant(told, changes))
    return tuple(found)


def key_values(words: str) -> KeyValues:
    """What 'KEY=A,B' says; values are those of TOML, other words are text. `InputError`."""
    key, _, values = words.partition("=")
    key = key.strip()
    if not key or not values or key.count(".") > MOST_DOTS:
        raise InputError(f"--set is {words!r}; it must be a key and its values, as in weather.head_wind_mean_m_s=0,6")
    return KeyValues(key, (key,), tuple(value_of(each.strip()) for each in values.split(",")))


def value_of(word: str) -> Any:
    """A number, a truth value, or the word itself."""
    try:
        found = toml_tree(f"value = {word}", "--set")["value"]
    except InputError:
        return word
    return found if isinstance(found, bool | int | float | str) else word


def changed_text(text: str, place: str, changes: Changes) -> str:
    """The configuration `text` with other values of some keys."""
    tree = deepcopy(toml_tree(text, place))
    for key, value in changes.items():
        *path, last = key.split(".")
        table_at(tree, path, key)[last] = value
    return toml_text(tree)


def table_at(tree: Tree, path: Sequence[str], key: str) -> Any:
    """The table that holds `key`, made where it is missing. `InputError` where something else stands there."""
    below: Any = tree
    steps = list(path)
    while steps:
        step = steps.pop(0)
        if step == LISTED and steps:
            below = numbered(below.setdefault(LISTED, []), steps.pop(0), key)
            continue
        below = below.setdefault(step, {})
        if not isinstance(below, dict):
            raise InputError(f"--set {key}: {step} is no table of keys")
    return below


def numbered(tables: list[dict[str, Any]], number: str, key: str) -> dict[str, Any]:
    """The table of the position with this number."""
    if not number.isdecimal() or len(number) > MOST_DIGITS:
        raise InputError(f"--set {key}: behind position comes its number, as in position.2.exit_std_m_s")
    for table in tables:
        if table.get("number") == int(number):
            return table
    tables.append({"number": int(number)})
    return tables[-1]
