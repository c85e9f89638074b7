"""The keys of a configuration for its page: what a declaration says of each, in a table.

Between <!-- keys NAME --> and <!-- end --> stands that of the configuration NAME.
"""

from __future__ import annotations

from collections.abc import Iterator
from enum import Enum
from typing import Any, Final

from pydantic.fields import FieldInfo

from scripts.studies.markdown_table import table
from synth.computer.settings import ComputerSettings
from synth.frame.settings.numbers import holds_sections
from synth.frame.settings.section import Section, setting_limits, setting_source, setting_unit
from synth.frame.settings.template import words_of
from synth.frame.settings.toml_text import value_text

DECLARED: Final[dict[str, Section]] = {"computer": ComputerSettings()}
"""The configurations whose every key is declared."""

HEAD = ("key", "unless given", "unit", "allowed", "is", "from")


def keys_of(name: str) -> str:
    """The table of the keys of the configuration `name` as Markdown."""
    return table(f"keys {name}", HEAD, rows_of(DECLARED[name], "")).markdown()


def rows_of(section: Section, path: str) -> Iterator[tuple[str, ...]]:
    """A row for each table of the file, then one for each of its keys."""
    inner: list[tuple[str, Any]] = []
    for key, field in type(section).model_fields.items():
        value = getattr(section, key)
        if isinstance(value, Section) or holds_sections(value):
            inner.append((f"{path}.{key}".lstrip("."), value))
        else:
            yield key_row(key, value, field)
    for name, value in inner:
        first = value if isinstance(value, Section) else value[0]
        heading = f"[{name}]" if value is first else f"[[{name}]]"
        yield f"**`{heading}`**", "", "", "", " ".join((type(first).__doc__ or "").split()), ""
        if value is first:
            yield from rows_of(first, name)
        else:
            yield from (key_row(key, None, field) for key, field in type(first).model_fields.items())


def key_row(key: str, value: Any, field: FieldInfo) -> tuple[str, ...]:
    """What is declared of one key."""
    limits, words = setting_limits(field), words_of(field)
    allowed = f"{limits[0]:g} to {limits[1]:g}" if limits else " or ".join(f"`{word}`" for word in words)
    told = "–" if value is None else f"`{value_text(value.value if isinstance(value, Enum) else value)}`"
    return f"`{key}`", told, setting_unit(field), allowed, field.description or "", setting_source(field)
