"""A book keeps every bit of its tables, hides no damage, and is understood by h5py and xarray without this
project.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING

import h5py
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.effort import sized
from tests.tuning_tables.random_tables import tables
from tuning_tables import (
    ControllerTable,
    DamagedTable,
    Generator,
    InvalidTable,
    Stage,
    UnknownFormat,
    decide_many,
    from_json,
    read_book,
    to_csv,
    to_json,
    write_book,
)

if TYPE_CHECKING:
    import xarray


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
    for refused in ([], [table, table], [table, other]):
        with pytest.raises(InvalidTable):
            write_book(refused, path)
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


BINDER = Generator("binder", "1", "0" * 64)
slowly = settings(
    derandomize=True,
    max_examples=sized(7, 30),
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture, HealthCheck.too_slow, HealthCheck.data_too_large],
)


def bits(table: ControllerTable) -> tuple[bytes | str, ...]:
    """Every bit that a decision or a reader of the table depends on."""
    arrays = (table.coefficients, table.has_line, table.valid_range, table.slopes, table.pressures)
    return (
        to_json(table),
        str(table.entrance_stage),
        *(array.tobytes() for array in arrays),
        *(array.dtype.str for array in arrays),
    )


@pytest.mark.requirement("FILE-05")
@given(st.lists(tables(), min_size=1, max_size=3, unique_by=lambda table: table.id))
@slowly
def test_json_and_book_hold_the_same_bits(tmp_path: Path, originals: list[ControllerTable]) -> None:
    path = tmp_path / "book.h5"
    from_texts = [from_json(to_json(table)) for table in originals]
    assert from_texts == originals
    write_book(from_texts, path, BINDER)
    content = path.read_bytes()
    from_book = read_book(path)
    assert list(from_book) == originals
    assert [bits(table) for table in from_book] == [bits(table) for table in originals]
    write_book([from_json(to_json(table)) for table in from_book], path, BINDER)
    assert path.read_bytes() == content


def with_stage(table: ControllerTable, stage: Stage) -> ControllerTable:
    return replace(table, stages=tuple(stage if s.k == stage.k else s for s in table.stages))


SIGNED_ZEROS = (
    lambda table: with_stage(table, replace(table.stages[0], upper=(6.0, 0.0, -0.0, 0.0))),
    lambda table: with_stage(table, replace(table.stages[2], lower=(-0.0, 0.0, 0.0, 0.0))),
    lambda table: replace(table, cut=replace(table.cut, axle_offsets_m=(-0.0, 1.0))),
    lambda table: table.with_validated(replace(table.validated, rms_ci95_m_s=(-0.0, 1.0))),
    lambda table: replace(table, predicted=replace(table.predicted, bias_m_s=-0.0)),
)


def test_no_format_takes_a_zero_with_a_sign(table: ControllerTable, tmp_path: Path) -> None:
    # Were they written, JSON's checksum would not cover the sign, and the book's would.
    exports = (to_json, to_csv, lambda signed: write_book([signed], tmp_path / "book.h5"))
    for change in SIGNED_ZEROS:
        for export in exports:
            with pytest.raises(InvalidTable, match=r"-0\.0"):
                export(change(table))
    assert not (tmp_path / "book.h5").exists()


WITH_SLOPES = """
import sys
sys.modules["tuning_tables"] = None
import h5py
with h5py.File(sys.argv[1], "r") as book:
    row = book["id"].asstr()[:].tolist().index("surface")
    names = ("stage_lower", "stage_pressure_kpa", "stage_lower_slope_m_s_per_kpa")
    lines, kpa, slopes = (book[name][row] for name in names)
    speed = sum(c * 4.0**i for i, c in enumerate(lines[1])) + slopes[1] * (kpa[2] - kpa[1])
    axes = [dimension[0].name[1:] for dimension in book[names[2]].dims]
    print(axes, book[names[2]].attrs["units"], book["decisions"].asstr()[:].tolist(), round(float(speed), 4))
"""


def test_bare_h5py_reads_a_surface(surface_book: Path) -> None:
    command = [sys.executable, "-c", WITH_SLOPES, str(surface_book)]
    ended = subprocess.run(command, capture_output=True, text=True, check=True, cwd=surface_book.parent)
    # 5.2 - 0.04 * 4 + 5e-4 * 16 - 1e-5 * 64 - 0.006 * 150
    assert ended.stdout == "['table', 'stage'] m/s per kPa ['at_rest', 'at_any_time'] 4.1474\n"


def test_a_decision_on_a_surface_with_xarray_is_that_of_the_rule(
    surface_book: Path, surface_table: ControllerTable
) -> None:
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    with xarray.open_dataset(surface_book, engine="h5netcdf") as opened:
        one = opened.load().set_index(table="id").sel(table="surface").isel(stage=1)
    speeds = np.linspace(3.0, 7.0, 401)
    lines = [(one[f"stage_{side}"] * 4.0**one.power).sum("power") for side in ("lower", "upper")]
    slopes = [one[f"stage_{side}_slope_m_s_per_kpa"] for side in ("lower", "upper")]
    for kpa in (0.0, 80.0, 150.0, 220.0, 300.0):
        rise_kpa = kpa - one.stage_pressure_kpa
        lower, upper = (float(line + slope * rise_kpa) for line, slope in zip(lines, slopes, strict=True))
        answers = np.where(speeds < lower, 0, np.where(speeds > upper, 2, 1))
        assert len(set(answers.tolist())) == 3
        assert np.array_equal(answers, decide_many(surface_table, 1, 4.0, speeds, kpa))


@pytest.fixture
def dataset(book: Path) -> Iterator[xarray.Dataset]:
    xarray = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    with xarray.open_dataset(book, engine="h5netcdf") as opened:
        yield opened.load()


def test_xarray_knows_axes_and_coordinates(dataset: xarray.Dataset, table: ControllerTable) -> None:
    assert dict(dataset.sizes) == {"table": 2, "stage": 4, "power": 4, "zone": 2, "axle": 4, "end": 2}
    assert dataset.stage_lower.dims == ("table", "stage", "power")
    for axis, length in dataset.sizes.items():
        assert dataset.indexes[axis].tolist() == list(range(length))
        assert dataset[axis].attrs["meaning"]
    assert set(dataset.coords) - set(dataset.sizes) == {"id", "cut_category", "cut_mass_t", "target_speed_m_s"}
    assert {"id", "cut_category", "cut_mass_t", "target_speed_m_s"} < set(dataset.stage_lower.coords)
    lines = dataset.set_index(table="id").stage_lower.sel(table="leer-22t-4.0")
    assert np.array_equal(lines, table.coefficients[:, 0], equal_nan=True)
    assert lines.dtype == np.float32


def test_xarray_knows_units_and_text(dataset: xarray.Dataset) -> None:
    assert {
        name: dataset[name].attrs["units"] for name in ("cut_mass_t", "stage_pressure_kpa", "valid_s_m", "degree")
    } == {
        "cut_mass_t": "t",
        "stage_pressure_kpa": "kPa",
        "valid_s_m": "m",
        "degree": "1",
    }
    assert all(variable.attrs["units"] and variable.attrs["meaning"] for variable in dataset.data_vars.values())
    assert dataset.id.values.tolist() == ["leer-22t-4.0", "linear"]
    assert dataset.retarder_name.values.tolist() == ["Talbremse Süd"] * 2
    assert dataset.attrs["format"] == "retarder-book"


def test_what_a_table_does_not_have_is_nan_or_0(dataset: xarray.Dataset) -> None:
    linear = dataset.isel(table=1)
    assert linear.stage_pressure_kpa.isnull().values.tolist() == [False, False, True, True]
    assert not linear.stage_lower.isel(stage=0).notnull().any()
    assert linear.stage_upper.isel(stage=0).notnull().values.tolist() == [True, True, False, False]
    assert linear.validated_passes == 0
    assert (int(linear.validated), int(linear.approach), int(linear.estimator)) == (0, 0, 0)


def test_xarray_can_write_it_on(dataset: xarray.Dataset, tmp_path: Path) -> None:
    xarray = pytest.importorskip("xarray")
    dataset.drop_encoding().to_netcdf(tmp_path / "again.nc", engine="h5netcdf")
    with xarray.open_dataset(tmp_path / "again.nc", engine="h5netcdf") as again:
        assert again.load().equals(dataset)
