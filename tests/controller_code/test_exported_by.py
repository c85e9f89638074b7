"""Every form of every kind of tables names the version that exports it, whatever version made the tables."""

from __future__ import annotations

import io
import re
import zipfile
from collections.abc import Iterator, Sequence
from pathlib import Path

import pytest

from synth.checker.code_file import code_files
from synth.retarder.forms.code_options import CONTROLLER_NAMES, FMU_NAMES, CodeOptions
from synth.retarder.forms.correction_form import correction_files
from synth.retarder.forms.exporters import exporters_at
from synth.retarder.forms.table_forms import FORMS
from tests.controller_code.passage_tables import passage_table
from tests.controller_code.sample_book import sample_book
from tests.tuning_tables.aim.made_tables import category_table
from tuning_tables import read_table, write_book
from tuning_tables.exporter import exporting_version
from tuning_tables.self_test_size import SMALL
from tuning_tables.table_kinds import AnyTable

TABLES: Sequence[AnyTable] = (sample_book().tables[0], passage_table("light"), category_table())


@pytest.fixture
def later(monkeypatch: pytest.MonkeyPatch) -> Iterator[str]:
    """The program as a later version of it."""
    exporting_version.cache_clear()
    monkeypatch.setattr("tuning_tables.exporter.version", lambda _: "98.7")
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
