"""A railML file as a tree: names of railML 3 and of the namespace for what it has no word for (nothing of railML's
schema is here); parsed with care, attributes read with one sentence for each fault.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Final
from xml.etree import ElementTree as Xml

from plant_models.hump import Switch, Vertex
from plant_models.library.hump_forms import LONGEST_NAME, short_text
from synth.frame.faults import InputError
from tuning_tables.errors import excerpt

RAILML: Final = "https://www.railml.org/schemas/3.1"
OWN: Final = "urn:retarder-synth:hump:1"

LIBRARY, OWN_ZONES = "library", "own"
"""Where the zones of a retarder come from: its position in the library, or one that the library does not have."""

SIDES: Final = ("left", "right")


def railml(name: str) -> str:
    """A name of railML, as ElementTree has it."""
    return f"{{{RAILML}}}{name}"


def own(name: str) -> str:
    """A name of the namespace of ours."""
    return f"{{{OWN}}}{name}"


def net_element(vertex: Vertex, branch: int) -> str:
    """The identifier of an edge: that of a branch of a switch tells the side."""
    return f"ne_{vertex.number}_{SIDES[branch]}" if isinstance(vertex, Switch) else f"ne_{vertex.number}"


def net_relation(ahead: str, behind: str) -> str:
    """The identifier of the way from one edge to the next."""
    return f"nr_{ahead}_{behind}"


CONTAINERS: Final = (
    *("railML", "infrastructure", "topology", "netElements", "netRelations", "networks", "geometry", "gradientCurves"),
    *("horizontalCurves", "functionalInfrastructure", "signalsIS", "switchesIS", "trainDetectionElements", "tracks"),
)
READ: Final = (
    *("netElement", "relation", "netRelation", "elementA", "elementB", "network", "level", "networkResource", "name"),
    *("gradientCurve", "horizontalCurve", "spotLocation", "linearLocation", "associatedNetElement", "signalIS"),
    *("switchIS", "leftBranch", "rightBranch", "trainDetectionElement", "track"),
)
"""Elements of railML that are written, and read again; any other is read over and told."""


DEEPEST: Final = 30
RAILML_3: Final = "https://www.railml.org/schemas/3."


@dataclass(frozen=True)
class RailmlTree:
    """The parsed `root` of the file that messages call `file`; `namespace`: that of railML in it."""

    root: Xml.Element
    file: str
    namespace: str

    def every(self, name: str) -> list[Xml.Element]:
        """All elements of railML with that name that are read."""
        return [each for each in self.told if each.tag == f"{{{self.namespace}}}{name}"]

    def every_own(self, name: str) -> list[Xml.Element]:
        """All elements of our namespace with that name."""
        return [each for each in self.told if each.tag == own(name)]

    def ends(self, relation: Xml.Element) -> tuple[str, str]:
        """The edges (ahead, behind) of a netRelation."""
        return self.text(self.inner(relation, "elementA"), "ref"), self.text(self.inner(relation, "elementB"), "ref")

    @cached_property
    def told(self) -> tuple[Xml.Element, ...]:
        """What is read: the elements in containers; the hump of our namespace, and then what is in it."""
        waiting, found = [self.root], []
        for container in waiting:
            for child in container:
                if self.is_container(child) or child.tag == own("hump"):
                    waiting.append(child)
                if self.is_known(child) and not self.is_container(child):
                    found.append(child)
        return tuple(found)

    def is_container(self, element: Xml.Element) -> bool:
        """Whether it is an element of railML that only holds others."""
        return element.tag.startswith(f"{{{self.namespace}}}") and local(element) in CONTAINERS

    def is_known(self, element: Xml.Element) -> bool:
        """Whether it is one of ours, or one of railML that is read or holds such."""
        if element.tag.startswith(f"{{{OWN}}}"):
            return True
        return element.tag.startswith(f"{{{self.namespace}}}") and local(element) in CONTAINERS + READ

    def inner(self, element: Xml.Element, name: str) -> Xml.Element:
        """The element of railML that must be in `element`."""
        found = element.find(f".//{{{self.namespace}}}{name}")
        if found is None:
            raise self.fault(element, f"it has no {name}; add one")
        return found

    def text(self, element: Xml.Element, key: str) -> str:
        """The attribute `key`, which must be there."""
        value = element.get(key)
        if not value or not value.isprintable():
            raise self.fault(element, f"the attribute {key} is missing or not printable; give it")
        return value

    def number(self, element: Xml.Element, key: str) -> float:
        """The attribute `key` as a finite number."""
        raw = self.text(element, key)
        try:
            value = float(raw) if raw.isascii() and "_" not in raw else math.nan
        except ValueError:
            value = math.nan
        if not math.isfinite(value):
            raise self.fault(element, f"{key} is {excerpt(raw)!r}; it must be a finite number")
        return value

    def whole(self, element: Xml.Element, key: str) -> int:
        """The attribute `key` as a whole number."""
        raw = self.text(element, key)
        if not (raw.isascii() and raw.isdigit() and len(raw) < 10):
            raise self.fault(element, f"{key} is {excerpt(raw)!r}; it must be a whole number")
        return int(raw)

    def truth(self, element: Xml.Element, key: str) -> bool:
        """The attribute `key` as true or false."""
        raw = self.text(element, key)
        if raw not in ("true", "false"):
            raise self.fault(element, f"{key} is {excerpt(raw)!r}; it must be true or false")
        return raw == "true"

    def called(self, element: Xml.Element) -> str | None:
        """What the yard calls an element of ours, if it has a name."""
        raw = element.get("name")
        name = None if raw is None else short_text(raw)
        if raw is not None and name is None:
            raise self.fault(
                element, f"name is {excerpt(raw)!r}; it must be at most {LONGEST_NAME} printable characters"
            )
        return name

    def named(self, element: Xml.Element) -> int:
        """The number that is the element's name in railML."""
        return self.whole(self.inner(element, "name"), "name")

    def fault(self, element: Xml.Element, sentence: str) -> InputError:
        """The fault of an element, which is called by its name and identifier."""
        told = element.get("id") or element.get("number") or element.get("netElementRef") or ""
        name = f"{local(element)} {excerpt(told)}" if told and told.isprintable() else local(element)
        return InputError(f"{self.file}: {name}: {sentence}")

    @property
    def ignored(self) -> tuple[str, ...]:
        """What stands in the file and is not read, each once with how often: 'speeds (1)'."""
        counts = Counter(self._unknown(self.root))
        return tuple(f"{name} ({count})" for name, count in counts.items())

    def _unknown(self, element: Xml.Element) -> Iterator[str]:
        for child in element:
            namespace, _, name = child.tag[1:].rpartition("}")
            if self.is_known(child):
                yield from self._unknown(child)
            else:
                yield name if namespace == self.namespace else f"{name} of {namespace or 'no namespace'}"


def local(element: Xml.Element) -> str:
    """The name of an element without its namespace."""
    return element.tag.rpartition("}")[2]


def railml_tree(text: str, file: str) -> RailmlTree:
    """The tree of the file's `text`; `InputError` for what is no XML or no railML 3."""
    if "<!DOCTYPE" in text or "<!ENTITY" in text:
        raise InputError(f"{file}: it declares a document type, which railML does not have; take it out")
    try:
        root = Xml.fromstring(text.encode("utf-8"))
    except (Xml.ParseError, ValueError, LookupError) as error:
        raise InputError(f"{file}: this is not valid XML: {excerpt(str(error), 200)}; correct the file there") from None
    namespace, _, name = root.tag[1:].rpartition("}")
    if name != "railML" or not namespace.startswith(RAILML_3):
        raise InputError(f"{file}: its root is {excerpt(root.tag)}; it must be railML of {RAILML_3}x")
    version = root.get("version", "3.")
    if not version.startswith("3."):
        raise InputError(f"{file}: version is {excerpt(version)!r}, but its namespace is that of railML 3; correct one")
    waiting = [(root, 0)]
    while waiting:  # no recursion: the tree may be deeper than Python's stack
        element, depth = waiting.pop()
        if depth > DEEPEST:
            raise InputError(f"{file}: its elements are nested too deeply; at most {DEEPEST} levels are allowed")
        waiting += [(child, depth + 1) for child in element]
    return RailmlTree(root, file, namespace)
