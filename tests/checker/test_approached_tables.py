"""Tables that act before the entrance: what a tune writes passes, each planted fault is found for the right reason."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from synth.checker.code_export import c_differences, st_differences
from synth.checker.code_file import LINES
from synth.checker.finding import Kind
from synth.checker.golden_export import vector_differences
from synth.checker.line_numbers import due_of_lines
from synth.checker.plant import UnusableConfigError, plant_of
from synth.checker.source import read_source
from synth.checker.summary import read_summary
from synth.checker.table_reading import read_table
from synth.checker.track_export import track_differences
from synth.checker.verdict import CONFIRMED, verify
from tests.checker.planted_fault import Document, alone, found, look, rewrite
from tests.controller_code.sample_book import approaching_book
from tests.st_files import st_files
from tests.tuning_tables.forged_book import forge, put
from tuning_tables import Approach, TableBook, read_book, to_json, write_book
from tuning_tables.c_source import c_files, vectors_csv
from tuning_tables.golden_vectors import GoldenVectors, golden_vectors
from tuning_tables.rule import decide_many
from tuning_tables.st_source import TABLE_FILE


@pytest.mark.long
def test_a_tune_with_an_approach_passes(approached_once: Path) -> None:
    verdict = verify(approached_once, 300, 1)
    assert verdict.findings == ()
    assert [each.skipped for each in verdict.tables] == [None, None]
    assert [(each.table.approach_m, each.table.entrance_stage) for each in verdict.tables] == [(4.0, 1)] * 2
    assert verify(approached_once / "book.h5", 100, 1).code == CONFIRMED


def shorter(document: Document) -> None:
    document["approach"]["length_m"] = 3.5
    document["valid"]["s_m"][0] = -3.5


def none_at_all(document: Document) -> None:
    document["approach"] = None


def of_approach(key: str, value: object) -> Callable[[Document], None]:
    return lambda document: document["approach"].update({key: value})


@pytest.mark.parametrize(
    ("change", "kind", "words"),
    [
        (of_approach("entrance_stage", 2), Kind.DISAGREES, "allows stage 1 before the entrance, not 2"),
        (of_approach("entrance_stage", 0), Kind.DISAGREES, "allows stage 1 before the entrance, not 0"),
        (shorter, Kind.DISAGREES, r"other approach: 4\.0, not 3\.5"),
        (none_at_all, Kind.DISAGREES, r"other approach: 4\.0, not 0\.0"),
        (of_approach("length_m", 3.5), Kind.DAMAGED, r"valid\.s_m is .* but it must be from -approach\.length_m"),
    ],
)
def test_a_fault_in_the_document_is_found(
    approached: Path, change: Callable[[Document], None], kind: Kind, words: str
) -> None:
    table = alone(approached)
    rewrite(table, change)
    assert found(look(table), kind, words)


@pytest.mark.parametrize("wrong", ["no gate", "off by one", "too early", "at the entrance too", "turned round"])
def test_golden_vectors_of_a_wrong_gate_are_found(approached: Path, wrong: str) -> None:
    book = TableBook(read_book(approached / "book.h5"))
    file = approached / "c" / "golden_vectors.csv"
    assert file.read_bytes() == vectors_csv(book, [golden_vectors(table) for table in book.tables])
    stages = {"no gate": 4, "off by one": 2, "too early": 0}
    vectors = []
    for table in book.tables:
        right = golden_vectors(table)
        other = replace(table, approach=Approach(4.0, stages.get(wrong, 1)))
        asked = {"at the entrance too": right.s_m - (right.s_m == 0.0), "turned round": -right.s_m}
        path = asked.get(wrong, right.s_m)
        ungated = decide_many(replace(table, approach=Approach(4.0, 4)), right.stage, right.s_m, right.v_m_s)
        gated = np.minimum(ungated, np.maximum(right.stage, other.entrance_stage))
        answers = np.where(path < 0.0, gated, ungated)
        s_m, v_m_s, kpa = (each.copy() for each in (right.s_m, right.v_m_s, right.pressure_kpa))
        vectors.append(GoldenVectors(right.stage.copy(), s_m, v_m_s, kpa, answers))
    file.write_bytes(vectors_csv(book, vectors))
    assert found(look(approached), Kind.DISAGREES, "but the rule says")


def test_a_book_that_says_otherwise_is_found(approached: Path) -> None:
    book = approached / "book.h5"
    tables = read_book(book)
    write_book([replace(tables[0], approach=Approach(4.0, 2)), *tables[1:]], book)
    assert found(look(approached), Kind.DISAGREES, r"approach\.entrance_stage is 1 in its JSON file, but 2 in book")


@pytest.mark.parametrize(
    ("name", "value", "words"),
    [
        ("approach_entrance_stage", -1, "from 0 to"),
        ("approach", 2, "approach is 2, but it must be 0 or 1"),
        ("approach", 0, "approach_length_m holds values beside"),
        ("approach_entrance_stage", 9, "from 0 to"),
        ("approach_length_m", float("nan"), "approach.length_m"),
        ("approach_length_m", -0.0, "approach.length_m"),
        ("approach_length_m", 101.0, "from 0.001 to 100"),
    ],
)
def test_a_forged_book_is_damaged(approached: Path, name: str, value: float, words: str) -> None:
    book = approached / "book.h5"

    def edit(file: object) -> None:
        file[name][0] = value  # type: ignore[index]  # an h5py file

    forge(book, edit)
    assert found(look(book), Kind.DAMAGED, words)


def test_columns_of_approaches_that_no_table_has_are_damage(approached: Path) -> None:
    book = approached / "book.h5"

    def edit(file: Any) -> None:
        for name, value in (("approach", 0), ("approach_entrance_stage", 0), ("approach_length_m", np.nan)):
            put(file, name, file[name][()] * 0 + value)
        put(file, "approach_interlock", np.array([b""] * len(file["approach"])))

    forge(book, edit)
    assert found(look(book), Kind.DAMAGED, "columns of approach, but none of its tables has one")


@pytest.mark.parametrize("estimators", [False, True])
def test_exports_of_many_shapes_are_those_of_the_exporter(estimators: bool, tmp_path: Path) -> None:
    book = approaching_book(estimators)
    tables = [read_table(to_json(table)) for table in book.tables]
    files = c_files(book)
    code, header = (files[f"retarder_table.{suffix}"].decode("ascii") for suffix in ("c", "h"))
    due = due_of_lines(tables)
    assert list(c_differences(code, header, "RETARDER", LINES, due)) == []
    assert list(vector_differences(files["golden_vectors.csv"], tables)) == []
    text = st_files(book)[TABLE_FILE].decode("ascii")
    assert list(st_differences(text, "RETARDER", LINES, due)) == []
    if estimators:
        assert list(track_differences(files["golden_tracks.csv"], tables, True)) == []
    write_book(book.tables, tmp_path / "book.h5")
    source = read_source(tmp_path / "book.h5")
    assert source.findings == ()
    assert [table.document for table in source.tables] == [table.document for table in tables]


@pytest.mark.parametrize(
    ("section", "changes", "words"),
    [
        ("regulator", {"approach_m": 101.0}, r"regulator\.approach_m of its configuration is 101"),
        ("regulator", {"approach_m": "4"}, r"regulator\.approach_m of its configuration is '4'"),
        ("regulator", {"initial_stage": 2}, r"regulator\.initial_stage of its configuration is 2"),
        ("regulator", {"initial_stage": 0.5}, r"regulator\.initial_stage of its configuration is 0\.5, no stage"),
        ("cut", {"entrance_stage": 5}, r"entrance_stage of its configuration is 5"),
        ("cut", {"entrance_stage": -1}, r"entrance_stage of its configuration is -1"),
    ],
)
def test_a_configuration_with_an_impossible_approach_is_refused(
    approached_once: Path, section: str, changes: Document, words: str
) -> None:
    config = read_summary(approached_once / "summary.json").config
    (cut,) = config["cut"]
    parts: Document = {"regulator": dict(config["regulator"]), "cut": dict(cut)}
    parts[section] |= changes
    with pytest.raises(UnusableConfigError, match=words):
        plant_of({**config, "regulator": parts["regulator"]}, parts["cut"])


def test_keys_of_the_approach_may_be_absent(approached_once: Path) -> None:
    config = read_summary(approached_once / "summary.json").config
    (cut,) = config["cut"]
    plant = plant_of(config, cut)
    assert (plant.approach_m, plant.initial_stage, plant.entrance_stage) == (4.0, 0, 1)
    before = plant_of({**config, "regulator": {"estimator": False}}, {k: cut[k] for k in cut if k != "entrance_stage"})
    assert (before.approach_m, before.initial_stage, before.entrance_stage) == (0.0, 0, 4)
    closed = plant_of({**config, "regulator": {"estimator": False, "initial_stage": 2}}, cut | {"entrance_stage": 2})
    assert (closed.approach_m, closed.initial_stage) == (0.0, 2)
