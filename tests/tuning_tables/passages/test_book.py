"""Books of tables for point sensors: every bit comes back, the choice takes no risk; the page of their format is
right.
"""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from scripts.format_page import updated
from tests.controller_code.passage_tables import passage_book, passage_table
from tests.controller_code.sample_book import FOUR_AXLES
from tests.controller_code.sample_book import table_of as of_lines
from tests.effort import sized
from tests.st_files import passage_st_files
from tests.tuning_tables.passages.made_tables import LIMITS, passage_tables, table_of, tracking
from tuning_tables import (
    ControllerTable,
    CutId,
    Generator,
    InvalidTable,
    OtherKind,
    PassageTable,
    Status,
    TableBook,
    from_json,
    read_any_book,
    read_book,
    to_json,
    write_book,
)
from tuning_tables.document import KINDS
from tuning_tables.passages.exports import passage_c_files
from tuning_tables.passages.golden_passages import golden_selections
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.passages.rule import held_by
from tuning_tables.passages.sensor_layout import DecidesOn
from tuning_tables.programs.at_pulse import at_pulse
from tuning_tables.programs.held import NONE
from tuning_tables.programs.tracker import begin_cut, believed_passage

BINDER = Generator("binder", "1", "0" * 64)
FIRST, EVERY = table_of(), replace(table_of(DecidesOn.EVERY_AXLE), id="every", validated=None)


@given(st.lists(passage_tables(), min_size=1, max_size=3, unique_by=lambda table: table.id))
@settings(derandomize=True, max_examples=sized(6, 25), deadline=None, suppress_health_check=list(HealthCheck))
def test_json_and_book_hold_the_same_bits(tmp_path: Path, originals: list[PassageTable]) -> None:
    path = tmp_path / "book.h5"
    write_book([from_json(to_json(table), PassageTable) for table in originals], path, BINDER)
    content = path.read_bytes()
    from_book = read_any_book(path)
    assert list(from_book) == originals
    write_book(from_book, path, BINDER)
    assert path.read_bytes() == content


def test_a_book_is_read_by_others(tmp_path: Path) -> None:
    write_book([FIRST, EVERY], tmp_path / "book.h5")
    with h5py.File(tmp_path / "book.h5") as book:
        assert book.attrs["kind"] == "passages"
        speeds = book["passage_switching_m_s"][:]
        assert speeds.shape == (2, len(EVERY.passages), 3, 2)
        assert np.array_equal(speeds[0, :4], FIRST.switching_m_s)
        assert np.isnan(speeds[0, 4:]).all()
        assert book["passage_switching_m_s"].attrs["units"] == "m/s"
        assert book["passages"][:].tolist() == [4, len(EVERY.passages)]
        assert book["sensors_decides_on"][:].tolist() == [b"first_axle", b"every_axle"]


def test_the_two_kinds_are_kept_apart(table: ControllerTable, tmp_path: Path) -> None:
    with pytest.raises(InvalidTable, match="of one kind: write two books"):
        write_book([table, FIRST], tmp_path / "book.h5")
    write_book([FIRST], tmp_path / "passages.h5")
    with pytest.raises(OtherKind, match=r"passages\.h5: .* is passages .* kind is lines\.$"):
        read_book(tmp_path / "passages.h5")
    write_book([table], tmp_path / "lines.h5")
    assert read_any_book(tmp_path / "lines.h5") == read_book(tmp_path / "lines.h5") == (table,)


def variant(name: str, target_m_s: float, mass_t: float = 22.0) -> PassageTable:
    return replace(FIRST, id=name, target_speed_m_s=target_m_s, cut=replace(FIRST.cut, mass_t=mass_t))


BOOK = PassageBook((variant("b", 3.0), variant("a", 2.0), variant("light", 2.5, 21.0), variant("c", 4.0)))


@pytest.mark.requirement("CHOICE-01")
@pytest.mark.parametrize(
    ("category", "axles", "commanded", "status", "number"),
    [
        ("Л", 4, 2.0, Status.TUNED, 1),
        ("Л", 4, 3.0, Status.TUNED, 0),
        ("Л", 4, 2.9, Status.SLOWER, 1),
        ("Л", 4, 3.5, Status.SLOWER, 0),
        ("Л", 4, 99.0, Status.SLOWER, 3),
        ("Л", 4, 1.9, Status.NO_TARGET, None),
        ("Л", 4, float("nan"), Status.NO_TARGET, None),
        ("Л", 4, 1e300, Status.NO_TARGET, None),
        ("Л", 6, 3.0, Status.NO_CLASS, None),
        ("С", 4, 3.0, Status.NO_CLASS, None),
    ],
)
def test_the_choice_never_aims_at_more_than_is_commanded(
    category: str, axles: int, commanded: float, status: Status, number: int | None
) -> None:
    choice = BOOK.choose(category, axles, commanded)
    assert (choice.status, choice.number) == (status, number)
    assert choice.table == (None if number is None else BOOK.tables[number])
    assert BOOK.shadowed() == (BOOK.tables[2],)


@pytest.mark.parametrize(
    "tables",
    [
        (),
        (FIRST, FIRST),
        (FIRST, EVERY),
        (FIRST, replace(FIRST, id="other", retarder=replace(FIRST.retarder, dead_band_kpa=9.0))),
        (FIRST, replace(FIRST, id="other", cut=replace(FIRST.cut, category="own", category_number=None)),
         replace(FIRST, id="third", cut=replace(FIRST.cut, category="own", category_number=17))),
        (variant("tiny", 1e-300),),
    ],
)  # fmt: skip
def test_tables_that_make_no_book_are_refused(tables: tuple[PassageTable, ...]) -> None:
    with pytest.raises(InvalidTable):
        PassageBook(tables)


MADE_BOOK = passage_book()
SPEEDS = st.floats(0.0, 6.0) | st.floats(width=32) | st.sampled_from([2.5, 3.5, float(np.nextafter(3.5, 9.0))])


@given(SPEEDS)
def test_it_is_the_choice_of_a_book_of_tables_with_lines(speed_m_s: float) -> None:
    """Of other degrees, so that no lines between them are possible."""
    made = [
        replace(of_lines(each.id, "Л", each.cut.mass_t, FOUR_AXLES, each.target_speed_m_s, 5, 1 + place), cut=each.cut)
        for place, each in enumerate(MADE_BOOK.tables[:3])
    ]
    due = TableBook(tuple(made)).choose("Л", 4, speed_m_s)
    found = PassageBook(MADE_BOOK.tables[:3]).choose("Л", 4, speed_m_s)
    assert (found.status, () if found.number is None else (found.number,)) == (due.status, due.numbers)


def test_golden_selections_reach_every_status() -> None:
    rows = golden_selections(MADE_BOOK)
    assert {row.status for row in rows} == {Status.TUNED, Status.SLOWER, Status.NO_CLASS, Status.NO_TARGET}
    assert {row.table for row in rows} == {0, 2, 3, 4, 5, None}


def test_a_category_without_number_is_not_exported() -> None:
    unnumbered = replace(passage_table(), cut=CutId("mine", 23.0, FOUR_AXLES))
    for write in (passage_c_files, passage_st_files):
        with pytest.raises(InvalidTable, match="has no number, but controller code chooses by number"):
            write(PassageBook((unnumbered,)))


PAGE = (Path(__file__).parents[3] / "docs" / "reference" / "table-format.md").read_text(encoding="utf-8")
SECTION = PAGE.partition("## Decisions at sensor passages")[2].partition("## HDF5 book")[0]


def block(language: str) -> str:
    """The one block of code in `language` of the section."""
    (found,) = re.findall(rf"^```{language}\n(.*?)^```$", SECTION, re.MULTILINE | re.DOTALL)
    return str(found)


def example() -> PassageTable:
    return from_json(block("json").encode("utf-8"), PassageTable, source="the page")


def test_the_example_is_a_table_and_the_members_are_those_declared() -> None:
    assert to_json(example()) == block("json").encode("utf-8")
    assert PAGE.count("<!-- members: ") == len(KINDS)
    assert updated(PAGE) == PAGE


def test_the_worked_steps_are_those_of_the_code() -> None:
    table, state = example(), np.zeros(6, np.float32)
    begin_cut(state)
    held = held_by(table)
    steps = [row.split(" | ") for row in re.findall(r"^\| (\d.*\d) \|$", SECTION, re.MULTILINE)]
    assert len(steps) == 7
    for since, sensor, over, speed, heard, passage, stage, wanted in steps:
        v = float(np.float32(0.2) / np.float32(float(over)))
        assert f"{v:.3f}" == speed
        copy = state.copy()
        found = believed_passage(held, copy, int(sensor), float(since), v)
        assert found == (NONE if heard == "none" else int(heard))
        decided = NONE if found == NONE else int(held.deciding[found])
        assert decided == (NONE if passage == "none" else int(passage))
        assert at_pulse(held, state, int(sensor), float(since), float(over), int(stage), True) == int(wanted)


@given(st.floats(0.0, 20.0), st.floats(0.4, 14.9), st.floats(0.4, 14.9), st.floats(0.0, 60.0))
@settings(derandomize=True, max_examples=sized(75, 300), deadline=None)
def test_what_follows_is_what_the_page_computes(elapsed: float, before: float, now: float, way: float) -> None:
    a, d, e, f = (np.float32(limit) for limit in LIMITS[2:])
    # Written numbers are float32 numbers; numpy keeps them so beside float32 operands.
    names: dict[str, Any] = {"u": np.float32(before), "v": np.float32(now), "T": np.float32(elapsed)}
    names |= {"a": a, "d": d, "e": e, "f": f, "s_p": np.float32(way), "s_h": np.float32(0.0)}
    exec(block("python"), names)
    state = np.array([0.0, before, elapsed, NONE, 0.0, 0.0], np.float32)
    found = believed_passage(tracking(np.array([0.0, way]), np.array([0, 1])), state, 1, 0.0, now)
    assert (found == 1) == bool(names["follows"])
