"""Tables, passes and results as xarray and pandas: values are those of files and rules, and units come with them."""

from __future__ import annotations

import io
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas
import pytest
import xarray

import synth
from synth.api.passes import Simulated
from synth.frame.exhibits import Table
from synth.frame.sheet import to_csv
from synth.retarder.shown.results import CONTROLLER, controller_row
from tests.controller_code.passage_tables import passage_book
from tests.controller_code.sample_book import approaching_book, estimating_book, sample_book, surface_book
from tests.synth.case_factory import make_plant, make_sample, make_trace, measured
from tests.tuning_tables.aim.made_tables import category_table, measured_table
from tuning_tables import decide_many, write_book
from tuning_tables.aim import AimTables
from tuning_tables.document import StageTable
from tuning_tables.pass_log import PassLog
from tuning_tables.table_book import TableBook
from tuning_tables.units import unit_of

BOOKS: dict[str, Callable[[], tuple[StageTable, ...]]] = {
    "plain": lambda: sample_book().tables,
    "estimated": lambda: estimating_book().tables,
    "approached": lambda: approaching_book().tables,
    "gauged": lambda: surface_book().tables,
    "point sensors": lambda: passage_book().tables,
}


def two_passes() -> PassLog:
    """Passes of 2 and of 4 rows."""
    return PassLog(
        time_s=np.arange(6.0), path_m=np.arange(6.0), speed_m_s=np.full(6, 5.0), pressure_kpa=np.zeros(6),
        stage=np.array([0, 1, 2, 3, 4, 5]), first_row=np.array([0, 2, 6]), cut_id=("one", "two"),
        mass_t=np.array([22.0, 52.0]), axles=np.array([4, 8]), category=("Л", "С"), target_m_s=np.array([2.0, 3.0]),
        stopped_by_hand=np.array([False, True]),
    )  # fmt: skip


@pytest.mark.parametrize("tables", BOOKS.values(), ids=list(BOOKS))
def test_a_dataset_is_the_book_as_xarray_reads_it(tables: Callable[[], tuple[StageTable, ...]], tmp_path: Path) -> None:
    write_book(tables(), tmp_path / "book.h5")
    book = xarray.load_dataset(tmp_path / "book.h5", engine="h5netcdf").set_index(table="id")
    found = synth.to_xarray(tables())
    assert found[list(book.data_vars)].equals(book)
    for name, variable in book.data_vars.items():
        assert found[name].attrs.get("units", "1") == variable.attrs["units"]
        assert found[name].attrs["long_name"] == variable.attrs["meaning"]


@pytest.mark.parametrize("book", [sample_book, approaching_book, surface_book])
def test_the_rule_turns_at_the_lines(book: Callable[[], TableBook]) -> None:
    turned = 0
    for table in book().tables:
        found = synth.to_xarray(table)
        for stage in range(len(table.stages)):
            for name, outside in (("lower_m_s", -1), ("upper_m_s", 1)):
                line = found[name].sel(stage=stage).dropna("path_m")
                line = line[(line > 0.1) & (line < 20.0)]
                beyond = decide_many(table, stage, line.path_m, line + 1e-5 * outside)
                before = decide_many(table, stage, line.path_m, line - 1e-5 * outside)
                assert ((beyond - stage) * outside >= 1).all()
                assert ((before - stage) * outside <= 0).all()
                turned += line.size
    assert turned > 1000


def test_netcdf_gives_the_same_tables_again(tmp_path: Path) -> None:
    found = synth.to_xarray(surface_book().tables)
    found.to_netcdf(tmp_path / "tables.nc", engine="h5netcdf")
    assert xarray.load_dataset(tmp_path / "tables.nc", engine="h5netcdf").identical(found)


ARRAYS: dict[str, Callable[[], xarray.Dataset]] = {
    "aim": lambda: synth.to_xarray(category_table()),
    "aim, measured": lambda: synth.to_xarray(measured_table()),
    "simulated": lambda: synth.to_xarray(Simulated(3.0, 1, make_sample(3.0, 0.1, 1))),
    "trace": lambda: synth.to_xarray(make_trace(make_plant(52.0, 5), 3.0, 1.0)),
    "log": lambda: synth.to_xarray(two_passes()),
}


@pytest.mark.parametrize("made", ARRAYS.values(), ids=list(ARRAYS))
def test_every_array_has_its_unit_and_a_name(made: Callable[[], xarray.Dataset], tmp_path: Path) -> None:
    found = made()
    for name, variable in found.variables.items():
        assert variable.attrs.get("units", "1") == unit_of(str(name))
        assert variable.attrs["long_name"]
    found.to_netcdf(tmp_path / "arrays.nc", engine="h5netcdf")
    assert xarray.load_dataset(tmp_path / "arrays.nc", engine="h5netcdf").identical(found)


def test_the_samples_of_a_log_are_its_rows() -> None:
    log = two_passes()
    found = synth.to_xarray(log)
    for number in range(len(log)):
        one = found.isel(pass_number=number).dropna("sample", subset=["time_s"])
        for name in ("time_s", "path_m", "speed_m_s", "pressure_kpa", "stage"):
            assert one[name].values.tolist() == getattr(log, name)[log.rows(number)].tolist()
    assert synth.to_pandas(log).mass_t.tolist() == [22.0, 52.0]


def test_the_nodes_of_an_aim_table_are_those_that_it_holds() -> None:
    table = measured_table()
    found = synth.to_xarray(table)
    assert found.exit_speed_m_s.dims == ("cars", "free_distance_m", "resistance_n_per_kn")
    assert np.array_equal(found.exit_speed_m_s, table.exit_speed_m_s, equal_nan=True)
    assert found.cars.values.tolist() == table.axes.cars.tolist()
    assert synth.to_pandas(table).exit_speed_m_s.tolist() == pytest.approx(table.exit_speed_m_s.ravel(), nan_ok=True)


def test_a_frame_is_the_sheet_of_the_command() -> None:
    """Every figure with its interval, and units as the columns of the command declare them."""
    sample = make_sample(3.0, 0.1, 1)
    laws = [measured(name, make_sample(3.1, spread, 2), sample, 3.0) for name, spread in (("a", 0.2), ("b", 0.3))]
    found = synth.to_pandas(laws)
    sheet = to_csv(Table("controllers", "", CONTROLLER, [controller_row(each) for each in laws]))
    pandas.testing.assert_frame_equal(found, pandas.read_csv(io.BytesIO(sheet)), check_dtype=False)
    assert found.rms_m_s.tolist() == [each.statistics.rms_m_s for each in laws]
    assert found.attrs["units"].keys() == {name for name in found if "_m_s" in name or name.startswith("time_s")} - {
        name for name in found if name.endswith("_n")
    }
    (alone,) = synth.to_pandas(laws[0].statistics).p95_m_s_high95
    assert alone == laws[0].statistics.p95_ci95_m_s[1]


def test_tables_are_rows_by_their_ids() -> None:
    tables = sample_book().tables
    found = synth.to_pandas(tables)
    assert found.index.tolist() == [table.id for table in tables]
    assert found.predicted_rms_m_s.tolist() == [table.predicted.rms_m_s for table in tables]
    assert found.attrs["units"]["predicted_rms_m_s"] == "m/s"


def test_figures_of_aim_tables_are_those_of_the_command() -> None:
    aims = AimTables((category_table(), measured_table()))
    assert list(synth.figures(aims)) == ["aim-commands-by-cars", "aim-commands-by-resistance"]


def test_what_cannot_be_is_told_in_one_sentence(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(TypeError, match="str is no result with pictures"):
        synth.figures("x")  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="str is neither a table nor passes"):
        synth.to_xarray("table")  # type: ignore[arg-type]
    monkeypatch.setitem(sys.modules, "xarray", None)
    for give in (synth.to_xarray, synth.to_pandas):
        with pytest.raises(synth.InputError, match=r"needs xarray: pip install 'retarder-synth\[xarray\]'$"):
            give(two_passes())
