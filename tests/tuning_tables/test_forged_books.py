"""A book whose sums are right but whose content is not: each key, type, length and value is looked at by itself.

The faults follow from the declaration of the members: each test walks all columns of a book with lines and of one for
point sensors, and tells every fault that gets through, or is refused in other words.
"""

import random
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from itertools import cycle, islice
from typing import Any

import h5py
import numpy as np
import numpy.typing as npt
import pytest

from tests.effort import every
from tests.tuning_tables.every_kind import whole_lines
from tests.tuning_tables.forged_book import Edit, Forgery, arrays_in, delete, put, reseal, set_value
from tests.tuning_tables.passages.made_tables import table_of
from tuning_tables import (
    ControllerTable,
    DamagedTable,
    NewerVersion,
    TableError,
    UnknownFormat,
    read_any_book,
    write_book,
)
from tuning_tables.book_layout import book_layout
from tuning_tables.declared.columns import Column
from tuning_tables.passages.sensor_layout import DecidesOn

DTYPES = ("<f4", "<f8", ">f8", "<i4", "<i8", "|u1", "S70", "object", "reference")
NAN, INF = float("nan"), float("inf")


@pytest.fixture(scope="module", params=every(2, ["lines", "points"]))
def book(request: pytest.FixtureRequest, table: ControllerTable, tmp_path_factory: pytest.TempPathFactory) -> Forgery:
    """Two tables that differ in every length; of those with lines one has all that a table may have, one nothing."""
    every = replace(table_of(DecidesOn.EVERY_AXLE), id="every", validated=None)
    tables = (table, whole_lines()) if request.param == "lines" else (table_of(), every)
    path = tmp_path_factory.mktemp("forged") / "book.h5"
    write_book(tables, path, tables[0].generator)
    return Forgery(book_layout(tables), path.read_bytes(), arrays_in(path), path)


def test_a_book_that_is_forged_without_a_change_is_read(book: Forgery) -> None:
    found = book.outcome(lambda file: put(file, "cut_mass_t", file["cut_mass_t"][()]))
    assert isinstance(found, tuple)
    assert book.is_another_sound_book(found, "cut_mass_t")


def test_every_dataset_is_required(book: Forgery) -> None:
    names = [*(column.name for column in book.layout.columns), *book.layout.axes]
    assert len(names) >= 50
    assert [name for name in names if name not in book.refusal(delete(name))] == []


def test_every_dataset_tells_its_unit_and_meaning(book: Forgery) -> None:
    def without(name: str, attribute: str, value: object) -> Edit:
        def edit(file: h5py.File) -> None:
            del file[name].attrs[attribute]
            if value is not None:
                file[name].attrs[attribute] = value

        return edit

    faults = [(attribute, value) for attribute in ("units", "meaning") for value in (None, ["m", "m"], "other")]
    through = [
        (column.name, *fault)
        for number, column in enumerate(book.layout.columns)
        for fault in (faults[number % 6], faults[(number + 3) % 6])
        if f"{column.name} has other units" not in book.refusal(without(column.name, *fault), column.name)
    ]
    assert through == []


def other_types(columns: Sequence[Column]) -> Iterator[tuple[Column, str]]:
    """Two types for each column that are not its own: all of them for the columns of each type."""
    for dtype in {column.dtype for column in columns}:
        others = [each for each in DTYPES if each != dtype and (each, dtype) != ("S70", "S")]
        for number, column in enumerate(column for column in columns if column.dtype == dtype):
            yield from ((column, others[(2 * number + which) % len(others)]) for which in (0, 1))


def test_every_column_has_its_type(book: Forgery) -> None:
    def typed(name: str, dtype: str) -> Edit:
        def edit(file: h5py.File) -> None:
            values = file[name][()]
            if dtype == "object":
                put(file, name, np.full(values.shape, "x", dtype=h5py.string_dtype()))
            elif dtype == "reference":
                put(file, name, np.full(values.shape, file["id"].ref, dtype=h5py.ref_dtype))
            else:
                put(file, name, np.ones(values.shape, dtype=dtype))

        return edit

    through = [
        (column.name, dtype)
        for column, dtype in other_types(book.layout.columns)
        if f"{column.name} is " not in book.refusal(typed(column.name, dtype), column.name)
    ]
    assert through == []


def reshaped(values: npt.NDArray[Any], axis: int) -> Iterator[npt.NDArray[Any]]:
    """The values with this axis emptied, shorter, longer, gone, or with one more before it."""
    yield np.take(values, [], axis=axis)
    yield np.take(values, range(values.shape[axis] - 1), axis=axis)
    yield np.concatenate([values, np.take(values, [-1], axis=axis)], axis=axis)
    yield np.take(values, 0, axis=axis)
    yield np.expand_dims(values, axis)


def test_every_array_has_its_shape(book: Forgery) -> None:
    def shaped(name: str, values: npt.NDArray[Any]) -> Edit:
        return lambda file: put(file, name, values)

    through = []
    for number, column in enumerate(book.layout.columns):
        for axis, long in enumerate(column.axes):
            for values in islice(cycle(reshaped(book.arrays[column.name], axis)), number % 5, number % 5 + 2):
                found = book.outcome(shaped(column.name, values), column.name)
                if isinstance(found, tuple):
                    named = book.is_another_sound_book(found, column.name)
                else:
                    # The first array of a length tells the others theirs; so the fault may be told of another.
                    words = rf"\b({column.name}|along {long}|{long} does not number|{column.axes[-1]})"
                    named = re.search(words, str(found)) is not None or "has room for" in str(found)
                if not named:
                    through.append((column.name, axis, values.shape, str(found)))
    assert through == []


def test_no_number_gets_through_that_the_tables_do_not_give_back(book: Forgery) -> None:
    through = []
    for number, column in enumerate(book.layout.columns):
        if column.dtype == "S":
            continue
        places = list(np.ndindex(book.arrays[column.name].shape))
        values: tuple[float, ...] = (-1, 1, 3, 2**31 - 1) if "i" in column.dtype else (NAN, INF, -INF, -0.0, 1e30, 0.1)
        for value in (values[number % len(values)], values[(number + 3) % len(values)]):
            index = random.Random(f"{column.name} {value}").choice(places)
            found = book.outcome(set_value(column.name, index, value), column.name)
            if isinstance(found, tuple) and not book.is_another_sound_book(found, column.name):
                through.append((column.name, index, value))
    assert through == []


def test_no_text_gets_through_that_is_none(book: Forgery) -> None:
    through = [
        (column.name, value)
        for column in book.layout.columns
        for value in (b"", b"\xff", b"a\nb", b"\xed\xa0\x80")
        if column.dtype == "S" and not book.refusal(set_value(column.name, -1, value), column.name)
    ]
    assert through == []


def test_text_that_is_padded_otherwise_is_refused(book: Forgery) -> None:
    for name in (column.name for column in book.layout.columns if column.dtype == "S"):
        wider = partial(put, name=name, values=book.arrays[name].astype("S90"))
        assert f"{name} holds values beside" in book.refusal(wider, name)


def test_every_axis_is_numbered_from_0(book: Forgery) -> None:
    makers: tuple[Callable[[int], npt.NDArray[Any]], ...] = (
        lambda n: np.arange(1, n + 1, dtype="<i4"),
        lambda n: np.arange(n + 1, dtype="<i4"),
        lambda n: np.arange(float(n)),
    )

    def numbered(axis: str, make: Callable[[int], npt.NDArray[Any]]) -> Edit:
        def edit(file: h5py.File) -> None:
            length = file[axis].shape[0]
            del file[axis]
            file.create_dataset(axis, data=make(length))

        return edit

    through = [
        axis
        for axis in book.layout.axes
        for make in makers
        if f"{axis} does not number" not in book.refusal(numbered(axis, make))
    ]
    assert through == []


@pytest.mark.parametrize(
    ("name", "values", "error"),
    [
        ("format", [None, "retarder-table", np.bytes_(b"retarder-book"), ["retarder-book"]], UnknownFormat),
        ("version", [None, 0, -1, 1.0, 2.0, True, "1", [1], np.zeros(10_000, np.int32)], DamagedTable),
        ("version", [2, 2**63 - 1], NewerVersion),
        ("kind", [None, "aim", "line", 1], DamagedTable),
        ("complete", [None, 0, 2, 1.0, True, "1", [1]], DamagedTable),
        ("config_sha256", [None, "", "0" * 63, 0], DamagedTable),
        ("exported_by", [None, "", "two\nlines", 0.1], DamagedTable),
        ("surplus", [1], DamagedTable),
        ("surplus" * 1000, [1], DamagedTable),
    ],
    ids=lambda value: repr(value)[:20],
)
def test_every_root_attribute_is_required_as_it_is(
    book: Forgery, name: str, values: list[object], error: type[TableError]
) -> None:
    def with_value(value: object) -> Edit:
        def edit(file: h5py.File) -> None:
            if name in file.attrs:
                del file.attrs[name]
            if value is not None:
                file.attrs[name] = value

        return edit

    assert [value for value in values if type(book.outcome(with_value(value))) is not error] == []


def test_a_book_of_the_other_kind_is_refused(book: Forgery) -> None:
    other = "passages" if book.layout.kind == "lines" else "lines"

    def edit(file: h5py.File) -> None:
        file.attrs["kind"] = other

    assert "missing or unknown" in book.refusal(edit)


@pytest.mark.parametrize("sha256", [None, "", "0" * 64, 0])
def test_the_payload_has_its_checksum(book: Forgery, sha256: str | int | None) -> None:
    book.path.write_bytes(book.content)
    with h5py.File(book.path, "r+") as file:
        del file.attrs["payload_sha256"]
        if sha256 is not None:
            file.attrs["payload_sha256"] = sha256
    reseal(book.path)
    with pytest.raises(DamagedTable, match=r"payload_sha256|root attributes"):
        read_any_book(book.path)


BESIDE = {
    "lines": [
        ("stage_lower", (1, 3, 0), 1.0, "stage_lower holds values beside"),
        ("stage_lower", (0, 0, 0), 1.0, "stages[0].lower"),
        ("stage_upper", (1, 0, 1), 1.0, "stages[0].upper has 2 coefficients"),
        ("stage_pressure_kpa", (1, 3), 300.0, "stage_pressure_kpa holds values beside"),
        ("stage_k", (1, 3), 3, "stage_k holds values beside"),
        ("stage_upper_slope_m_s_per_kpa", (0, 0), 0.5, "decisions are at rest"),
        ("stage_lower_slope_m_s_per_kpa", (1, 1), NAN, "all lines a slope"),
        ("stage_upper_slope_m_s_per_kpa", (1, 3), 0.0, "stage_upper_slope_m_s_per_kpa holds values beside"),
        ("cut_axle_offsets_m", (0, 1), NAN, "cut_axle_offsets_m holds values beside"),
        ("retarder_zones_m", (0, 0, 0), NAN, "retarder.zones_m[0]"),
        ("stages", 1, 1, "stages has 1 entries"),
        ("stages", 1, 2**31 - 1, "but the book has room for 4"),
        ("degree", 0, 4, "stages[0].upper has 4 coefficients"),
        ("validated", 0, 0, "validated_passes holds values beside"),
        ("validated_passes", 0, 2**60, "validated.passes"),
        ("approach", 0, 1, "position_clear"),
        ("approach", 1, 0, "but no table has anything there"),
        ("approach_entrance_stage", 0, 1, "approach_entrance_stage holds values beside"),
        ("approach_entrance_stage", 1, 2, "approach.entrance_stage"),
        ("approach_length_m", 1, 3.5, "valid.s_m"),
        ("estimator", 1, 0, "without an estimator"),
        ("estimator_s_m", (1, 2), NAN, "estimator.drive_m2_s2"),
        ("cut_category_number", 0, 16, "the number 16"),
        ("id", 0, b"t", "2 tables of the book have the id"),
    ],
    "points": [
        ("passages", 0, 0, "passages has 0 entries"),
        ("passages", 0, 2**31 - 1, "but the book has room for"),
        ("passage_axle", (0, 1), 1, "passages[1] is axle 1"),
        ("passage_sensor", (0, 1), 2, "passages[1] is axle 0 over sensor 2"),
        ("passage_switching_m_s", (0, 0, 0, 0), NAN, "tuple of 2 entries"),
        ("passage_switching_m_s", (0, 4, 0, 0), 1.0, "passage_switching_m_s holds values beside"),
        ("passage_switching_m_s", (0, 0, 1, 0), INF, "switching_m_s"),
        ("pressure_kpa", (0, 1), 0.0, "pressure_kpa[1]"),
        ("approach_entrance_stage", 0, 9, "approach.entrance_stage"),
        ("initial_stage", 0, 2, "initial_stage"),
        ("sensors_decides_on", 0, b"every_axle", "passages has 4 entries"),
        ("sensors_decides_on", 0, b"last_axle", 'must be "first_axle" or "every_axle"'),
    ],
}


def test_nothing_stands_beside_the_tables(book: Forgery) -> None:
    for name, index, value, reason in BESIDE[book.layout.kind.replace("passages", "points")]:
        assert reason in book.refusal(set_value(name, index, value), name), (name, index, value)


def test_columns_of_a_section_that_no_table_has_are_refused(book: Forgery) -> None:
    def without(file: h5py.File) -> None:
        file["validated"][:] = file["validated_passes"][:] = 0
        file["validated_rms_m_s"][:] = file["validated_rms_ci95_m_s"][:] = NAN

    assert "validated_passes, validated_rms_ci95_m_s, validated_rms_m_s, but no table" in book.refusal(without)
