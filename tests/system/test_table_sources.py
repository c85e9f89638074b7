"""A table, a book and the folder that a tune left are one to every command that takes tables."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from synth.frame.input_error import InputError
from synth.retarder.forms.table_file import book_in
from synth.retarder.forms.tables_at import tables_at
from tests.system.conftest import Command

ID = "gondola-4-22t-to-1.5-m-s"


def sources(tuned: Path) -> tuple[Path, Path, Path]:
    return tuned / "tables" / f"{ID}.json", tuned / "book.h5", tuned


def test_all_three_hold_the_same_tables(tuned: Path) -> None:
    alone, book, folder = (tables_at(source).only_lines("a test") for source in sources(tuned))
    assert book == folder == tables_at(tuned / "tables").only_lines("a test")[:: 1 if book[0].id == ID else -1]
    assert alone == tuple(table for table in book if table.id == ID)
    assert book_in(tuned) == book_in(tuned / "book.h5") == tuned / "book.h5"
    assert book_in(tuned / "tables") == tuned / "tables"


def test_commands_beside_the_frame_take_all_three(command: Command, tuned: Path, tmp_path: Path) -> None:
    for place, source in enumerate(sources(tuned)):
        verified = json.loads(command("verify", source, "--passes", "100", "--json").out)
        assert ID in {each["id"] for each in verified["tables"]}
        assert f"{ID}: leave with 1.5 m/s" in command("inspect", source).out
        written = json.loads(command("export", source, "--format", "csv", "-o", tmp_path / str(place), "--json").out)
        assert str(tmp_path / str(place) / f"{ID}.csv") in written["files"]


def test_sensitivity_takes_a_folder(command: Command, tuned: Path, two_classes: Path, tmp_path: Path) -> None:
    ran = command(
        "sensitivity", two_classes, "--table", tuned, "--points", "200", "--passes", "100", "-o", tmp_path / "out", "-q"
    )
    assert (ran.code, ran.err) == (0, "")


@pytest.mark.parametrize("what", ["empty", "nothing"])
def test_where_there_is_none_one_sentence_says_so(command: Command, tmp_path: Path, what: str) -> None:
    (tmp_path / "empty").mkdir()
    for words in (("validate",), ("inspect",), ("verify",), ("export", "--format", "c")):
        ran = command(*words, tmp_path / what)
        assert (ran.code, ran.out) == (2, "")
        assert str(tmp_path / what) in ran.sentence
    with pytest.raises(InputError, match=what):
        tables_at(tmp_path / what)
