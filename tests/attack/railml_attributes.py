"""railML attribute by attribute: what is changed or taken out must be refused, or change what is read."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Final
from xml.etree import ElementTree as Xml

from synth.hump.hump_file import read_hump
from tests.attack.processes import Changed, Kind, Reading

MEANINGLESS: Final = ("id", "language", "descriptionLevel")
"""Attributes that say nothing of a hump, as long as no reference leads to them."""

ALTERNATIVES: Final = {"true": "false", "normal": "reverse", "straight": "arc", "AB": "BA", "0": "1", "1": "0"}
"""Words of railML, and what else may stand in their place."""


def read_all(folder: Path) -> str:
    """As `hump check`: the hump, and what was read over and is told."""
    read = read_hump(folder / "hump.railml")
    return repr((read.entry.title, read.entry.notes, read.entry.graph, read.ignored))


def attribute_kind(content: bytes) -> Kind:
    """Every attribute and every element of the railML file `content`, changed and taken out."""
    first = (*without_attributes(content), *other_attributes(content), *without_elements(content))
    return Kind("railml-attributes", {"hump.railml": content}, "hump.railml", read_all, first=first)


def without_attributes(content: bytes) -> Iterator[Changed]:
    """Each attribute taken out: it may have a usual value, unless it is a reference."""
    tree = Xml.fromstring(content)
    for element in tree.iter():
        for key, value in element.items():
            del element.attrib[key]
            allowed = Reading.NONE if is_reference(key) else Reading.ANY
            yield Changed(Xml.tostring(tree), f"{named(element)}: {key} is missing", allowed)
            element.set(key, value)


def other_attributes(content: bytes) -> Iterator[Changed]:
    """Each attribute with another value; where a reference leads nowhere, nothing may be read."""
    tree = Xml.fromstring(content)
    for element in tree.iter():
        for key, value in element.items():
            element.set(key, other := other_value(value))
            allowed = Reading.ANY if key in MEANINGLESS else Reading.NONE if is_reference(key) else Reading.OTHER
            yield Changed(Xml.tostring(tree), f"{named(element)}: {key} {value!r} is {other!r}", allowed)
            element.set(key, value)


def without_elements(content: bytes) -> Iterator[Changed]:
    """Each element that says something taken out."""
    tree = Xml.fromstring(content)
    for parent in tree.iter():
        for place, element in enumerate(list(parent)):
            if element.attrib:
                parent.remove(element)
                yield Changed(Xml.tostring(tree), f"{named(element)}: it is missing", Reading.OTHER)
                parent.insert(place, element)


def other_value(value: str) -> str:
    """Another value of the same kind."""
    try:
        return ALTERNATIVES.get(value) or repr(1.25 * float(value) + 1.0)
    except ValueError:
        return f"{value}x"


def is_reference(key: str) -> bool:
    """Whether the attribute `key` names another element."""
    return key.lower().endswith("ref")


def named(element: Xml.Element) -> str:
    """Its name, and what tells it from others."""
    told = (element.get(key) for key in ("id", "number", "netElementRef", "ref"))
    return f"{element.tag.rpartition('}')[2]} {next(filter(None, told), '')}"
