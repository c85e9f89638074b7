"""Tables that decide at any time, with and without slopes, in JSON, in a book and as CSV."""

import csv
import io
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

from tests.tuning_tables.test_approach import document_of, sealed
from tests.tuning_tables.test_surfaces import with_stage
from tuning_tables import (
    ControllerTable,
    DamagedTable,
    Decisions,
    OtherDecisions,
    Stage,
    from_json,
    read_book,
    to_csv,
    to_json,
    write_book,
)

Document = dict[str, Any]

SLOPES = ["lower_slope_m_s_per_kpa", "upper_slope_m_s_per_kpa"]
STAGE_KEYS = ["k", "pressure_kpa", "lower", "upper"]


def at_any_time(table: ControllerTable) -> ControllerTable:
    return replace(table, id=f"{table.id}-at-any-time", decisions=Decisions.AT_ANY_TIME)


@pytest.fixture(scope="module")
def tilted_estimate(surface_estimate: ControllerTable) -> ControllerTable:
    """With estimator, approach and a gauge."""
    first, second = surface_estimate.stages
    stages = (replace(first, upper_slope_m_s_per_kpa=-0.0078125), replace(second, lower_slope_m_s_per_kpa=-0.015625))
    return replace(surface_estimate, id="tilted-estimate", stages=stages)


def test_the_version_follows_from_the_times_of_decision(
    table: ControllerTable,
    estimated_table: ControllerTable,
    approached_table: ControllerTable,
    surface_table: ControllerTable,
    surface_estimate: ControllerTable,
) -> None:
    at_rest = (table, estimated_table, approached_table)
    assert [document_of(each)["version"] for each in at_rest] == [1, 2, 3]
    made = (*map(at_any_time, at_rest), surface_table, surface_estimate)
    for each in made:
        document = document_of(each)
        assert document["version"] == 5
        assert document["decisions"] == "at_any_time"
        assert document["pressure"] == ("gauge" if each is surface_table else "none")
        assert ("estimator" in document) == (each.estimator is not None)
        assert ("approach" in document) == (each.approach is not None)
        assert from_json(to_json(each)) == from_json(sealed(document)) == each


def test_keys_and_their_order_are_the_contract(
    surface_table: ControllerTable, surface_estimate: ControllerTable, tilted_estimate: ControllerTable
) -> None:
    gauge, without, both = map(document_of, (surface_table, surface_estimate, tilted_estimate))
    assert list(gauge)[-5:] == ["validated", "approach", "decisions", "pressure", "crc32"]
    assert list(without)[-6:] == list(both)[-6:] == ["validated", "estimator", *list(gauge)[-4:]]
    for stage in [*gauge["stages"], *both["stages"]]:
        assert list(stage) == STAGE_KEYS + SLOPES
        for side, slope in zip(("lower", "upper"), SLOPES, strict=True):
            assert (stage[side] is None) == (stage[slope] is None)
    assert [list(stage) for stage in without["stages"]] == [STAGE_KEYS] * 2
    # Each slope is the float32 number itself, as it reads back.
    assert gauge["stages"][1]["lower_slope_m_s_per_kpa"] == float(np.float32(-0.006))


def test_a_slope_that_is_a_whole_number_is_read_from_its_own_text(surface_table: ControllerTable) -> None:
    flat = with_stage(surface_table, 0, upper_slope_m_s_per_kpa=0)
    assert flat == with_stage(surface_table, 0, upper_slope_m_s_per_kpa=0.0)
    assert to_json(flat) == to_json(with_stage(surface_table, 0, upper_slope_m_s_per_kpa=0.0))
    assert from_json(to_json(flat)) == flat


def remove_slopes(document: Document) -> None:
    for stage in document["stages"]:
        for key in SLOPES:
            del stage[key]


def forget_slopes(document: Document) -> None:
    for stage in document["stages"]:
        stage.update(dict.fromkeys(SLOPES))


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        (lambda d: d.update(version=1), "unknown key 'approach'"),
        (lambda d: d.update(version=2), "estimator is missing"),
        (lambda d: d.update(version=3), "unknown key 'decisions'"),
        (lambda d: d.update(version=4), "decides at sensor passages"),
        (lambda d: d.pop("decisions"), "decisions is missing"),
        (lambda d: d.pop("pressure"), "pressure is missing"),
        (lambda d: d.update(decisions="at_rest"), "decisions is 'at_rest', but only \"at_any_time\" is allowed"),
        (lambda d: d.update(decisions="at_sensor_passages"), 'only "at_any_time" is allowed'),
        (lambda d: d.update(decisions=None), "decisions is None, but it must be a string"),
        (lambda d: d.update(pressure="Gauge"), 'only "gauge" and "none" are allowed'),
        (lambda d: d.update(pressure=None), "pressure is None, but it must be a string"),
        (lambda d: d.update(pressure=True), "pressure is True, but it must be a string"),
        (lambda d: d.update(pressure="none"), r"stages\[0\] has the unknown key 'lower_slope_m_s_per_kpa'"),
        (lambda d: d.update(gauge="none"), "unknown key 'gauge'"),
        (remove_slopes, r"stages\[0\]\.lower_slope_m_s_per_kpa is missing"),
        (forget_slopes, 'pressure is "gauge", but no line has a slope'),
        (lambda d: d["stages"][1].pop(SLOPES[0]), r"stages\[1\]\.lower_slope_m_s_per_kpa is missing"),
        (lambda d: d["stages"][1].update({SLOPES[0]: None}), r"stages\[1\]\.lower_slope_m_s_per_kpa is missing, but"),
        (lambda d: d["stages"][0].update({SLOPES[0]: 0.5}), r"stages\[0\]\.lower is null"),
        (lambda d: d["stages"][1].update({SLOPES[1]: 0.1}), r"stages\[1\]\.upper_slope.* float32 cannot hold"),
        (lambda d: d["stages"][1].update({SLOPES[1]: 1e39}), r"stages\[1\]\.upper_slope.* float32 cannot hold"),
        (lambda d: d["stages"][1].update({SLOPES[1]: "0.5"}), r"stages\[1\]\.upper_slope.* must be a number"),
        (lambda d: d["stages"][1].update({SLOPES[1]: [0.5]}), r"stages\[1\]\.upper_slope.* must be a number"),
        (lambda d: d["stages"][1].update({SLOPES[1]: False}), r"stages\[1\]\.upper_slope.* must be a number"),
        (lambda d: d["stages"][1].update({SLOPES[1]: -0.0625}), r"stages\[1\]: upper - lower comes down to"),
        (lambda d: d["stages"][3].update(pressure_kpa=1e39), r"stages\[3\]\.pressure_kpa is 1e\+39, which exceeds"),
        (lambda d: d["predicted"].update(passes=10), "unknown key 'passes'"),
    ],
)
def test_a_document_of_version_5_is_read_strictly(
    surface_table: ControllerTable, change: Callable[[Document], object], reason: str
) -> None:
    document = document_of(surface_table)
    change(document)
    with pytest.raises(OtherDecisions if document["version"] == 4 else DamagedTable, match=reason) as caught:
        from_json(sealed(document), source="t.json")
    assert str(caught.value).startswith("t.json: ")
    assert str(caught.value).isprintable()


def test_a_slope_of_minus_zero_is_refused_in_either_layout(surface_table: ControllerTable) -> None:
    flat = with_stage(surface_table, 0, upper_slope_m_s_per_kpa=0.0)
    assert to_json(flat).count(b'"upper_slope_m_s_per_kpa": 0.0}') == 1
    signed = to_json(flat).replace(b'"upper_slope_m_s_per_kpa": 0.0}', b'"upper_slope_m_s_per_kpa": -0.0}')
    with pytest.raises(DamagedTable, match=r"stages\[0\]\.upper_slope_m_s_per_kpa is -0\.0, but"):
        from_json(signed)


def test_a_table_without_a_single_line_has_no_gauge(surface_table: ControllerTable) -> None:
    bare = replace(surface_table, stages=(Stage(0, 0.0, None, None), Stage(1, 1.0, None, None)))
    document = document_of(bare)
    assert document["pressure"] == "none"
    for stage in document["stages"]:
        stage.update(dict.fromkeys(SLOPES))
    with pytest.raises(DamagedTable, match="no line has a slope"):
        from_json(sealed({**document, "pressure": "gauge"}))


def test_csv_has_the_slopes_and_says_what_it_is(surface_table: ControllerTable) -> None:
    rows = list(csv.DictReader(io.StringIO(to_csv(surface_table).decode("utf-8"), newline="")))
    cells = {row["key"]: row["value0"] for row in rows if row["record"] in ("text", "number")}
    assert (cells["decisions"], cells["pressure"], cells["version"]) == ("at_any_time", "gauge", "5")
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
            assert file.attrs["schema_version"] == 5
            assert ("break" in file) == any(each.estimator is not None for each in tables)
            deciding = [each.decisions is Decisions.AT_ANY_TIME for each in tables]
            assert file["at_any_time"][:].tolist() == deciding
            assert file["has_gauge"][:].tolist() == [each.has_gauge for each in tables]
            assert [file[name].dtype.str for name in ("at_any_time", "has_gauge", "slopes")] == ["|u1", "|u1", "<f4"]
            for each, slopes in zip(tables, file["slopes"][:], strict=True):
                assert np.array_equal(slopes[: len(each.stages)], each.slopes)
                assert np.isnan(slopes[len(each.stages) :]).all()


def test_a_book_of_tables_at_rest_is_of_no_version_5(approached_table: ControllerTable, tmp_path: Path) -> None:
    write_book((approached_table,), tmp_path / "book.h5")
    with h5py.File(tmp_path / "book.h5") as file:
        assert file.attrs["schema_version"] == 3
        assert {"at_any_time", "has_gauge", "slopes"}.isdisjoint(file)


def test_slopes_keep_their_last_bit(surface_table: ControllerTable, tmp_path: Path) -> None:
    tiny = [float(np.float32(value)) for value in (1e-45, -1.1754942e-38, -3.0e-39)]
    original = with_stage(surface_table, 0, upper_slope_m_s_per_kpa=tiny[0])
    original = with_stage(original, 1, lower_slope_m_s_per_kpa=tiny[1], upper_slope_m_s_per_kpa=tiny[2])
    write_book([original], tmp_path / "book.h5")
    (from_book,) = read_book(tmp_path / "book.h5")
    for read in (from_book, from_json(to_json(original)), from_json(sealed(json.loads(to_json(original))))):
        assert read == original
        assert read.slopes.tobytes() == original.slopes.tobytes()
