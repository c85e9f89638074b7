"""railML: written and read again equal, foreign elements told, every fault one sentence."""

from __future__ import annotations

import random
import re
from dataclasses import replace

import pytest

from plant_models.hump import HumpGraph, Retarder
from plant_models.library.hump_entry import HumpEntry, hump_names, load_hump
from synth.configuration.railml.read import from_railml
from synth.configuration.railml.write import to_railml
from synth.faults.input_error import InputError
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
    for seed in range(100):
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


def test_changed_files_are_read_or_told_in_one_sentence() -> None:
    rng, text = random.Random(4), small()
    told, lines = 0, text.splitlines(keepends=True)
    for _ in range(1000):
        changed = list(lines)
        for _ in range(rng.randint(1, 3)):
            place = rng.randrange(1, len(changed))
            match rng.randrange(4):
                case 0:
                    del changed[place]
                case 1:
                    changed.insert(place, changed[rng.randrange(1, len(changed))])
                case 2:
                    changed[place] = re.sub(
                        r'"[^"]*"',
                        f'"{rng.choice(("", "1", "-3.5", "nan", "ne_1_left", "&#7;"))}"',
                        changed[place],
                        count=rng.randint(1, 3),
                    )
                case _:
                    cut = rng.randrange(len(changed[place]))
                    changed[place] = changed[place][:cut] + rng.choice('<>&"x9') + changed[place][cut + 1 :]
        sentence = fault_of("".join(changed))
        if sentence:
            told += 1
            assert sentence.startswith("x.railml: ")
            assert sentence.isprintable()
    assert 600 < told < 1000
