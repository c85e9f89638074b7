"""Hump files: every fault with its line, mutations, and the schema."""

from __future__ import annotations

import copy
import random
import tomllib
from collections.abc import Iterator
from typing import Any

import jsonschema
import pytest

from plant_models.library.hump_entry import hump_from, hump_names
from plant_models.library.hump_schema import hump_schema
from plant_models.library.library import BUILT_IN, HUMPS, TypeFileError
from plant_models.library.toml_lines import line_of, places_of
from tests.effort import sized
from tests.plant_models.hump.random_humps import SMALL, read


def test_a_row_counts_before_its_type() -> None:
    graph = read(SMALL.replace("left = { to = 401 }", "left = { to = 401, length_m = 70, fouling_m = 30 }")).graph
    switch = graph.switches[0]
    assert (switch.left.edge.length_m, switch.left.fouling_m, switch.left.turn_deg) == (70.0, 30.0, 4.73)
    assert (switch.right.edge.length_m, switch.right.fouling_m) == (60.0, 26.0)
    assert (switch.throw_s, switch.relay_s) == (0.6, 0.2)
    (retarder,) = graph.retarders
    assert retarder.zones_m == ((0.0, 12.475), (14.475, 26.95))  # those of the library's position
    assert [(c.from_m, c.to_m, c.turn_deg) for c in retarder.next.curves] == [(30.0, 40.0, -14.0)]
    assert graph.route(201, 2).free_to_m == 42.0 + 60.0 + 280.0


BOOK, STD = 'book = "b.h5"\n', "exit_std_m_s = 0.3\n"


def with_controllers(of_type: str, of_row: str) -> str:
    """`SMALL`, its retarder of a type that has these keys of controllers, its row with those."""
    typed = SMALL.replace("[type.track]", f"[type.bunch]\n{of_type}\n[type.track]")
    return typed.replace("exit_std_m_s = 0.15\n", of_row + 'type = "bunch"\n')


@pytest.mark.parametrize(
    ("of_type", "of_row", "told"),
    [(STD, BOOK, ("b.h5", None)), (BOOK, STD, (None, 0.3)), (STD, "", (None, 0.3)), (BOOK + STD, "", None)],
)
def test_the_controller_of_a_row_counts_before_that_of_its_type(
    of_type: str, of_row: str, told: tuple[str | None, float | None] | None
) -> None:
    if told is None:
        with pytest.raises(TypeFileError, match=r"line 16: type.bunch: book and exit_std_m_s are both given"):
            read(with_controllers(of_type, of_row))
        return
    (retarder,) = read(with_controllers(of_type, of_row)).graph.retarders
    assert (retarder.book, retarder.exit_std_m_s) == told


def test_the_accuracy_of_a_retarder_has_its_origin() -> None:
    (value,) = (value for value in read(SMALL).provenance if value.key.endswith("exit_std_m_s"))
    assert (value.value, value.unit, value.confidence, value.assumed) == (0.15, "m/s", "L", True)


def test_every_number_has_its_origin() -> None:
    told = {value.key: (value.value, value.source, value.confidence) for value in read(SMALL).provenance}
    assert told["type.turnout.throw_s"] == (0.6, "a data sheet", "H")
    assert told["type.turnout.left.turn_deg"] == (4.73, "engineering judgement: a test", "L")
    assert told["hump.retarder.0.next.curves"][0] == (30.0, 40.0, -14.0)
    assert told["type.track.next.grade_permille"][0] == (0.0, 1.0, 200.0, 0.0)
    leaves = list(numbers_in(tomllib.loads(SMALL)))
    assert sum(1 if isinstance(value, float) else len(value) for value, _, _ in told.values()) == len(leaves)


def numbers_in(tree: Any) -> Iterator[float]:
    """Every number but the names of elements, by plain recursion."""
    if isinstance(tree, dict):
        for name, value in tree.items():
            named = name in ("version", "number", "to", "track", "leads") and not isinstance(value, dict)
            yield from () if named else numbers_in(value)
    elif isinstance(tree, list):
        for value in tree:
            yield from numbers_in(value)
    elif isinstance(tree, int | float):
        yield float(tree)


FAULTS = [
    ('format = "hump"', 'format = "humps"', 1, 'format is "humps"; this program reads hump files of format "hump"'),
    ("version = 1", "version = 2", 2, "version is 2; this program reads"),
    ("version = 1", "version = true", 2, "version is True"),
    ('title = "Small"', "title = 3", 3, "title must be"),
    ("relay_s = 0.2", "rely_s = 0.2", 11, "type.turnout: unknown key rely_s; did you mean relay_s?"),
    ("relay_s = 0.2\n", "", 21, "switch 1: key relay_s is missing"),
    ("relay_s = 0.2", "relay_s = '0.2'", 11, "type.turnout: relay_s is '0.2'; it must be a finite number"),
    ("relay_s = 0.2", "relay_s = inf", 11, "relay_s is inf"),
    ("relay_s = 0.2", "relay_s = -0.2", 11, "relay_s is -0.2; it must be a finite number from 0 to 5"),
    ('confidence = "H"', 'confidence = "HH"', 10, "confidence is 'HH'; it must be one of H, M-H"),
    ("value = 0.6, ", "", 10, "key throw_s.value is missing"),
    ("length_m = 300", "length_m = -300", 16, "type.track: next: length_m is -300.0"),
    ("[200, 0]", "[400, 0]", 16, "grade_permille: the one from 400 m ends at 300 m"),
    ("[0, 1], [200", "[0, 61], [200", 16, "from -60 to 60"),
    ("leads = [201]", "leads = [202]", 19, "there is no signal 202"),
    ("leads = [201]", "leads = 201", 19, "leads must be a list of whole numbers"),
    ("leads = [201]", "led = [201]", 19, "unknown key led; did you mean leads?"),
    ("to = 1, length_m = 42", "to = 1, length_m = 5", 20, "signal 201: its insulated section ends"),
    ("number = 1,", "number = 200,", 22, "switch 200: the number is not in its group"),
    ("number = 1,", "number = 1.0,", 22, "switch[0]: number is 1.0; it must be a whole number"),
    ("to = 602", "to = 603", 22, "switch 1: an edge leads to 603, but there is no such element"),
    ("to = 602", "to = 1", 22, "switch 1: the way from it comes back to it"),
    ("to = 602", "to = 401", 22, "switch 1: both branches lead to retarder 401; a switch must have two exits"),
    (", right = { to = 602 }", "", 22, "switch 1: right: key to is missing; a switch must have two exits"),
    (', type = "turnout"', ', type = "turnouts"', 22, "did you mean turnout?"),
    ('{ number = 601, type = "track", track = 1 },\n', "", 28, "retarder 401: an edge leads to 601"),
    ("track = 1 }", "track = 2 }", 26, "section 602: track 2 ends here and in section 601"),
    ("number = 602", "number = 601", 26, "section[0] has the number 601, too"),
    ("standing_m = 20", "standing_m = 301", 26, "section 602: standing_m is 301"),
    ("track = 2, ", "", 26, "section 602: track is missing"),
    ('position = "knp-5-bunch"', 'position = "knp"', 31, "'knp' is not in the library; did you mean knp-5-bunch?"),
    ("exit_joint_m = 28", "exit_joint_m = 20", 33, "retarder 401: exit_joint_m is 20; it must not be before the end"),
    ("exit_joint_m = 28", "exit_joint_m = 41", 29, "retarder 401: its insulated section ends 41 m behind it"),
    ("[[30, 40, -14]]", "[[30, 41, -14]]", 34, "curves: one ends at 41 m; it must not be beyond"),
    ("[[30, 40, -14]]", "[[30, 40]]", 34, "it must be a list of [from_m, to_m, turn_deg]"),
    ("exit_std_m_s = 0.15\n", "", 29, "retarder 401: nothing controls it; give book, the file of its tables, or exit"),
    ("= 0.15\n", "= 0.15\nbook = 'b.h5'\n", 36, "retarder 401: book and exit_std_m_s are both given; give the one"),
    ("exit_std_m_s = 0.15", "exit_std_m_s = 1.1", 35, "retarder 401: exit_std_m_s is 1.1; it must be a finite number"),
    ("exit_std_m_s = 0.15", "exit_std_m_s = -0.1", 35, "it must be a finite number from 0 to 1"),
    ("[type.track]", "[type.spare]\n[type.track]", 15, "no element names the type spare"),
]  # fmt: skip
"""What is changed into what, the line that the message tells, and words of it."""


@pytest.mark.parametrize(("old", "new", "line", "words"), FAULTS)
def test_a_fault_is_told_with_file_line_element_and_value(old: str, new: str, line: int, words: str) -> None:
    assert old in SMALL
    with pytest.raises(TypeFileError) as caught:
        read(SMALL.replace(old, new))
    sentence = str(caught.value)
    assert sentence.startswith(f"small.toml, line {line}: ")
    assert words in sentence
    assert "\n" not in sentence


LINES = """\
a = 1 # [no header]
b = "x = [1]\\"" # =
c = '''
[no header]
'''
"d.e" = { f = 1, 'g h' = [1, [2,
  3], { i = 4 }] }

[j . "k"]
l = 1979-05-27 07:32:00
m.n = [
  # one
  { o = 1 },

  { o = 2 }, ]
[[p]]
q = \"\"\"
two \\\"\"\"quoted\"\"\"\"\"
r = 1
[[p]]
r = 2
[[p.s]]
t = 1
[[p.s]]
t = 2
"""


def test_lines_of_places() -> None:
    assert places_of(LINES) == {
        ("a",): 1, ("b",): 2, ("c",): 3, ("d.e",): 6, ("d.e", "f"): 6, ("d.e", "g h"): 6, ("d.e", "g h", 0): 6,
        ("d.e", "g h", 1): 6, ("d.e", "g h", 1, 0): 6, ("d.e", "g h", 1, 1): 7, ("d.e", "g h", 2): 7,
        ("d.e", "g h", 2, "i"): 7, ("j",): 9, ("j", "k"): 9, ("j", "k", "l"): 10, ("j", "k", "m"): 11,
        ("j", "k", "m", "n"): 11,
        ("j", "k", "m", "n", 0): 13, ("j", "k", "m", "n", 0, "o"): 13, ("j", "k", "m", "n", 1): 15,
        ("j", "k", "m", "n", 1, "o"): 15, ("p",): 16, ("p", 0): 16, ("p", 0, "q"): 17, ("p", 0, "r"): 19, ("p", 1): 20,
        ("p", 1, "r"): 21, ("p", 1, "s"): 22, ("p", 1, "s", 0): 22, ("p", 1, "s", 0, "t"): 23, ("p", 1, "s", 1): 24,
        ("p", 1, "s", 1, "t"): 25,
    }  # fmt: skip
    tomllib.loads(LINES)
    assert line_of(LINES, ("p", 1, "s", 7, "u")) == 22
    assert line_of(LINES, ("unknown",)) == 1


TREES = sized(500, 2000)


def changed_trees(seed: int, count: int) -> Iterator[dict[str, Any]]:
    """Trees of humps with one to three values taken away, doubled or replaced."""
    rng = random.Random(seed)
    humps = [tomllib.loads(SMALL), tomllib.loads(BUILT_IN.file(HUMPS, "dumper").text)]
    spare: tuple[object, ...] = (
        *(0, 1, -1, 3.5, 1e308, float("nan"), float("inf"), True, "", "x", "turnout", "\x00", 2**62, 602, 603, 201),
        *([], [[]], {}, {"value": 1}, {"type": "track"}, [1, 2], [[0, 1], [2, 3]], [[0, 9, 4.0]]),
    )
    for _ in range(count):
        tree = copy.deepcopy(rng.choice(humps))
        for _ in range(rng.randint(1, 3)):
            places = list(every_place(tree))
            holder, key = rng.choice(places)
            match rng.randrange(3):
                case 0:
                    del holder[key]
                case 1 if isinstance(holder, list):
                    holder.insert(key, copy.deepcopy(holder[key]))
                case _:
                    holder[key] = copy.deepcopy(rng.choice(spare))
            if not tree:
                break
        yield tree


def every_place(tree: Any) -> Iterator[tuple[Any, Any]]:
    items = tree.items() if isinstance(tree, dict) else enumerate(tree) if isinstance(tree, list) else ()
    for key, value in list(items):
        yield tree, key
        yield from every_place(value)


def test_what_the_schema_refuses_the_reader_refuses_too() -> None:
    schema = hump_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    for name in hump_names():
        validator.validate(tomllib.loads(BUILT_IN.file(HUMPS, name).text))
    assert validator.is_valid(tomllib.loads(SMALL))
    assert not validator.is_valid(tomllib.loads(SMALL + BOOK))
    refused = sound = 0
    for tree in changed_trees(1, TREES // 5):
        if validator.is_valid(tree):
            sound += 1
            continue
        refused += 1
        with pytest.raises(TypeFileError):
            hump_from(tree, "", "changed", "changed.toml")
    assert refused > TREES // 20
    assert sound > TREES // 40


def test_changed_trees_are_read_or_told_in_sentences() -> None:
    told = 0
    for tree in changed_trees(2, TREES):
        sentences = faults_of(tree)
        told += bool(sentences)
        for sentence in sentences:
            assert sentence.startswith("changed.toml, line 1: ") or sentence.endswith(" more faults")
            assert sentence.isprintable()
    assert TREES // 2 < told < TREES


def faults_of(tree: dict[str, Any]) -> tuple[str, ...]:
    try:
        hump_from(tree, "", "changed", "changed.toml")
    except TypeFileError as fault:
        return fault.sentences
    return ()


def test_all_rows_at_fault_are_told_each_with_its_line() -> None:
    text = SMALL.replace("number = 401", "number = 999").replace("number = 201", "nummer = 201")
    with pytest.raises(TypeFileError) as caught:
        read(text)
    lines = [int(sentence.split("line ")[1].split(":")[0]) for sentence in caught.value.sentences]
    assert ["nummer" in text.splitlines()[line - 1] for line in lines] == [True, False]
    assert text.splitlines()[lines[1] - 1] == "number = 999"


def test_a_mistake_of_many_rows_does_not_fill_the_screen() -> None:
    rows = "".join(f"[[hump.retarder]]\nnumber = {number}\n" for number in range(402, 472))
    with pytest.raises(TypeFileError) as caught:
        read(SMALL + rows)
    *told, last = caught.value.sentences
    assert len(told) == 50
    assert last.endswith(" more faults")
