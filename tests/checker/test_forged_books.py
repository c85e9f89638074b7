"""A book that the reader refuses is refused by the checker too, although every sum in it is right."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from synth.checker.finding import Kind
from synth.checker.source import read_source
from tests.effort import sized
from tests.tuning_tables.forged_book import forge, put
from tuning_tables import TableError, read_book, write_book
from tuning_tables.book_layout import Layout, book_layout

Edit = Callable[[Any], None]


@pytest.fixture(scope="module")
def mixed(estimated_once: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A book of the table of a tune with estimator, and of one that is shorter in every array; not to be changed."""
    first, _ = read_book(estimated_once / "book.h5")
    shorter = replace(
        first,
        id="shorter",
        cut=replace(first.cut, axle_offsets_m=first.cut.axle_offsets_m[:-1]),
        stages=(*first.stages[:-2], replace(first.stages[-2], upper=None)),
        estimator=None,
        validated=None,
        predicted=replace(first.predicted, passes=None),
    )
    path = tmp_path_factory.mktemp("mixed") / "book.h5"
    write_book([first, shorter], path)
    assert read_source(path).findings == ()
    return path


def refused(original: Path, path: Path, edit: Edit) -> None:
    """Both the reader and the checker refuse the book with `edit` done to it, the checker as damaged."""
    path.write_bytes(original.read_bytes())
    forge(path, edit)
    with pytest.raises(TableError):
        read_book(path)
    (finding,) = read_source(path).findings
    assert finding.kind is Kind.DAMAGED
    assert len(finding.sentence) < 400


def numbered(axis: str, values: Callable[[int], Any]) -> Edit:
    def edit(file: Any) -> None:
        length = file[axis].shape[0]
        del file[axis]
        file.create_dataset(axis, data=values(length))

    return edit


@pytest.fixture(scope="module")
def layout(mixed: Path) -> Layout:
    return book_layout(read_book(mixed))


def test_an_axis_that_does_not_number_from_0(mixed: Path, layout: Layout, tmp_path: Path) -> None:
    makers: tuple[Callable[[int], Any], ...] = (
        lambda n: np.zeros(n, "<i4") if n > 1 else np.ones(n, "<i4"),
        lambda n: np.arange(1, n + 1, dtype="<i4"),
        lambda n: np.arange(n + 1, dtype="<i4"),
        lambda n: np.arange(float(n)),
        lambda n: "none",
    )
    for axis in list(layout.axes)[:: sized(3, 1)]:
        for values in makers:
            refused(mixed, tmp_path / "book.h5", numbered(axis, values))


def test_a_column_of_another_type_unit_or_length(mixed: Path, layout: Layout, tmp_path: Path) -> None:
    def other_unit(name: str) -> Edit:
        def edit(file: Any) -> None:
            file[name].attrs["units"] = "furlong"

        return edit

    def wider(name: str, dtype: str) -> Edit:
        return lambda file: put(file, name, file[name][()].astype(dtype))

    def longer(name: str, axis: int) -> Edit:
        def edit(file: Any) -> None:
            values = file[name][()]
            put(file, name, np.concatenate([values, np.take(values, [-1], axis=axis)], axis=axis))

        return edit

    for column in layout.columns[:: sized(8, 1)]:
        dtype = {"S": "S90", "<f8": "<f4", "<f4": "<f8"}.get(column.dtype, "<i2")
        edits = [other_unit(column.name), wider(column.name, dtype)]
        for edit in (*edits, *(longer(column.name, axis) for axis in range(len(column.axes)))):
            refused(mixed, tmp_path / "book.h5", edit)


@pytest.mark.parametrize("axis", ["zone", "axle", "stage", "power", "break"])
def test_arrays_longer_than_the_longest_table(mixed: Path, layout: Layout, tmp_path: Path, axis: str) -> None:
    def edit(file: Any) -> None:
        for column in layout.columns:
            if axis in column.axes:
                values, place = file[column.name][()], column.axes.index(axis)
                filler = np.full_like(np.take(values, [0], axis=place), np.nan if values.dtype.kind == "f" else 0)
                put(file, column.name, np.concatenate([values, filler], axis=place))
        numbered(axis, lambda length: np.arange(length + 1, dtype="<i4"))(file)

    refused(mixed, tmp_path / "book.h5", edit)


def cell(name: str, index: tuple[int, ...], value: float) -> Edit:
    def edit(file: Any) -> None:
        file[name][index] = value

    return edit


@pytest.mark.parametrize(
    ("name", "index", "value"),
    [("cut_axle_offsets_m", (0, 1), np.nan), ("stage_pressure_kpa", (1, -1), 1), ("stage_k", (1, -1), 1),
     ("stage_lower", (1, -1, 0), 1), ("stage_lower", (0, 0, 0), 1), ("stages", (0,), 99), ("stages", (1,), -1),
     ("validated", (0,), 2), ("validated", (0,), 0), ("validated_rms_m_s", (1,), 1), ("estimator", (0,), 2),
     ("validated_rms_ci95_m_s", (1, 0), 1), ("estimator_s_m", (1, 0), 1), ("estimator_path_std", (1,), 1),
     ("estimator_frozen_readings", (1,), 1), ("estimator_unlikely_deviation", (1,), 1)],
)  # fmt: skip
def test_nothing_stands_beside_the_tables(
    mixed: Path, tmp_path: Path, name: str, index: tuple[int, ...], value: float
) -> None:
    refused(mixed, tmp_path / "book.h5", cell(name, index, value))


@pytest.mark.parametrize("value", [-0.0, np.inf, -np.inf])
def test_a_number_that_is_none(mixed: Path, layout: Layout, tmp_path: Path, value: float) -> None:
    for column in layout.columns[:: sized(4, 1)]:
        if "f" in column.dtype and "slope" not in column.name:
            index = (0, 1, *(0 for _ in column.axes[2:])) if "stage" in column.axes else (0,) * len(column.axes)
            refused(mixed, tmp_path / "book.h5", cell(column.name, index, value))


def test_columns_of_a_section_that_no_table_has(mixed: Path, tmp_path: Path) -> None:
    def edit(file: Any) -> None:
        for name in list(file):
            if name == "estimator" or name.startswith("estimator_"):
                put(file, name, file[name][()] * 0 + (np.nan if file[name].dtype.kind == "f" else 0))

    refused(mixed, tmp_path / "book.h5", edit)


@pytest.mark.parametrize(
    ("name", "value"),
    [("complete", True), ("complete", [1]), ("complete", 1.0), ("version", 2.0), ("version", [1]),
     ("version", 2), ("version", 0), ("kind", "passages"), ("kind", "aim"), ("kind", 1),
     ("format", ["retarder-book"]), ("format", np.bytes_(b"retarder-book")), ("config_sha256", "0" * 63),
     ("config_sha256", 0), ("exported_by", ""), ("exported_by", "two\nlines"), ("exported_by", 0.1)],
    ids=repr,
)  # fmt: skip
def test_a_root_attribute_of_another_kind(mixed: Path, tmp_path: Path, name: str, value: Any) -> None:
    def edit(file: Any) -> None:
        del file.attrs[name]
        file.attrs[name] = value

    refused(mixed, tmp_path / "book.h5", edit)
