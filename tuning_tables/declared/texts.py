"""A text of a table: any printable one, one of a form, or one of some words."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import Any, Generic, TypeVar

from tuning_tables.declared.members import Json, Place
from tuning_tables.errors import InvalidTable, excerpt, require_kind, require_match, require_text


@dataclass(frozen=True)
class Text:
    """A printable text that is not empty; of the form `pattern`, such as `example`, where they are given."""

    meaning: str
    pattern: str = ""
    example: str = ""
    unit: str = "1"
    axes: tuple[str, ...] = ()
    dtype: str = "S"

    @property
    def allowed(self) -> str:
        """Its limits in words."""
        return self.example or "text"

    def check(self, value: Any, key: str) -> None:
        """It is such a text."""
        if self.pattern:
            require_match(value, key, self.pattern, self.example)
        else:
            require_text(value, key)

    def written(self, value: Any) -> object:
        """Itself."""
        return value

    def read(self, value: object, place: Place) -> Any:
        """A string."""
        if not isinstance(value, str):
            place.refuse(value, "a string")
        return value

    def schema(self) -> Json:
        """A string."""
        return {"type": "string", "pattern": self.pattern} if self.pattern else {"type": "string", "minLength": 1}

    def cells(self, value: Any) -> Any:
        """UTF-8."""
        return value.encode("utf-8")

    def of_cells(self, cells: Any) -> Any:
        """From UTF-8; `UnicodeDecodeError` for what is none."""
        return bytes(cells).decode("utf-8")


_Word = TypeVar("_Word", bound=Enum)


@dataclass(frozen=True)
class Word(Generic[_Word]):
    """One of the words of `words`, an Enum whose values they are."""

    meaning: str
    words: type[_Word]
    unit: str = "1"
    axes: tuple[str, ...] = ()
    dtype: str = "S"

    @property
    def allowed(self) -> str:
        """Its words."""
        return " or ".join(f'"{each.value}"' for each in self.words)

    def check(self, value: Any, key: str) -> None:
        """It is one of the Enum."""
        require_kind(value, key, self.words)

    def written(self, value: Any) -> object:
        """The word."""
        return value.value

    def read(self, value: object, place: Place) -> Any:
        """A known word."""
        known = next((each for each in self.words if each.value == value), None)
        return place.refuse(value, self.allowed) if known is None else known

    def schema(self) -> Json:
        """One of the words."""
        return {"enum": [each.value for each in self.words]}

    def cells(self, value: Any) -> Any:
        """The word in UTF-8."""
        return value.value.encode("utf-8")

    def of_cells(self, cells: Any) -> Any:
        """The word in UTF-8."""
        word = bytes(cells).decode("utf-8")
        known = next((each for each in self.words if each.value == word), None)
        if known is None:
            raise InvalidTable(f"a word of the book is {excerpt(repr(word))}, but it must be {self.allowed}.")
        return known
