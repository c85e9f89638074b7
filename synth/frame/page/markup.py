"""HTML from plain text: whatever is not markup already is escaped. A drawing is a part of the page: its text can
be searched and copied, and it is as dark or light as the page.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape
from typing import Final
from xml.etree import ElementTree

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


SVG: Final = "http://www.w3.org/2000/svg"
XLINK: Final = "http://www.w3.org/1999/xlink"
NOT_SHOWN: Final = frozenset({f"{{{SVG}}}metadata", f"{{{SVG}}}style"})

PLACES: Final = ("d", "x", "y", "width", "height", "transform", "points")
"""Attributes that hold places: a hundredth of a point is finer than any screen."""

FINE: Final = re.compile(r"(\.\d\d)\d+")
POINTER: Final = re.compile(r"#([^)\"]+)")


@dataclass(frozen=True)
class InlineDrawing:
    """An element of a page, and its width in points."""

    markup: Markup
    width_pt: float


def inline_svg(svg: bytes, name: str, prefix: str) -> InlineDrawing:
    """`svg`, whose width is in points, as an element of an HTML page, called `name` by programs that read it aloud.

    Identifiers begin with `prefix`, so that those of two drawings cannot meet; those that nothing points to go.
    """
    for space, uri in (("", SVG), ("xlink", XLINK)):
        ElementTree.register_namespace(space, uri)
    root = ElementTree.fromstring(svg)
    values = [value for each in root.iter() for value in each.attrib.values()]
    pointed_to = {found for value in values if "#" in value for found in POINTER.findall(value)}
    for each in root.iter():
        for child in [child for child in each if child.tag in NOT_SHOWN]:
            each.remove(child)
        each.attrib.update({key: shorter(value) for key, value in each.attrib.items() if key in PLACES})
        identify(each, pointed_to, prefix)
        each.tail = None
    root.attrib |= {"role": "img", "aria-label": name}
    markup = Markup(ElementTree.tostring(root, encoding="unicode"))
    return InlineDrawing(markup, float(root.attrib["width"].removesuffix("pt")))


def shorter(places: str) -> str:
    """Places to a hundredth, a line instead of many."""
    if "scale" in places or "matrix" in places:
        return places  # a factor is no place
    return " ".join(FINE.sub(r"\1", places).split())


def identify(each: ElementTree.Element, pointed_to: set[str], prefix: str) -> None:
    """Put `prefix` before the identifier of an element and before those that it points to."""
    own = each.attrib.pop("id", None)
    for key, value in each.attrib.items():
        if value.startswith(("#", "url(#")):
            each.attrib[key] = value.replace("#", f"#{prefix}", 1)
    if own in pointed_to:
        each.attrib["id"] = f"{prefix}{own}"
