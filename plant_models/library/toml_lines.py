"""On which line of a TOML text a table, a row or a value stands, which tomllib does not tell."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping, Sequence
from typing import Final

Place = tuple[str | int, ...]
"""Keys and places in lists, from the top of the file: ('hump', 'switch', 3, 'left')."""

BETWEEN: Final = re.compile(r"(?:[ \t\r\n]|#[^\n]*)*")
BETWEEN_ITEMS: Final = re.compile(r"(?:[ \t\r\n,]|#[^\n]*)*")
"""What may stand between tokens, and between the items of a list."""

STRING: Final = re.compile(
    r'"""(?:[^"\\]|\\.|"{1,2}(?!"))*"{3,5}|\'\'\'(?:[^\']|\'{1,2}(?!\'))*\'{3,5}|"(?:[^"\\]|\\.)*"|\'[^\']*\'',
    re.DOTALL,
)
BARE_KEY: Final = re.compile(r"[A-Za-z0-9_-]+")
WORD: Final = re.compile(r"[^ \t\r\n,\]}#]+(?: \d[^ \t\r\n,\]}#]*)?")
"""A number, a truth value or a date; the time of a date may stand behind a blank."""


def line_of(text: str, place: Sequence[str | int]) -> int:
    """The line (from 1) of what is at `place` in the valid TOML `text`, or of the innermost thing around it."""
    return line_around(text, place) or 1


def line_around(text: str, place: Sequence[str | int]) -> int | None:
    """The same, None where nothing around it stands on a line."""
    return line_among(places_of(text), place)


def line_among(lines: Mapping[Place, int], place: Sequence[str | int]) -> int | None:
    """The same, of a text with these `lines`."""
    wanted = tuple(place)
    while wanted and wanted not in lines:
        wanted = wanted[:-1]
    return lines.get(wanted)


def places_of(text: str) -> Mapping[Place, int]:
    """The line of every table, key and item of a list in the valid TOML `text`."""
    return _Reader(text).read()


class _Reader:
    """Goes through a text that tomllib has found valid; so it looks for no fault."""

    def __init__(self, text: str) -> None:
        self.text, self.at, self.line = text, 0, 1
        self.lines: dict[Place, int] = {}
        self.items: dict[Place, int] = {}  # of lists of tables, so far

    def read(self) -> Mapping[Place, int]:
        table: Place = ()
        while self.over(BETWEEN):
            if self.text[self.at] == "[":
                many = self.text.startswith("[[", self.at)
                self.forward(2 if many else 1)
                table = self.header(self.keys(), many)
                self.forward(2 if many else 1)
            else:
                self.pair(table)
        return self.lines

    def header(self, keys: Sequence[str], many: bool) -> Place:
        """The place that a header names: in lists of tables it is of the last item so far."""
        place: Place = ()
        for key in keys[:-1]:
            place = self.last_item((*place, key))
        place = (*place, keys[-1])
        if many:
            self.items[place] = self.items.get(place, 0) + 1
            place = self.last_item(place)
        self.mark(place, self.line)
        return place

    def last_item(self, place: Place) -> Place:
        return (*place, self.items[place] - 1) if place in self.items else place

    def pair(self, table: Place) -> None:
        line = self.line
        place = (*table, *self.keys())
        self.forward(1)  # =
        self.mark(place, line)
        self.value(place)

    def value(self, place: Place) -> None:
        self.over(BETWEEN)
        opened = self.text[self.at]
        if opened in "\"'":
            self.token(STRING)
        elif opened not in "[{":
            self.token(WORD)
        else:
            self.forward(1)
            item = 0
            while self.over(BETWEEN_ITEMS) and self.text[self.at] not in "]}":
                if opened == "{":
                    self.pair(place)
                else:
                    self.mark((*place, item), self.line)
                    self.value((*place, item))
                    item += 1
            self.forward(1)

    def keys(self) -> list[str]:
        """The parts of a dotted key, and what is between it and the next sign."""
        found: list[str] = []
        while True:
            self.over(BETWEEN)
            if self.text[self.at] in "\"'":
                found.append(tomllib.loads(f"k = {self.token(STRING)}")["k"])
            else:
                found.append(self.token(BARE_KEY))
            self.over(BETWEEN)
            if self.text[self.at] != ".":
                return found
            self.forward(1)

    def token(self, form: re.Pattern[str]) -> str:
        """Over what has `form`, and its text."""
        found = form.match(self.text, self.at)
        assert found is not None, self.text[self.at : self.at + 40]
        self.forward(len(found[0]))
        return found[0]

    def over(self, form: re.Pattern[str]) -> bool:
        """Over what has `form`; whether more follows."""
        self.token(form)
        return self.at < len(self.text)

    def forward(self, characters: int) -> None:
        self.line += self.text.count("\n", self.at, self.at + characters)
        self.at += characters

    def mark(self, place: Place, line: int) -> None:
        for length in range(len(place), 0, -1):
            if place[:length] in self.lines:
                break
            self.lines[place[:length]] = line
