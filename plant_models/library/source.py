"""What a number is cited from: who, what, when, where to find it."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from functools import cache
from importlib.resources import files

from plant_models.errors import require
from plant_models.library.data_file import parse_toml, take_string, telling

FILE = "sources.toml"

CITATION = re.compile(r"\[([a-z]+(?:-[a-z0-9]+)+)\]")
"""A source's name in a text: words with hyphens, in brackets."""


@dataclass(frozen=True)
class Source:
    """One entry of the library's sources; `name` is what stands in brackets where it is cited.

    `where`: how to find it, or what is missing in the copy that was read.
    """

    name: str
    author: str
    title: str
    year: str
    where: str

    @property
    def reference(self) -> str:
        """Everything but the name, in one line."""
        return f"{self.author}: {self.title}, {self.year}. {self.where}"


@cache
def sources() -> tuple[Source, ...]:
    """All sources of the library, in the order of its file."""
    return sources_from_toml(files("plant_models.library").joinpath(FILE).read_text(encoding="utf-8"))


def sources_cited_in(texts: Iterable[str]) -> tuple[Source, ...]:
    """The sources whose names stand in brackets in `texts`, in the order of `sources`."""
    names = {name for text in texts for name in CITATION.findall(text)}
    return tuple(source for source in sources() if source.name in names)


def sources_from_toml(text: str) -> tuple[Source, ...]:
    """The sources written in `text`, one table each; `PlantError` names file and key."""
    found = []
    with telling(FILE):
        for name, tree in parse_toml(text).items():
            require(isinstance(tree, dict), f"{name} is {tree!r}; it must be a table")
            with telling(f"{FILE}: {name}"):
                author, title, year, where = (take_string(tree, key) for key in ("author", "title", "year", "where"))
                require(not tree, f"unknown key {min(tree, default='')}; known: author, title, year, where")
            found.append(Source(name, author, title, year, where))
    return tuple(found)
