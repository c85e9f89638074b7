"""A book keeps its tables, tells h5py what they are, has the same bytes for the same content, and hides no damage."""

import os
import shutil
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest

from tests.tuning_tables.forged_book import Edit
from tuning_tables import (
    ControllerTable,
    DamagedTable,
    Generator,
    InvalidTable,
    NewerVersion,
    TableError,
    UnknownFormat,
    read_book,
    to_json,
    write_book,
)
from tuning_tables.seal import seal_of


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


def test_the_book_explains_itself_to_h5py(book: Path, table: ControllerTable) -> None:
    with h5py.File(book) as file:
        assert file.attrs["format"] == "retarder-book"
        assert file.attrs["complete"] == 1
        assert file.attrs["config_sha256"] == table.generator.config_sha256
        upper = file["stage_upper"]
        assert upper.dtype == np.float32
        assert upper.shape == (2, 4, 4)
        assert [dimension[0].name for dimension in upper.dims] == ["/table", "/stage", "/power"]
        assert upper.attrs["units"] == "m/s per m^power"
        assert np.array_equal(upper[0], table.coefficients[:, 1], equal_nan=True)
        assert np.isnan(upper[1, :, 2:]).all()
        assert file["id"].asstr()[:].tolist() == ["leer-22t-4.0", "linear"]
        assert file["retarder_name"].asstr()[0] == "Talbremse Süd"
        assert file["stages"][:].tolist() == [4, 2]
        assert file["validated"][:].tolist() == [1, 0]
        assert file["validated_passes"][:].tolist() == [20000, 0]
        assert np.isnan(file["predicted_p_stall"][0])
        for name, dataset in file.items():
            assert dataset.attrs["meaning"], name
            assert dataset.is_scale or (dataset.fletcher32 and dataset.attrs["units"]), name


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


def test_a_failing_writer_leaves_the_old_book(
    book: Path, table: ControllerTable, monkeypatch: pytest.MonkeyPatch
) -> None:
    before = book.read_bytes()

    def fail(*_args: object, **_kwargs: object) -> None:
        raise OSError("no space left on device")

    with monkeypatch.context() as patched:
        patched.setattr(h5py.Dataset, "make_scale", fail)
        with pytest.raises(OSError, match="no space"):
            write_book([table], book)
    assert book.read_bytes() == before
    assert os.listdir(book.parent) == ["book.h5"]


def edit_attribute(name: str, value: object) -> Edit:
    def edit(file: h5py.File) -> None:
        file.attrs[name] = value

    return edit


def edit_value(name: str, index: int | tuple[int, ...], value: object) -> Edit:
    def edit(file: h5py.File) -> None:
        file[name][index] = value

    return edit


def edit_dataset_attribute(file: h5py.File) -> None:
    file["cut_mass_t"].attrs["units"] = "kg"


def delete_dataset(file: h5py.File) -> None:
    del file["cut_mass_t"]


def add_dataset(file: h5py.File) -> None:
    file["surplus"] = 1.0


def delete_attribute(file: h5py.File) -> None:
    del file.attrs["complete"]


def change_type(file: h5py.File) -> None:
    values = file["cut_mass_t"][()]
    del file["cut_mass_t"]
    file.create_dataset("cut_mass_t", data=values.astype(np.float32), chunks=values.shape, fletcher32=True)


def change_shape(file: h5py.File) -> None:
    values = file["cut_mass_t"][()]
    del file["cut_mass_t"]
    file.create_dataset("cut_mass_t", data=values[:, np.newaxis], chunks=(2, 1), fletcher32=True)


@pytest.mark.parametrize(
    ("edit", "error", "reason"),
    [
        (edit_attribute("format", "kea-image"), UnknownFormat, "format is"),
        (edit_attribute("version", 2), NewerVersion, "version is 2"),
        (edit_attribute("version", 0), DamagedTable, "version is 0"),
        (edit_attribute("version", "1"), DamagedTable, "version is '1'"),
        (edit_attribute("kind", "passages"), DamagedTable, "missing or unknown"),
        (edit_attribute("kind", "aim"), DamagedTable, "kind is 'aim'"),
        (edit_attribute("complete", 0), DamagedTable, "complete is 0"),
        (edit_attribute("exported_by", "9"), DamagedTable, "payload_sha256"),
        (edit_attribute("payload_sha256", "0" * 64), DamagedTable, "payload_sha256"),
        (edit_attribute("surplus", 1), DamagedTable, "root attributes"),
        (edit_value("stage_lower", (0, 1, 0), 5.25), DamagedTable, "payload_sha256"),
        (edit_value("cut_mass_t", 0, 85.0), DamagedTable, "payload_sha256"),
        (edit_value("id", 0, b"other"), DamagedTable, "payload_sha256"),
        (edit_dataset_attribute, DamagedTable, "other units than 't'"),
        (delete_dataset, DamagedTable, "cut_mass_t"),
        (add_dataset, DamagedTable, "surplus"),
        (delete_attribute, DamagedTable, "root attributes"),
        (change_type, DamagedTable, "cut_mass_t is float32"),
        (change_shape, DamagedTable, r"cut_mass_t is float64 \(2, 1\)"),
    ],
)
def test_an_edited_book_is_refused_even_when_sealed_anew(
    book: Path, edit: Edit, error: type[TableError], reason: str
) -> None:
    with h5py.File(book, "r+") as file:
        edit(file)
    with pytest.raises(DamagedTable, match="no seal"):
        read_book(book)
    book.write_bytes(book.read_bytes() + seal_of(book.read_bytes()))
    with pytest.raises(TableError, match=reason) as caught:
        read_book(book)
    assert type(caught.value) is error
    assert str(caught.value).startswith(str(book))


def test_values_that_make_no_table_are_refused_even_under_a_right_checksum(
    linear_table: ControllerTable, tmp_path: Path
) -> None:
    path = tmp_path / "book.h5"
    forged = replace(linear_table)
    object.__setattr__(forged, "target_speed_m_s", -4.0)
    write_book([forged], path)
    with pytest.raises(DamagedTable, match="target_speed_m_s"):
        read_book(path)


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


def test_other_files_are_refused(tmp_path: Path, table: ControllerTable) -> None:
    path = tmp_path / "other.h5"
    for content, error in [
        (b"", DamagedTable),
        (b"\x89HDF\r\n\x1a\n", DamagedTable),
        (b"\x89HDF\r\n\x1a\n" + seal_of(b"\x89HDF\r\n\x1a\n"), DamagedTable),
        (to_json(table), UnknownFormat),
    ]:
        path.write_bytes(content)
        with pytest.raises(error):
            read_book(path)
    with h5py.File(path, "w") as file:
        file["x"] = 1.0
    path.write_bytes(path.read_bytes() + seal_of(path.read_bytes()))
    with pytest.raises(UnknownFormat, match="format is None"):
        read_book(path)
    shutil.rmtree(tmp_path)
    with pytest.raises(FileNotFoundError):
        read_book(path)
