"""Books of tables for point sensors: every bit comes back, other kinds are refused, and the choice takes no risk."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.effort import sized
from tests.tuning_tables.passages.made_tables import passage_tables, table_of
from tuning_tables import (
    ControllerTable,
    Generator,
    InvalidTable,
    OtherKind,
    Status,
    read_any_book,
    read_book,
    write_book,
)
from tuning_tables.json_file import from_json, to_json
from tuning_tables.passages.passage_book import PassageBook
from tuning_tables.passages.passage_table import PassageTable
from tuning_tables.passages.sensor_layout import DecidesOn

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
