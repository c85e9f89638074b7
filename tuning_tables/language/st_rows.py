"""Where elements stand in arrays of one axis, and which rows a loop asks for again and again."""

from __future__ import annotations

from collections.abc import Callable
from itertools import takewhile
from typing import NamedTuple

from tuning_tables.language.tree import Expression, If, Item, Statement, While
from tuning_tables.language.walking import expressions_in, names_in, targets_in


class Row(NamedTuple):
    """A variable that holds where a row of an array begins, and the variables that this is calculated from."""

    name: str
    names: frozenset[str]


class ArrayPlaces:
    """Places of elements of a program, as text.

    `atom`: an operand as text; `shape`: the lengths of the axes of an element's array.
    """

    def __init__(self, atom: Callable[[Expression], str], shape: Callable[[Item], tuple[int, ...]]) -> None:
        self.atom = atom
        self.shape = shape

    def row(self, item: Item) -> str:
        """Where the row of an element begins, of which the last index tells the place."""
        text = "0"
        for length, each in zip(self.shape(item)[1:], item.indices[:-1], strict=True):
            text = sum_of(text, self.atom(each))
            if text.isdigit():
                text = f"{int(text) * length}"
            elif length > 1:
                text = f"{f'({text})' if ' + ' in text and not text.endswith(')') else text} * {length}"
        return text

    def rows_in(self, body: tuple[Statement, ...]) -> dict[str, frozenset[str]]:
        """The beginnings of rows that must be calculated, each with its variables."""
        items = [each for each in expressions_in(body) if isinstance(each, Item) and len(each.indices) > 1]
        return {
            text: frozenset(name for index in each.indices[:-1] for name in names_in(index))
            for each in items
            if " " in (text := self.row(each))
        }

    def asked_again(self, body: tuple[Statement, ...]) -> dict[str, frozenset[str]]:
        """The rows of the first statement that a loop needs before any of their variables changes."""
        return {
            text: names
            for text, names in self.rows_in(body[:1]).items()
            if not isinstance(body[0], If) and any(text in self.rows_in((each,)) for each in loops_before(body, names))
        }


def loops_before(body: tuple[Statement, ...], names: frozenset[str]) -> list[While]:
    """The loops among the statements up to the first that assigns one of the variables `names`."""
    same = takewhile(lambda each: not names & {*targets_in((each,))}, body)
    return [each for each in same if isinstance(each, While)]


def sum_of(one: str, other: str) -> str:
    """The sum of two, without a 0."""
    return other if one == "0" else one if other == "0" else f"{one} + {other}"
