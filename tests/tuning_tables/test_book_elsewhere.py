"""A book is understood by h5py and by xarray without a line of this project: names, units, coordinates, text."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pytest

from tuning_tables import ControllerTable, decide_many, write_book

if TYPE_CHECKING:
    import xarray


@pytest.fixture
def book(table: ControllerTable, linear_table: ControllerTable, tmp_path: Path) -> Path:
    path = tmp_path / "book.h5"
    write_book([table, linear_table], path)
    return path


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


@pytest.fixture
def surface_book(table: ControllerTable, surface_table: ControllerTable, tmp_path: Path) -> Path:
    """A book with a table at rest and one at any time, with slopes."""
    path = tmp_path / "surfaces.h5"
    write_book([table, surface_table], path)
    return path


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
