"""A drawing as a part of a page: its text can be searched and copied, and it is as dark or light as the page."""

from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Final
from xml.etree import ElementTree

from synth.frame.page.markup import Markup

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
