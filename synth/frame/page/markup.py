"""HTML from plain text: whatever is not markup already is escaped."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape

VOID = ("img", "meta")


class Markup(str):
    """Text that is HTML already."""

    __slots__ = ()


@dataclass(frozen=True)
class Cell:
    """A table cell: text, a tool tip, and a class for its style."""

    text: str
    note: str = ""
    kind: str = ""


def element(tag: str, *content: str, **attributes: str) -> Markup:
    """`<tag attributes>content</tag>`; an attribute that is a word of Python takes a trailing underscore.

    Content that is not `Markup` is escaped, attributes always; empty attributes are left out.
    """
    shown = "".join(
        f' {name.rstrip("_").replace("_", "-")}="{escape(text)}"' for name, text in attributes.items() if text
    )
    return Markup(f"<{tag}{shown}>" if tag in VOID else f"<{tag}{shown}>{joined(content)}</{tag}>")


def joined(parts: Iterable[str]) -> Markup:
    """The parts one after another."""
    return Markup("".join(part if isinstance(part, Markup) else escape(part) for part in parts))


def table(
    name: str, head: Sequence[Markup], rows: Iterable[tuple[Sequence[str | Cell], str]], kind: str = ""
) -> Markup:
    """A table with caption `name` that scrolls by itself; `head`: rows of `<tr>`; `rows`: cells and class of a row.

    The first cell of a row names the row.
    """
    body = [element("tr", *(table_cell(cell, place == 0) for place, cell in enumerate(row)), class_=style)
            for row, style in rows]  # fmt: skip
    inside = element("table", element("caption", name), element("thead", *head), element("tbody", *body), class_=kind)
    return element("div", inside, class_="scroll", tabindex="0", role="region", aria_label=name)


def table_cell(cell: str | Cell, names_row: bool) -> Markup:
    """One `<td>`, or the `<th>` that names its row."""
    if not isinstance(cell, Cell):
        cell = Cell(cell)
    if names_row:
        return element("th", cell.text, scope="row", class_=cell.kind, title=cell.note)
    return element("td", cell.text, class_=cell.kind, title=cell.note)


def fold(summary: str, *content: str) -> Markup:
    """What is seen only when it is opened; `summary` says what it is."""
    return element("details", element("summary", summary), *content)


def head_row(*cells: str | tuple[str, int]) -> Markup:
    """A head row; (text, n): a cell over n columns."""
    parts = []
    for cell in cells:
        text, span = (cell, 1) if isinstance(cell, str) else cell
        if span > 1:
            parts.append(element("th", text, scope="colgroup", colspan=str(span)))
        else:
            parts.append(element("th", text, scope="col"))
    return element("tr", *parts)
