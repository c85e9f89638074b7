"""A railML file says much of a hump twice, or in words that could also mean otherwise: all of it must agree.

What was read decides what the file has to say: the hump is written anew, and each element of the file must be one of
those, with the same attributes, and none may be lacking. So whatever railML gives a meaning to is read as it is meant,
or refused: a stretch that is turned round, a gap between two grades, a joint that was moved, a thing on an edge that is
not there. Identifiers are free. Attributes of railML that are never written are not read, which is told.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Final, NamedTuple
from xml.etree import ElementTree as Xml

from plant_models.library.hump_entry import HumpEntry
from synth.frame.faults import InputError
from synth.hump.railml.tree import OWN, RAILML, RailmlTree, local, net_relation
from synth.hump.railml.write import railml_of
from tuning_tables.errors import excerpt

FREE: Final = ("id", "language")
"""Attributes that mean nothing for a hump."""

ONLY: Final = ("keepsOrientation", "applicationDirection", "positionOnA", "positionOnB", "navigability", "curveType")
"""Attributes of which this program can read one value alone."""

DIGITS: Final = 6
"""Numbers agree to a micrometre: a place may be the sum of lengths."""


class Said(NamedTuple):
    """What an element says, equal for what means the same: its name, attributes, and what is in it, both sorted."""

    name: str
    attributes: tuple[tuple[str, str], ...]
    inner: tuple[Said, ...]


@dataclass(frozen=True)
class Sayings:
    """What the elements of a `tree` say. `edges`: what the writer calls the edges, by their identifiers in the tree;
    `relations` likewise; `keys`: (element, attribute) of all that the writer writes, None: all are."""

    tree: RailmlTree
    edges: Mapping[str, str]
    relations: Mapping[str, str]
    keys: frozenset[tuple[str, str]] | None

    @classmethod
    def of(cls, tree: RailmlTree, edges: Mapping[str, str], keys: frozenset[tuple[str, str]] | None) -> Sayings:
        """Those of `tree`."""
        ends = ((each.get("id", ""), tree.ends(each)) for each in tree.every("netRelation"))
        relations = {name: net_relation(edges.get(a, ""), edges.get(b, "")) for name, (a, b) in ends}
        return cls(tree, edges, relations, keys)

    def all(self) -> list[tuple[Xml.Element, Said]]:
        """Every element that is read, with what it says; that of ours is told without what is in it, which follows."""
        return [(each, self.of_element(each, deep=element_name(each) != "rs:hump")) for each in self.tree.told]

    def of_element(self, element: Xml.Element, deep: bool = True) -> Said:
        """What one element says."""
        read = [key for key in element.attrib if key not in FREE and self.is_read(element, key)]
        attributes = tuple(sorted((key, self.value(key, element.get(key, ""))) for key in read))
        inner = (self.of_element(child) for child in element if deep and self.tree.is_known(child))
        return Said(element_name(element), attributes, tuple(sorted(inner)))

    def is_read(self, element: Xml.Element, key: str) -> bool:
        """Whether an attribute is: all of our elements, and those of railML that the writer writes."""
        return element_name(element).startswith("rs:") or self.keys is None or (local(element), key) in self.keys

    def unread(self) -> Iterator[str]:
        """The attributes of railML that are not read."""
        for top in self.tree.told:
            for each in top.iter() if element_name(top) != "rs:hump" else ():
                if self.tree.is_known(each):
                    names = (key.rpartition("}")[2] for key in each.attrib if key not in FREE)
                    yield from (f"{key} of {local(each)}" for key in names if not self.is_read(each, key))

    def value(self, key: str, raw: str) -> str:
        """The value of an attribute in a form that is equal for equal values."""
        if key in ("netElementRef", "ref"):
            return self.edges.get(raw, f"{raw}, which is none of the edges of the hump")
        if key == "netRelationRef":
            return self.relations.get(raw, f"{raw}, which is no netRelation")
        try:
            return f"{round(float(raw), DIGITS) + 0.0:.12g}"
        except ValueError:
            return " ".join(raw.split())


def element_name(element: Xml.Element) -> str:
    """The name of an element, 'rs:' ahead of those of our namespace."""
    return f"rs:{local(element)}" if element.tag.startswith(f"{{{OWN}}}") else local(element)


def require_agreement(tree: RailmlTree, hump: HumpEntry, edges: Mapping[str, str]) -> tuple[str, ...]:
    """`InputError` for an element of `tree` that does not say what `hump`, which was read from it, says.

    `edges`: see `Sayings`. Returned: attributes of railML that are not read, with how often: 'slope of signalIS (2)'.
    """
    root = railml_of(hump)
    keys = frozenset((local(each), key) for each in root.iter() for key in each.attrib)
    names = {name: name for name in edges.values()}
    wanted = Sayings.of(RailmlTree(root, tree.file, RAILML), names, None).all()
    sayings = Sayings.of(tree, edges, keys)
    found = sayings.all()
    missing = Counter(said for _, said in wanted)
    missing.subtract(Counter(said for _, said in found))
    for element, said in found:
        if missing[said] < 0:
            rest = [(like, other) for like, other in wanted if missing[other] > 0 and other.name == said.name]
            raise tree.fault(element, contradiction(said, nearest(element, said, rest)))
    lacking = next((said for _, said in wanted if missing[said] > 0), None)
    if lacking is not None:
        raise InputError(f"{tree.file}: there is no {words(lacking)}, but the rest of the file needs it; add it")
    return tuple(f"{name} ({count})" for name, count in Counter(sayings.unread()).items())


def nearest(element: Xml.Element, said: Said, rest: Sequence[tuple[Xml.Element, Said]]) -> Said | None:
    """Of what is lacking, that with the identifier or the number of `element`, else that with the most in common."""

    def alike(each: tuple[Xml.Element, Said]) -> tuple[bool, bool, int]:
        like, other = each
        same_id = like.get("id") == element.get("id") is not None
        same_number = like.get("number") == element.get("number") is not None
        return same_id, same_number, len(set(flat(said)) & set(flat(other)))

    return max(rest, key=alike)[1] if rest else None


def flat(said: Said) -> Iterator[tuple[str, str, str]]:
    """(element, attribute, value) of all that is said."""
    yield from ((said.name, key, value) for key, value in said.attributes)
    for each in said.inner:
        yield from flat(each)


def contradiction(said: Said, wanted: Said | None) -> str:
    """How what an element says differs from what it has to say; None: nothing is lacking that it could say."""
    if wanted is None:
        return "the rest of the file does not need it, or has it already; take it out, or correct what it belongs to"
    told, asked = Counter(flat(said)), Counter(flat(wanted))
    for name, key, value in (told - asked).elements():
        of = within(name, said)
        other = next((each for each in (asked - told).elements() if each[:2] == (name, key)), None)
        if other is None:
            return f"{of}{key} is {excerpt(value)}; this cannot be read there; take it out"
        if key in ONLY:
            return f"{of}{key} is {excerpt(value)}; only {other[2]} can be read"
        return f"{of}{key} is {excerpt(value)}; by the rest of the file it must be {excerpt(other[2])}"
    for name, key, value in (asked - told).elements():
        return f"{within(name, said)}{key} is missing; it must be {excerpt(value)}"
    return "what is in it cannot be read; take out what is there twice or does not belong there"


def within(name: str, said: Said) -> str:
    """How the element `name` is called in a sentence on the one that it stands in, or is."""
    return "" if name == said.name else f"in {name}: "


def words(said: Said) -> str:
    """An element by its name and its first attributes."""
    few = ", ".join(f"{key} {value}" for _, key, value in list(flat(said))[:6])
    return f"{said.name} ({excerpt(few, 160)})" if few else said.name
