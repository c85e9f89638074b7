"""A declared value as rows of texts: a record, the dotted key, and what stands there."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from tuning_tables.declared.members import LeafMember, SectionMember, members_of
from tuning_tables.errors import InvalidTable
from tuning_tables.excerpt import excerpt
from tuning_tables.sheet import FORMULA_MARKS


def key_rows(value: Any, key: str) -> Iterator[list[str]]:
    """A row for each text, number or row of numbers of the declared `value` found at `key`; none for what is None.

    Numbers at the nodes of a table have none: they lie along no axis of their own. Raises as `text_row`.
    """
    for name, member in members_of(type(value)).items():
        found, at = getattr(value, name), f"{key}.{name}" if key else name
        if found is None:
            continue
        match member:
            case LeafMember():
                leaf = member.leaf
                if leaf.dtype == "S":
                    yield text_row(at, str(leaf.written(found)))
                elif leaf.axes is not None:
                    yield from _number_rows(leaf.cells(found), at)
            case SectionMember():
                yield from key_rows(found, at)
            case _:
                for index, each in enumerate(found):
                    yield from key_rows(each, f"{at}.{index}")


def text_row(key: str, text: str) -> list[str]:
    """The row of a text; `InvalidTable` for one that a spreadsheet would take for a formula and compute."""
    if text.startswith(FORMULA_MARKS):
        raise InvalidTable(
            f"{key} is {excerpt(text)!r}, which a spreadsheet would compute; give it a name that does not begin "
            f"with {text[0]!r}, or export another form."
        )
    return ["text", key, text]


def _number_rows(cells: Any, key: str) -> Iterator[list[str]]:
    """One row of a number or a row of numbers, else a row for each of what it holds."""
    if not isinstance(cells, list | tuple):
        yield ["number", key, repr(cells)]
    elif isinstance(cells[0], list | tuple):
        for index, row in enumerate(cells):
            yield from _number_rows(row, f"{key}.{index}")
    else:
        yield ["number", key, *map(repr, cells)]
