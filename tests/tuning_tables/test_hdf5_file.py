"""A book keeps its tables, tells h5py what they are, has the same bytes for the same content, and hides no damage."""

import os
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest

from tuning_tables import (
    ControllerTable,
    DamagedTable,
    Generator,
    InvalidTable,
    UnknownFormat,
    read_book,
    to_json,
    write_book,
)


@pytest.fixture
def book(table: ControllerTable, linear_table: ControllerTable, tmp_path: Path) -> Path:
    """A file with two tables that differ in every length."""
    path = tmp_path / "book.h5"
    write_book([table, linear_table], path)
    return path


@pytest.fixture
def surface_book(table: ControllerTable, surface_table: ControllerTable, tmp_path: Path) -> Path:
    """A file with a table that decides at rest, and one with slopes."""
    path = tmp_path / "surfaces.h5"
    write_book([table, surface_table], path)
    return path


def test_tables_survive_the_book(book: Path, table: ControllerTable, linear_table: ControllerTable) -> None:
    tables = read_book(book)
    assert tables == (table, linear_table)
    assert np.array_equal(tables[0].coefficients, table.coefficients, equal_nan=True)
    # The checksum of the JSON form covers every digit and type.
    assert [to_json(read) for read in tables] == [to_json(table), to_json(linear_table)]
    assert os.listdir(book.parent) == ["book.h5"]


@pytest.mark.requirement("FILE-06")
def test_equal_books_have_equal_bytes_whatever_the_process_name_and_hour(book: Path, tmp_path: Path) -> None:
    program = "import sys; from tuning_tables import *; write_book(read_book(sys.argv[1]), sys.argv[2])"
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "MALLOC_PERTURB_": "165"}
    other = tmp_path / "another_name.h5"
    subprocess.run([sys.executable, "-c", program, str(book), str(other)], env=environment, check=True)
    assert other.read_bytes() == book.read_bytes()


def test_what_makes_no_book_is_refused_before_a_file_is_made(table: ControllerTable, tmp_path: Path) -> None:
    path = tmp_path / "book.h5"
    other = replace(table, id="other", generator=Generator("other", "2", "f" * 64))
    for tables in ([], [table, table], [table, other]):
        with pytest.raises(InvalidTable):
            write_book(tables, path)
    assert os.listdir(tmp_path) == []
    write_book([table, other], path, generator=other.generator)
    assert read_book(path) == (table, other)
    with h5py.File(path) as file:
        assert file.attrs["config_sha256"] == "f" * 64


@pytest.mark.requirement("FILE-02")
@pytest.mark.parametrize("name", ["book", "surface_book"])
def test_no_truncated_book_gets_through(request: pytest.FixtureRequest, name: str, tmp_path: Path) -> None:
    content = request.getfixturevalue(name).read_bytes()
    short = tmp_path / "short.h5"
    for length in [*range(0, len(content), 211), len(content) - 1]:
        short.write_bytes(content[:length])
        with pytest.raises(DamagedTable):
            read_book(short)


@pytest.mark.requirement("FILE-02")
@pytest.mark.parametrize("name", ["book", "surface_book"])
def test_no_flipped_bit_gets_through(request: pytest.FixtureRequest, name: str, tmp_path: Path) -> None:
    content = request.getfixturevalue(name).read_bytes()
    changed_book = tmp_path / "changed.h5"
    # The flip at 4697, a length in the heap of strings, holds HDF5 2.0 in an endless loop where it is given the file.
    for position in [*range(0, len(content), 83), *range(len(content) - 130, len(content)), 4697]:
        changed = bytearray(content)
        changed[position] ^= 1 << position % 8
        changed_book.write_bytes(changed)
        with pytest.raises(UnknownFormat if position < 8 else DamagedTable):
            read_book(changed_book)
