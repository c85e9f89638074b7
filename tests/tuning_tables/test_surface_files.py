"""Tables that decide at any time, with and without slopes, in JSON, in a book and as CSV."""

import csv
import io
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import h5py
import numpy as np
import pytest

from tests.tuning_tables.every_kind import Document, document_of, sealed
from tests.tuning_tables.test_surfaces import with_stage
from tuning_tables import (
    ControllerTable,
    DamagedTable,
    Decisions,
    from_json,
    read_book,
    to_csv,
    to_json,
    write_book,
)

SLOPES = ["lower_slope_m_s_per_kpa", "upper_slope_m_s_per_kpa"]


def at_any_time(table: ControllerTable) -> ControllerTable:
    return replace(table, id=f"{table.id}-at-any-time", decisions=Decisions.AT_ANY_TIME)


@pytest.fixture(scope="module")
def tilted_estimate(surface_estimate: ControllerTable) -> ControllerTable:
    """With estimator, approach and a gauge."""
    first, second = surface_estimate.stages
    stages = (replace(first, upper_slope_m_s_per_kpa=-0.0078125), replace(second, lower_slope_m_s_per_kpa=-0.015625))
    return replace(surface_estimate, id="tilted-estimate", stages=stages)


def test_a_slope_that_is_a_whole_number_is_read_from_its_own_text(surface_table: ControllerTable) -> None:
    flat = with_stage(surface_table, 0, upper_slope_m_s_per_kpa=0)
    assert flat == with_stage(surface_table, 0, upper_slope_m_s_per_kpa=0.0)
    assert to_json(flat) == to_json(with_stage(surface_table, 0, upper_slope_m_s_per_kpa=0.0))
    assert from_json(to_json(flat)) == flat


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda d: d.update(decisions="at_rest"), "decisions are at rest"),
        (lambda d: d.update(decisions="at_sensor_passages"), '"at_rest" or "at_any_time"'),
        (lambda d: d["stages"][1].update({SLOPES[0]: None}), r"stages\[1\]\.lower_slope_m_s_per_kpa is missing, but"),
        (lambda d: d["stages"][0].update({SLOPES[0]: 0.5}), r"stages\[0\]\.lower is null"),
        (lambda d: d["stages"][1].update({SLOPES[1]: 0.1}), r"stages\[1\]\.upper_slope.* float32 cannot hold"),
        (lambda d: d["stages"][1].update({SLOPES[1]: 1e39}), r"stages\[1\]\.upper_slope.* float32 cannot hold"),
        (lambda d: d["stages"][1].update({SLOPES[1]: -0.0625}), r"stages\[1\]: upper - lower comes down to"),
        (lambda d: d["stages"][3].update(pressure_kpa=1e39), r"stages\[3\]\.pressure_kpa is 1e\+39, which exceeds"),
    ],
)
def test_slopes_that_make_no_table_are_refused(
    surface_table: ControllerTable, change: Callable[[Document], object], reason: str
) -> None:
    document = document_of(surface_table)
    change(document)
    with pytest.raises(DamagedTable, match=reason):
        from_json(sealed(document), source="t.json")


def test_csv_has_the_slopes_and_says_what_it_is(surface_table: ControllerTable) -> None:
    rows = list(csv.DictReader(io.StringIO(to_csv(surface_table).decode("utf-8"), newline="")))
    cells = {row["key"]: row["value0"] for row in rows if row["record"] in ("text", "number")}
    assert (cells["decisions"], cells["kind"]) == ("at_any_time", "lines")
    slopes = {
        (stage.k, f"{side}_slope_m_s_per_kpa"): slope
        for stage in surface_table.stages
        for side, slope in zip(("lower", "upper"), stage.slopes, strict=True)
        if slope is not None
    }
    assert len(slopes) == 5
    assert {key: float(cells.pop(f"stages.{key[0]}.{key[1]}")) for key in slopes} == slopes
    assert not any("slope" in key for key in cells)


def test_a_book_holds_tables_at_rest_and_at_any_time(
    table: ControllerTable,
    linear_table: ControllerTable,
    approached_table: ControllerTable,
    estimated_table: ControllerTable,
    surface_table: ControllerTable,
    surface_estimate: ControllerTable,
    tilted_estimate: ControllerTable,
    tmp_path: Path,
) -> None:
    path = tmp_path / "book.h5"
    mixed = (table, surface_table, estimated_table, surface_estimate, approached_table, tilted_estimate)
    for tables in ((surface_table,), (surface_estimate,), (linear_table, at_any_time(linear_table)), mixed):
        write_book(tables, path)
        assert read_book(path) == tables
        assert [to_json(read) for read in read_book(path)] == [to_json(each) for each in tables]
        with h5py.File(path) as file:
            assert ("break" in file) == any(each.estimator is not None for each in tables)
            words = [b"at_any_time" if each.decisions is Decisions.AT_ANY_TIME else b"at_rest" for each in tables]
            assert file["decisions"][:].tolist() == words
            for side in ("lower", "upper"):
                stored = file[f"stage_{side}_slope_m_s_per_kpa"]
                assert stored.dtype.str == "<f4"
                for each, slopes in zip(tables, stored[:], strict=True):
                    own = [getattr(stage, f"{side}_slope_m_s_per_kpa") for stage in each.stages]
                    wanted = np.array([np.nan if slope is None else slope for slope in own])
                    assert np.array_equal(slopes[: len(each.stages)], wanted, equal_nan=True)
                    assert np.isnan(slopes[len(each.stages) :]).all()


def test_slopes_keep_their_last_bit(surface_table: ControllerTable, tmp_path: Path) -> None:
    tiny = [float(np.float32(value)) for value in (1e-45, -1.1754942e-38, -3.0e-39)]
    original = with_stage(surface_table, 0, upper_slope_m_s_per_kpa=tiny[0])
    original = with_stage(original, 1, lower_slope_m_s_per_kpa=tiny[1], upper_slope_m_s_per_kpa=tiny[2])
    write_book([original], tmp_path / "book.h5")
    (from_book,) = read_book(tmp_path / "book.h5")
    for read in (from_book, from_json(to_json(original)), from_json(sealed(json.loads(to_json(original))))):
        assert read == original
        assert read.slopes.tobytes() == original.slopes.tobytes()
