"""Sorting lists: what is written reads back, and every mistake is told with row and column."""

from __future__ import annotations

import csv
import io
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from plant_models.library import load_weight_categories
from synth.frame.input_error import InputError
from synth.hump.control.cut_record import CutRecord, Mark, Rolling
from synth.hump.control.sorting_list import SortingList
from synth.hump.control.sorting_list_file import COLUMNS, load_sorting_list, sorting_list_of_csv

CATEGORIES = load_weight_categories()
HEAD = "cut,cars,axles,mass_t,category,track\n"


@st.composite
def lists(draw: st.DrawFn) -> SortingList:
    """One to six cuts."""
    cuts = []
    for serial in range(1, draw(st.integers(1, 6)) + 1):
        cars = draw(st.integers(1, 60))
        cuts.append(
            CutRecord(
                serial=serial,
                cars=cars,
                axles=draw(st.integers(2 * cars, 400)),
                mass_t=draw(st.floats(1.0, 100.0 * cars)),
                category=draw(st.sampled_from([category.number for category in CATEGORIES.members])),
                track=draw(st.integers(1, 999)),
                length_m=draw(st.floats(4.0 * cars, 200.0 * cars)),
                rolling=draw(st.sampled_from(Rolling)),
                lead=draw(st.integers(0, 1)),
                hump_speed_m_s=draw(st.floats(0.1, 4.0)),
                marks=draw(st.frozensets(st.sampled_from(Mark))),
            )
        )
    return SortingList(tuple(cuts))


def to_sorting_csv(cuts: SortingList) -> str:
    """The text of a file with this list."""
    names = {category.number: category.latin for category in CATEGORIES.members}
    text = io.StringIO(newline="")
    writer = csv.writer(text)
    writer.writerow(COLUMNS)
    for cut in cuts.cuts:
        marks = " ".join(sorted(mark.value for mark in cut.marks))
        numbers = [cut.serial, cut.cars, cut.axles, repr(cut.mass_t), names[cut.category], cut.track]
        writer.writerow(
            [*numbers, repr(cut.length_m), cut.rolling.name.lower(), cut.lead, repr(cut.hump_speed_m_s), marks]
        )
    return text.getvalue()


@given(lists())
def test_what_is_written_reads_back(cuts: SortingList) -> None:
    assert sorting_list_of_csv(to_sorting_csv(cuts), "train.csv", CATEGORIES) == cuts


def test_the_columns_that_must_be_there_are_enough() -> None:
    (cut,) = sorting_list_of_csv(HEAD + "7,2,8,151.5,T,17\n", "train.csv", CATEGORIES).cuts
    assert cut == CutRecord(7, 2, 8, 151.5, 5, 17, 2 * 13.92)


def test_a_spreadsheet_may_write_semicolons_and_decimal_commas_and_leave_the_category_out() -> None:
    plain = sorting_list_of_csv(HEAD + "1,2,8,151.5,T,17\n2,1,4,23,L,3\n", "train.csv", CATEGORIES)
    for separator in (";", "\t"):
        rows = ("cut,cars,axles,mass_t,track", "1,2,8,151/5,17", "2,1,4,23,3", ",,,,")
        text = "\ufeff" + "\r\n".join(row.replace(",", separator).replace("/", ",") for row in rows)
        assert sorting_list_of_csv(text, "train.csv", CATEGORIES) == plain


def test_columns_may_stand_in_any_order_and_names_of_categories_be_latin_or_cyrillic() -> None:
    text = (
        "\ufeffmarks,track,category,mass_t,axles,cars,cut\r\ndo-not-hump long-base,3,ЛС,40,4,1,1\r\n,4,LS,40,4,1,2\r\n"
    )
    refused, humped = sorting_list_of_csv(text, "train.csv", CATEGORIES).cuts
    assert refused.marks == {Mark.DO_NOT_HUMP, Mark.LONG_BASE}
    assert (refused.category, humped.category) == (2, 2)
    assert SortingList((refused, humped)).humped == (humped,)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "train.csv: it is empty; its first row must name the columns cut, cars, axles, mass_t, track"),
        ("cut,wheels\n", "train.csv: row 1: column 'wheels' is unknown; known: "),
        ("cut,cut\n", "train.csv: row 1: column cut is there twice; leave one out"),
        ("cut,cars,axles,mass_t,category\n", "train.csv: row 1: column track is missing; add it"),
        (HEAD, "train.csv: sorting list: it holds no cut"),
        (HEAD + "1,1,4,60,T\n", "train.csv: row 2: 5 cells; the first row has 6 columns"),
        (HEAD + "1,1,4,60,T,3\n2,one,4,60,T,3\n", "train.csv: row 3: cars is 'one'; it must be a whole number"),
        (HEAD + "1,1,4,60 t,T,3\n", "train.csv: row 2: mass_t is '60 t'; it must be a number, with a decimal point"),
        (HEAD + "1,1,4,1_0,T,3\n", "train.csv: row 2: mass_t is '1_0'"),
        (HEAD + "1,1,4,nan,T,3\n", "train.csv: row 2: mass_t is nan; it must be a finite number from 1 to 200"),
        (HEAD + "1,1,4,60,X,3\n", "train.csv: row 2: category: weight category 'X' is not in the library; "),
        (HEAD + "1,1,4,60,T,\n", "train.csv: row 2: track is ''; it must be a whole number"),
        (HEAD + "1,1,4,60,T,0\n", "train.csv: row 2: track is 0; it must be a whole number 1 to 999"),
        (HEAD + "1,1,4,60,T,٣\n", "train.csv: row 2: track is '٣'; it must be a whole number"),
        (HEAD + "2,1,4,60,T,3\n2,1,4,60,T,3\n", "train.csv: sorting list: cut 2 stands behind cut 2; the numbers must"),
        (HEAD.replace("\n", ",marks\n") + "1,1,4,60,T,3,fast\n", "train.csv: row 2: marks: 'fast' is no mark; known: "),
        (
            HEAD.replace("\n", ",rolling\n") + "1,1,4,60,T,3,so\n",
            "train.csv: row 2: rolling is 'so'; it must be one of",
        ),
        (HEAD + '1,1,4,60,T,"3\n', "train.csv: this is not valid CSV ("),
    ],
)
def test_a_mistake_is_told_with_row_and_column(text: str, sentence: str) -> None:
    with pytest.raises(InputError) as told:
        sorting_list_of_csv(text, "train.csv", CATEGORIES)
    assert str(told.value).startswith(sentence)
    assert "\n" not in str(told.value)


def test_every_row_at_fault_is_told() -> None:
    with pytest.raises(InputError) as told:
        sorting_list_of_csv(HEAD + "1,0,4,60,T,3\n2,1,4,60,T,3\n3,1,4,60,T,x\n", "train.csv", CATEGORIES)
    assert [sentence.split(":")[1] for sentence in told.value.sentences] == [" row 2", " row 4"]


def sentences(text: str) -> tuple[str, ...]:
    """What is told about a list; nothing where it is one."""
    try:
        sorting_list_of_csv(text, "train.csv", CATEGORIES)
    except InputError as fault:
        return fault.sentences
    return ()


def test_a_file_that_is_none_is_told(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="there is no such file"):
        load_sorting_list(tmp_path / "none.csv")
    (tmp_path / "latin.csv").write_bytes(b"cut\xff")
    with pytest.raises(InputError, match="byte 3 is not UTF-8"):
        load_sorting_list(tmp_path / "latin.csv")
    with pytest.raises(InputError, match="cannot be read"):
        load_sorting_list(tmp_path)
    (tmp_path / "train.csv").write_text(HEAD + "1,1,4,60,T,3\n", encoding="utf-8")
    assert len(load_sorting_list(tmp_path / "train.csv")) == 1
