"""An export as bare Structured Text: a file each part, or a file each unit."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TypeAlias

from tuning_tables.language.st_layout import file_comment, unit_text
from tuning_tables.language.st_unit import Export, units_of

Layout: TypeAlias = Callable[[Export], Mapping[str, bytes]]
"""A form of an export: its files, by name. Equal exports give equal bytes."""


def part_files(export: Export) -> Mapping[str, bytes]:
    """A file for the tables with their blocks, and one for the self-test, ASCII with LF."""
    return {
        f"{part.stem}.st": "\n".join([file_comment(part.head), *map(unit_text, part.units)]).encode("ascii")
        for part in export
    }


def unit_files(export: Export) -> Mapping[str, bytes]:
    """Each unit as a file; by their names in the order in which they need each other."""
    first, *others = units_of(export)
    texts = {first.name: "\n".join([file_comment(export[0].head), unit_text(first)])}
    texts |= {unit.name: unit_text(unit) for unit in others}
    return {f"{place:04d}_{name}.st": texts[name].encode("ascii") for place, name in enumerate(texts, start=1)}
