"""railML: written and read again equal, foreign elements told, every fault one sentence."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import replace
from xml.etree import ElementTree as Xml

import pytest

from plant_models.hump import HumpGraph, Retarder
from plant_models.library.hump_entry import HumpEntry, hump_names, load_hump
from synth.frame.faults import InputError
from synth.hump.railml.read import from_railml
from synth.hump.railml.tree import local
from synth.hump.railml.write import to_railml
from tests.plant_models.hump.random_humps import random_hump, small_hump, small_vertices


def written(hump: HumpEntry) -> str:
    return to_railml(hump).decode()


def small() -> str:
    return written(HumpEntry("small", "Small", ("One note.",), small_hump()))


@pytest.mark.parametrize("name", hump_names())
def test_a_hump_of_the_library_comes_back_equal(name: str) -> None:
    hump = load_hump(name)
    read, ignored = from_railml(written(hump), name, "x.railml")
    assert (read.graph, read.title, read.notes, ignored) == (hump.graph, hump.title, hump.notes, ())
    assert to_railml(read) == to_railml(hump)


def test_random_humps_come_back_equal() -> None:
    for seed in range(50):
        graph = random_hump(seed)
        read, ignored = from_railml(written(HumpEntry("random", "Random", (), graph)), "random", "x.railml")
        assert read.graph == graph
        assert ignored == ()


def test_books_and_aim_tables_come_back() -> None:
    changes = {"book": "b.h5", "exit_std_m_s": None, "aim_tables": ("a.json", "b.json")}
    vertices = [replace(v, **changes) if isinstance(v, Retarder) else v for v in small_vertices()]  # type: ignore[arg-type]  # of these fields
    graph = HumpGraph(tuple(vertices), (201,))
    read, _ = from_railml(written(HumpEntry("small", "Small", (), graph)), "small", "x.railml")
    assert read.graph == graph != small_hump()


def test_what_is_not_read_is_told() -> None:
    more = '<speeds><speedSection id="a"/></speeds><speeds/><lamp xmlns="urn:other"/><functionalInfrastructure>'
    text = small().replace("<functionalInfrastructure>", f"<functionalInfrastructure>{more}").replace(more, more[:-26])
    text = text.replace('<signalIS id="sig_201">', '<signalIS id="sig_201"><isTrainMovementSignal/>')
    read, ignored = from_railml(text, "small", "x.railml")
    assert read.graph == small_hump()
    assert ignored == ("speeds (2)", "lamp of urn:other (1)", "isTrainMovementSignal (1)")


FAULTS = [
    ('length="60.0"', 'length="-60.0"', "netElement ne_1_left: length_m is -60.0"),
    ('length="60.0"', 'length="sixty"', "length is 'sixty'; it must be a finite number"),
    ('length="60.0"', 'length="inf"', "length is 'inf'"),
    ('exitStd="0.15"', "", "retarder 401: nothing controls it; give book"),
    ('exitStd="0.15"', 'exitStd="0.15" book="b.h5"', "retarder 401: book and exit_std_m_s are both given"),
    ('exitStd="0.15"', 'exitStd="two"', "exitStd is 'two'; it must be a finite number"),
    ('exitStd="0.15"', 'exitStd="2"', "exit_std_m_s is 2.0; it must be a finite number from 0 to 1"),
    ('gradient="-45.0"', 'gradient="-61"', "netElement ne_201: grades: a grade is 61.0"),
    ('throw="0.6" ', "", "switch 1: the attribute throw is missing"),
    ('axleCounters="true"', 'axleCounters="yes"', "axleCounters is 'yes'; it must be true or false"),
    ('leads="201"', 'leads="202"', "there is no signal 202"),
    ('leads="201"', 'leads="crest"', "leads is 'crest'"),
    ("<rs:hump ", "<rs:humps ", "not valid XML"),
    ("https://www.railml.org/schemas/3.1", "https://www.railml.org/schemas/2013", "it must be railML of"),
    ("<railML", "<!DOCTYPE x [<!ENTITY a 'b'>]><railML", "it declares a document type"),
    ('netRelationRef="nr_ne_201_ne_1_left"', 'netRelationRef="nr"', "leftBranch names nr; there is no such"),
    ('<name name="1"', '<name name="one"', "name is 'one'; it must be a whole number"),
    ('<name name="1"', '<name name="3"', "switchIS 3: our namespace has no switch of this number"),
    ('type="clearancePoint"', 'type="virtualClearancePoint"', "there is no clearancePoint on ne_1_left"),
    ('<elementB ref="ne_601"', '<elementB ref="ne_999"', "it leads to ne_999, in which nothing begins"),
    ('<elementB ref="ne_601"', '<elementB ref="ne_401"', "both branches lead to retarder 401"),
    ('<rs:section number="601"', '<rs:section number="602"', "there are two of this number"),
]  # fmt: skip

LIBRARY_FAULTS = [
    ('<associatedNetElement netElementRef="ne_4_left"', '<associatedNetElement netElementRef="ne_4_leftx"',
     "netElementRef is 'ne_4_leftx'; there is no netElement with this id"),
    ('<rs:radar netElementRef="ne_401"', '<rs:radar netElementRef="ne_401x"', "netElementRef is 'ne_401x'"),
    ('posEnd="20.0"', 'posEnd="19.0"', "gradientCurve gc_ne_4_left_0: in associatedNetElement: posEnd is 19; by the"),
    ('keepsOrientation="true"', 'keepsOrientation="false"', "keepsOrientation is false; only true can be read"),
    ('keepsOrientation="true" ', "", "keepsOrientation is missing; it must be true"),
    ('applicationDirection="normal"', 'applicationDirection="reverse"', "only normal can be read"),
    ('type="axleCounter"', 'type="insulatedRailJoint"', "type is insulatedRailJoint; by the rest of the file it must"),
    ('zones="library"', 'zones="own"', "zones is own; by the rest of the file it must be library"),
    ('position="rnz-2m-park"', 'position="zzz"', "retarder 401: position 'zzz' is not in the library"),
    ("<rs:radar ", "<rs:lidar ", "lidar ne_4_left: the rest of the file does not need it"),
    ('version="3.1"', 'version="2.5"', "version is '2.5', but its namespace is that of railML 3"),
]  # fmt: skip


@pytest.mark.parametrize(("old", "new", "words"), LIBRARY_FAULTS)
def test_what_railml_gives_another_meaning_to_is_refused(old: str, new: str, words: str) -> None:
    text = written(load_hump("dumper"))
    assert old in text
    assert words in fault_of(text.replace(old, new, 1))


@pytest.mark.parametrize("kind", ["gradientCurve", "trainDetectionElement", "networkResource"])
def test_an_element_that_is_lacking_or_there_twice_is_refused(kind: str) -> None:
    tree = Xml.fromstring(written(load_hump("dumper")))
    parent, child = next((p, c) for p in tree.iter() for c in p if c.tag.endswith(f"}}{kind}"))
    parent.append(child)
    assert fault_of(Xml.tostring(tree, encoding="unicode"))
    parent.remove(child)
    parent.remove(child)
    assert fault_of(Xml.tostring(tree, encoding="unicode"))


def test_identifiers_are_free_and_attributes_that_are_not_read_are_told() -> None:
    text = re.sub(r"\b(ne|nr|gc|sig|fp|jt)_", r"other-\1-", small()).replace(
        '<switchIS id="sw', '<switchIS code="A" id="x'
    )
    read, ignored = from_railml(text, "small", "x.railml")
    assert read.graph == small_hump()
    assert ignored == ("code of switchIS (2)",)


SOURCES = {
    *(("switch", key) for key in ("throw", "relay", "leftTurn", "rightTurn")),
    *(("zone", key) for key in ("posBegin", "posEnd")),
    *(("retarder", key) for key in ("position", "exitStd", "zones")),
    *(("hump", "title"), ("note", "text"), ("gradientCurve", "gradient"), ("section", "standing")),
    *(("trainDetectionElement", "pos"),),  # a fouling point
}
"""(element, attribute) that alone tell something, so that a change of them is another hump."""


def kinds_of_attributes(tree: Xml.Element) -> Iterator[tuple[str, Xml.Element, str]]:
    """(name, element, attribute), once for each kind; a place is named by what stands there."""
    seen = set()
    parents = {child: parent for parent in tree.iter() for child in parent}
    for element in tree.iter():
        outer = element
        while outer in parents and not local(parents[outer]).endswith(
            ("s", "IS", "hump", "ructure", "logy", "try", "ML")
        ):
            outer = parents[outer]
        for key in tuple(element.attrib):
            if (kind := (local(outer), outer.get("type"), local(element), key)) not in seen:
                seen.add(kind)
                yield local(outer if local(element) == "spotLocation" else element), element, key


def test_each_kind_of_attribute_is_read_as_meant_refused_or_free() -> None:
    tree = Xml.fromstring(small())
    known = from_railml(small(), "small", "x.railml")[0]
    tried = 0
    for outer, element, key in kinds_of_attributes(tree):
        before = element.attrib[key]
        for now in (None, "zzz", changed_number(before)):
            element.attrib.pop(key) if now is None else element.set(key, now)
            text = Xml.tostring(tree, encoding="unicode")
            element.set(key, before)
            tried += 1
            try:
                read, ignored = from_railml(text, "small", "x.railml")
            except InputError:
                continue
            assert ignored == ()
            same = (read.graph, read.title, read.notes) == (known.graph, known.title, known.notes)
            assert same == ((outer, key) not in SOURCES), (outer, key, now)
            assert not same or key in ("id", "language", "version"), (outer, key, now)
    assert tried > 150


def changed_number(value: str) -> str:
    """A number that is somewhat more; what is none with another letter."""
    try:
        return repr(float(value) + 0.5)
    except ValueError:
        return f"{value}x"


@pytest.mark.parametrize(("old", "new", "words"), FAULTS)
def test_a_fault_is_told_in_one_sentence(old: str, new: str, words: str) -> None:
    text = small()
    assert old in text
    with pytest.raises(InputError) as caught:
        from_railml(text.replace(old, new, 1), "small", "x.railml")
    assert words in str(caught.value)
    assert str(caught.value).startswith("x.railml: ")
    assert "\n" not in str(caught.value)


def fault_of(text: str) -> str:
    try:
        from_railml(text, "small", "x.railml")
    except InputError as fault:
        return str(fault)
    return ""
