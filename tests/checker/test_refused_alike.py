"""Whatever the reader of tables and books refuses, the checker finds too, by its own reading."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np
import pytest

from synth.checker.finding import Kind
from synth.checker.source import read_source
from tests.checker.any_time_tables import approached, estimated, sloped, sound_table, with_stage_out_of_use
from tests.checker.planted_fault import look
from tests.effort import sized
from tests.tuning_tables.every_kind import (
    SAMPLES,
    Document,
    JsonPath,
    altered,
    document_of,
    dotted,
    leaves_of,
    places,
    sealed,
    too_far,
    value_at,
)
from tests.tuning_tables.forged_book import forge, put
from tuning_tables import TableError, from_json, read_book, write_book
from tuning_tables.book_layout import Layout, book_layout
from tuning_tables.document import AnyTable

SOUND: Final[Mapping[str, Callable[[], AnyTable]]] = {
    "lines": lambda: sound_table("plain"),
    "whole": lambda: approached(estimated(with_stage_out_of_use(sloped(sound_table("plain"))))),
    **{name: make for name, make in SAMPLES.items() if "points" in name or "aim" in name},
}
"""Tables in whose numbers the checker finds no fault."""

WRONG: Final[tuple[object, ...]] = (None, True, "4", [], {}, -1, 0.5)


def wrong_documents(table: AnyTable) -> Iterator[tuple[str, Document]]:
    """Documents with a member of another type, beyond its limits, backwards, left out, or too many; what is wrong."""
    document = document_of(table)
    paths = [path for path in places(document) if path != ("crc32",)]
    cases: list[tuple[JsonPath, object]] = [(path, value) for path in paths for value in WRONG]
    for path, leaf in leaves_of(type(table)):
        parent = value_at(document, path[:-1]) if all_there(document, path) else None
        cases += [(path, value) for value in too_far(leaf)] if parent is not None else []
    for path in ((), *paths):
        content = value_at(document, path)
        if isinstance(content, dict):
            for key in sorted(content.keys() - {"crc32"}):
                less = {name: each for name, each in content.items() if name != key}
                yield f"{dotted(path)} lacks {key}", altered(document, path, less) if path else less
            more = {**content, "surplus": 1}
            yield f"{dotted(path)} has a surplus", altered(document, path, more) if path else more
        elif isinstance(content, list):
            cases.append((path, content[::-1]))
    yield from ((f"{dotted(path)} is {value!r}", altered(document, path, value)) for path, value in cases)


def all_there(document: Document, path: JsonPath) -> bool:
    """Whether the table has the sections on the way."""
    return all(value_at(document, path[:end]) is not None for end in range(1, len(path)))


@pytest.mark.parametrize("name", SOUND)
def test_what_the_reader_refuses_of_any_member_the_checker_finds(name: str, tmp_path: Path) -> None:
    table, file = SOUND[name](), tmp_path / "table.json"
    file.write_bytes(sealed(document_of(table)))
    sound = {finding.sentence for finding in look(file).findings}
    refused, through = 0, []
    for wrong, document in wrong_documents(table):
        content = sealed(document)
        try:
            from_json(content, type(table))
        except TableError:
            refused += 1
            file.write_bytes(content)
            if not {finding.sentence for finding in look(file).findings} - sound:
                through.append(wrong)
    assert through == []
    assert refused > 300


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
