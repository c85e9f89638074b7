"""Tables that decide at any time: what the exporter writes passes, and each planted fault is found for its reason."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from synth.checker.document_shape import SLOPES
from synth.checker.finding import Kind
from synth.checker.source import read_source
from synth.checker.table_reading import read_table
from synth.checker.verdict import CONFIRMED
from tests.checker.any_time_tables import approached, estimated, every_kind, leave, sloped, sound_table
from tests.checker.planted_fault import Document, found, judged, look, rewrite
from tests.tuning_tables.forged_book import forge, put
from tuning_tables import ControllerTable, Decisions, read_book, to_json, write_book

LOWER, UPPER = SLOPES


@pytest.fixture
def left(tmp_path: Path) -> Path:
    """One table with a gauge, in every form that the checker reads but controller code."""
    return leave([sloped(sound_table("plain"))], tmp_path)


@pytest.fixture
def alone(left: Path) -> Path:
    """Its JSON file, with nothing to contradict it."""
    (left / "book.h5").unlink()
    min((left / "tables").glob("*.csv")).unlink()
    return min((left / "tables").glob("*.json"))


def test_every_kind_passes_in_json_csv_and_book(tmp_path: Path) -> None:
    made = list(every_kind())
    out = leave([replace(table, target_speed_m_s=3.6 + 0.1 * i) for i, table in enumerate(made)], tmp_path)
    verdict = judged(out)
    assert verdict.findings == ()
    assert verdict.code == CONFIRMED
    by_id = {each.table.id: each.table for each in verdict.tables}
    for table in made:
        read = by_id[table.id]
        assert (read.at_any_time, read.has_gauge) == (True, table.has_gauge)
        assert read.slopes == tuple(stage.slopes for stage in table.stages)
        assert (read.estimator is None, read.approach_m > 0.0) == (table.estimator is None, table.approach is not None)


def test_a_book_may_hold_tables_at_rest_and_at_any_time(tmp_path: Path) -> None:
    """The shorter table is filled up; without estimators the book has no columns of them."""
    first = sloped(sound_table("first"))
    fewer = (first.stages[0], replace(first.stages[1], upper=None, upper_slope_m_s_per_kpa=None))
    tables = [
        first,
        replace(first, id="short", stages=fewer, target_speed_m_s=3.8),
        replace(approached(sound_table("rest")), target_speed_m_s=3.9, decisions=Decisions.AT_REST),
        replace(sound_table("none"), target_speed_m_s=4.1),
    ]
    for each in (tables, [*tables, replace(estimated(tables[-1]), target_speed_m_s=4.2)]):
        write_book(each, tmp_path / "book.h5")
        source = read_source(tmp_path / "book.h5")
        assert source.findings == ()
        assert [table.document for table in source.tables] == [read_table(to_json(table)).document for table in each]


def of_stage(k: int, key: str, value: object) -> Callable[[Document], None]:
    return lambda document: document["stages"][k].update({key: value})


def member(key: str, value: object) -> Callable[[Document], None]:
    return lambda document: document.update({key: value})


def without(key: str) -> Callable[[Document], None]:
    return lambda document: document.pop(key)


def wrong_sign(key: str) -> Callable[[Document], None]:
    def change(document: Document) -> None:
        document["stages"][1][key] *= -1.0

    return change


def beyond_float32(document: Document) -> None:
    document["stages"][2]["pressure_kpa"] = 1e39


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (member("decisions", "at_rest"), "at rest"),
        (of_stage(1, LOWER, -0.0), r"stages\[1\].lower_slope_m_s_per_kpa is -0\.0"),
        (of_stage(1, LOWER, None), "the lower line of stage 1 has no slope, but other lines have one"),
        (of_stage(0, LOWER, 0.0), "stage 0 has a slope of the lower line, but no such line"),
        (of_stage(2, UPPER, 0.0), "stage 2 has a slope of the upper line, but no such line"),
        (of_stage(1, UPPER, -0.003), "the upper line of stage 1 has the slope -0.003, which is no float32 number"),
        (wrong_sign(LOWER), r"at stage 1 the lower line is not below .* and a pressure of 300 kPa"),
        (wrong_sign(UPPER), r"at stage 1 the lower line is not below .* and a pressure of 0 kPa"),
        (beyond_float32, "exceed what float32 can hold"),
        (of_stage(2, LOWER, 0.125), r"lower line of stage 2 runs from -?\d+\.\d\d to \d+\.\d\d m/s, out of the plau"),
    ],
)
def test_a_fault_in_the_document_is_found(alone: Path, change: Callable[[Document], None], words: str) -> None:
    rewrite(alone, change)
    assert found(look(alone), Kind.DAMAGED, words)


def test_a_stage_out_of_use_must_be_left_at_every_pressure_and_without_one(tmp_path: Path) -> None:
    """Stage 2 is never raised to: its own pressure lies above the range, and counts where the gauge is silent."""
    made = sloped(sound_table("plain"))
    top = replace(made.stages[1], upper=None, upper_slope_m_s_per_kpa=None)
    for lower, slope, words in (
        ((12.0, 0.0), 0.0, ""),
        ((12.0, 0.0), 0.03125, r"falls to 2\.\d+ m/s: the rule would stay"),
        ((5.0, 0.0), -0.03125, r"falls to 5\.000 m/s: the rule would stay"),
    ):
        last = replace(made.stages[2], lower=lower, lower_slope_m_s_per_kpa=slope)
        table = replace(made, stages=(made.stages[0], top, last))
        file = tmp_path / "table.json"
        file.write_bytes(to_json(table))
        verdict = judged(file)
        assert found(verdict, Kind.DAMAGED, words) if words else verdict.findings == ()


def test_lines_out_of_use_keep_their_order_where_the_gauge_is_silent(tmp_path: Path) -> None:
    """Stage 2 is never raised to. Its lines cross at its own pressure only, at which they are where none is told."""
    made = sloped(sound_table("plain"))
    top = replace(made.stages[1], upper=None, upper_slope_m_s_per_kpa=None)
    both = replace(made.stages[2], lower=(12.0, 0.0), upper=(13.0, 0.0), lower_slope_m_s_per_kpa=0.0)
    stages = (made.stages[0], top, replace(both, upper_slope_m_s_per_kpa=-0.0078125))
    table = replace(made, stages=(*stages, replace(stages[2], k=3, pressure_kpa=450.0, upper=None,
                                                   upper_slope_m_s_per_kpa=None)))  # fmt: skip
    file = tmp_path / "table.json"
    file.write_bytes(to_json(table))
    assert judged(file).findings == ()
    rewrite(file, of_stage(2, "upper", [11.5, 0.0]))  # at 150 kPa, the highest in the range, it is 1.17 m/s higher
    assert found(look(file), Kind.DAMAGED, r"at stage 2 the lower line is not below the upper one at s = \S+ m$")


Edit = Callable[[Any], None]


def cell(name: str, index: tuple[int, ...], value: float) -> Edit:
    def edit(file: Any) -> None:
        file[name][index] = value

    return edit


def other_unit(file: Any) -> None:
    file[f"stage_{UPPER}"].attrs["units"] = "m/s"


def at_rest(file: Any) -> None:
    put(file, "decisions", np.array([b"at_rest"]))


@pytest.mark.parametrize(
    ("edit", "words"),
    [
        (at_rest, "at rest"),
        (cell(f"stage_{LOWER}", (0, 0), 0.5), "stage 0 has a slope of the lower line, but no such line"),
        (cell(f"stage_{LOWER}", (0, 1), np.nan), "the lower line of stage 1 has no slope"),
        (cell(f"stage_{LOWER}", (0, 1), -0.0), r"stages\[1\].lower_slope"),
        (other_unit, "upper_slope_m_s_per_kpa has the units 'm/s', but must have m/s per kPa"),
    ],
)
def test_a_forged_book_is_damaged(left: Path, edit: Edit, words: str) -> None:
    book = left / "book.h5"
    forge(book, edit)
    assert found(look(book), Kind.DAMAGED, words)


def change_text(file: Path, pattern: str, replacement: str) -> None:
    """Change one place in a file."""
    text, count = re.subn(pattern, replacement, file.read_bytes().decode("utf-8"), count=1)
    assert count == 1
    file.write_bytes(text.encode("utf-8"))


def other(table: ControllerTable) -> ControllerTable:
    """With one slope of another value."""
    stage = replace(table.stages[1], upper_slope_m_s_per_kpa=-0.00390625)
    return replace(table, stages=(table.stages[0], stage, table.stages[2]))


def test_a_book_that_says_otherwise_is_found(left: Path) -> None:
    book = left / "book.h5"
    (table,) = read_book(book)
    assert isinstance(table, ControllerTable)
    write_book([other(table)], book)
    assert found(
        look(left), Kind.DISAGREES, r"stages\[1\].upper_slope_m_s_per_kpa is \S+ in its JSON file, but -0.0039"
    )
    write_book([replace(sound_table("plain"), id=table.id)], book)
    assert found(look(left), Kind.DISAGREES, r"is .* in its JSON file, but .* in book\.h5")


@pytest.mark.parametrize(
    ("pattern", "replacement", "words"),
    [
        (r"(number,stages.0.upper_slope_m_s_per_kpa,-0.00)3", r"\g<1>4", "stages.0.upper_slope_m_s_per_kpa holds"),
        (
            r"number,stages.1.lower_slope_m_s_per_kpa,[^\n]*\n",
            "",
            "stages.1.lower_slope_m_s_per_kpa is missing",
        ),
        (r"text,decisions,at_any_time", "text,decisions,at_rest", "row text,decisions holds"),
        (
            r"number,stages.2.lower_slope",
            "number,stages.2.upper_slope",
            "2.upper_slope_m_s_per_kpa is in no table",
        ),
    ],
)
def test_a_changed_row_of_the_csv_is_found(left: Path, pattern: str, replacement: str, words: str) -> None:
    change_text(min((left / "tables").glob("*.csv")), pattern, replacement)
    assert found(look(left), Kind.DISAGREES, words)
