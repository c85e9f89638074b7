"""The exported C as text: complete, equal to the table to the last bit; it names who exports it, and what 0 m/s
means.
"""

from __future__ import annotations

import csv
import io
import re
import zipfile
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from scripts.studies.in_the_loop.controller_process import (
    COMMAND,
    Build,
    Controller,
    held_record,
    held_words,
    places,
    sources_of,
    table_words,
)
from synth.checker.code_export import code_files
from synth.cli.qualification.second_program import with_other_number
from synth.retarder.forms.code_options import CONTROLLER_NAMES, FMU_NAMES, CodeOptions
from synth.retarder.forms.table_forms import FORMS, correction_files
from synth.retarder.forms.tables_at import exporters_at
from tests.controller_code.building import built as built_of
from tests.controller_code.conftest import Built, Tool
from tests.controller_code.passage_tables import passage_table
from tests.controller_code.sample_book import sample_book
from tests.st_files import st_files
from tests.tuning_tables.aim.made_tables import category_table
from tuning_tables import decide_for, from_json, read_book, read_table, to_json, write_book
from tuning_tables.controller_code.line_code import line_code
from tuning_tables.document import AnyTable
from tuning_tables.estimator import begin, unseen_samples
from tuning_tables.export_names import exporting_version
from tuning_tables.exports import TABLE_FILE, c_files
from tuning_tables.language.c99_data import hex_float
from tuning_tables.rule import speed_for
from tuning_tables.self_test_size import FULL, SMALL
from tuning_tables.table_book import TableBook

CHANGES = np.array([*(1 << bit for bit in range(8)), 0xFF, 0x5A], dtype=np.uint8)
"""Bits of a byte that are turned round: each alone, all, and half of them."""


def test_exports_of_other_numbers_have_another_tag(book: TableBook) -> None:
    """Also where shapes are equal."""
    first = book.tables[0]
    changed = replace(first, stages=(replace(first.stages[0], upper=first.stages[1].upper), *first.stages[1:]))
    tags = {line_code(TableBook((table,)), SMALL).tag for table in (first, changed)}
    assert len(tags) == 2
    assert line_code(TableBook((first,)), FULL).tag in tags


@pytest.mark.requirement("CODE-07")
def test_every_changed_byte_of_a_table_is_found(book: TableBook, built: Built) -> None:
    controller = built(book)
    right = held_words(book, 0)
    assert controller.intact(right[None, :]).all()
    length = 4 * len(right)
    damaged = np.repeat(right.view(np.uint8)[None, :], len(CHANGES) * length, axis=0)
    place, change = np.divmod(np.arange(len(damaged)), len(CHANGES))
    damaged[np.arange(len(damaged)), place] ^= CHANGES[change]
    assert not controller.intact(damaged.view(np.uint32)).any()


@pytest.mark.requirement("CODE-07")
@pytest.mark.parametrize("number", [0, 1])
def test_between_a_damaged_table_and_a_sound_one_is_a_damaged_one(number: int, tmp_path: Path, tool: Tool) -> None:
    book = sample_book()
    files = dict(sources_of(book, SMALL))
    before, mark, table = files["retarder_table.c"].partition(f"/* {number}: {book.tables[number].id} */".encode())
    files["retarder_table.c"] = before + mark + with_other_number(table)
    process = files.pop("controller_process.c").decode("ascii")
    command = tuple(built_of(files, process, tmp_path, Build(tool("gcc"), ("-O0",))))
    controller = Controller(command, table_words(book))
    statuses, chosen = controller.select(np.array([(1, 4, 2.0), (1, 4, 2.5), (1, 4, 3.3)], COMMAND))
    assert statuses.tolist() == [0, 1, 0]
    assert controller.intact(chosen).tolist() == [number == 1, False, number == 0]


@pytest.mark.requirement("FILE-05")
def test_json_book_and_c_hold_the_same_bits(book: TableBook, tmp_path: Path, built: Built) -> None:
    write_book(book.tables, tmp_path / "book.h5")
    way_round = TableBook(tuple(from_json(to_json(table)) for table in read_book(tmp_path / "book.h5")))
    assert way_round == book
    assert c_files(way_round) == c_files(book)
    record, where = held_record(book), places(book)
    for table, words in zip(book.tables, built(way_round).dump(), strict=True):
        lines = words[where["coefficient"]].view(np.float32).reshape(record.shape("coefficient"))
        has_line = words[where["has_line"]].reshape(record.shape("has_line"))
        assert words[where["stages"]] == len(table.stages)
        assert words[where["powers"]] == table.degree + 1
        for stage in table.stages:
            for index, line in enumerate((stage.lower, stage.upper)):
                assert has_line[stage.k, index] == (line is not None)
                held = lines[stage.k, index, : table.degree + 1].astype(np.float64)
                assert np.array_equal(held.view(np.uint64), np.array(line or 0.0 * held).view(np.uint64))
        if "slope" in where:
            pressures = [stage.pressure_kpa if table.has_gauge else 0.0 for stage in table.stages]
            assert words[where["pressure_kpa"]].view(np.float32)[: len(pressures)].tolist() == pressures
            slopes = words[where["slope"]].view(np.float32).reshape(-1, 2)[: len(pressures)]
            assert slopes.tolist() == [[each or 0.0 for each in stage.slopes] for stage in table.stages]
        if table.estimator is not None:
            work = [words[where[name]].view(np.float32)[: len(table.estimator.s_m)]
                    for name in ("place_m", "drive", "brake")]  # fmt: skip
            assert np.array_equal(work, table.estimator.work)
            for name, value in table.estimator.numbers.items():
                assert words[where[name]].view(np.float32)[0] == np.float32(value), name


def test_golden_vectors_as_csv_are_answered_as_they_say(book: TableBook) -> None:
    rows = list(csv.DictReader(io.StringIO(c_files(book)["golden_vectors.csv"].decode("utf-8"), newline="")))
    assert len(rows) > 300 * len(book.tables)
    names = ["s_m", "v_m_s", *(["pressure_kpa"] if held_record(book).room["gauge"] else [])]
    columns = {f"{name}_bits": name for name in names}
    assert {*rows[0]} == {"table", "id", "stage", *columns, *columns.values(), "answer"}
    for row in rows:
        reading = [np.array([int(row[key], 16)], np.uint32).view(np.float32)[0] for key in columns]
        shown = np.array([row[key] for key in columns.values()], dtype=np.float32)
        assert np.array_equal(shown, reading, equal_nan=True)
        assert decide_for(book.tables[int(row["table"])], int(row["stage"]), *reading) == int(row["answer"])
        assert book.tables[int(row["table"])].id == row["id"]


def test_hexadecimal_floats() -> None:
    assert [hex_float(x) for x in (2.5, -0.1, 0.0, -0.0, 1e-45, 3.4028235e38)] == [
        "0x1.4p+1f", "-0x1.99999ap-4f", "0x0p+0f", "-0x0p+0f", "0x1p-149f", "0x1.fffffep+127f",
    ]  # fmt: skip


TABLES: Sequence[AnyTable] = (sample_book().tables[0], passage_table("light"), category_table())


@pytest.fixture
def later(monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """The program as a later version of it."""
    exporting_version.cache_clear()
    monkeypatch.setattr("tuning_tables.export_names.version", lambda _: "98.7")
    yield "retarder-synth 98.7"
    exporting_version.cache_clear()


def content(file: bytes) -> bytes:
    """Of a unit its description and sources, of any other file itself, without the marks that break comments."""
    if not file.startswith(b"PK"):
        return re.sub(rb"[\s/*]+", b" ", file)
    with zipfile.ZipFile(io.BytesIO(file)) as archive:
        return b"".join(map(archive.read, archive.namelist()))


@pytest.mark.requirement("FILE-06")
@pytest.mark.parametrize("table", TABLES, ids=lambda table: type(table).__name__)
def test_each_form_names_it(table: AnyTable, later: str, tmp_path: Path) -> None:
    is_lines = table is TABLES[0]
    for form in FORMS if is_lines else [each for each in FORMS if each not in FMU_NAMES]:
        options = CodeOptions(self_test=SMALL, correction_m_s=0.1 if is_lines else None)
        files = FORMS[form]([table], options)
        if form in CONTROLLER_NAMES and form not in FMU_NAMES:
            files = {**files, **correction_files(form, [table], options)}
        named = {name for name, each in files.items() if later.encode() in content(each)}
        assert named, form
        if form == "c":
            assert named == {name for name in files if not name.endswith(".csv")}
        for name, each in files.items():
            path = tmp_path / form / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(each)
        assert {code.exported_by for code in code_files(tmp_path / form)} <= {later}, form
    assert exporters_at(tmp_path / "json") == (later,)
    (file,) = (tmp_path / "json").iterdir()
    assert read_table(file).generator == table.generator  # what made it is another matter


def test_a_book_names_it(later: str, tmp_path: Path) -> None:
    write_book([sample_book().tables[0]], tmp_path / "book.h5")
    assert exporters_at(tmp_path) == (later,)


PAGE = Path(__file__).parents[2] / "docs" / "how-to" / "controllers.md"


@pytest.mark.requirement("RULE-10")
def test_zero_is_believed_and_lowers() -> None:
    table, state = sample_book().tables[0], begin()
    assert speed_for(table, state, 5.0, 0.0, 0.0) == 0.0
    assert unseen_samples(state) == 0
    assert decide_for(table, 2, 5.0, 0.0) == 0
    assert speed_for(table, state, 5.0, -1.0, 0.0) == -1.0
    assert unseen_samples(state) == 1
    assert decide_for(table, 2, 5.0, -1.0) == 2


def test_header_text_and_page_say_so() -> None:
    said = "is believed: the cut stands, so the brake is released"
    book = sample_book()
    for text in (c_files(book)["retarder_table.h"], st_files(book)[TABLE_FILE]):
        assert said in " ".join(text.decode().replace(" * ", " ").split())
    assert "**Without an estimator a reading of 0.0 m/s is believed" in PAGE.read_text(encoding="utf-8")
