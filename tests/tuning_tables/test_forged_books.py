"""A book whose sums are right but whose content is not: each key, type, length and value is looked at by itself."""

import random
from collections.abc import Callable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import numpy.typing as npt
import pytest

from tests.tuning_tables.forged_book import Edit, forge, put, reseal
from tuning_tables import (
    ControllerTable,
    DamagedTable,
    NewerVersion,
    OlderVersion,
    TableError,
    UnknownFormat,
    read_book,
    write_book,
)
from tuning_tables.book_columns import WITH_ESTIMATORS, with_approaches

Refuse = Callable[[Edit], TableError]
Index = int | tuple[int, ...]

LAYOUT = with_approaches(WITH_ESTIMATORS)
COLUMNS, AXES = LAYOUT.columns, LAYOUT.axes
NAMES = [column.name for column in COLUMNS]
FLOATS = [column.name for column in COLUMNS if column.dtype in ("<f4", "<f8")]
TEXTS = [column.name for column in COLUMNS if column.dtype == "S"]
CHANGES = ("emptied", "shortened", "lengthened", "removed", "added")
# Both tables have as many zones and axles; one fewer of each makes other tables, but sound ones.
SOUND = {("zones_m", 1, "shortened"), ("axle_offsets_m", 1, "shortened")}
NAN, INF = float("nan"), float("inf")


@pytest.fixture(scope="module")
def original(
    table: ControllerTable, approached_estimate: ControllerTable, tmp_path_factory: pytest.TempPathFactory
) -> bytes:
    """The bytes of a book of two tables that differ in every length, one with estimator and approach."""
    path = tmp_path_factory.mktemp("original") / "book.h5"
    write_book([table, approached_estimate], path)
    return path.read_bytes()


@pytest.fixture
def refuse(original: bytes, tmp_path: Path) -> Refuse:
    """A function that forges the book by an edit, reads it, and gives the error, which must be a `TableError`."""

    def refused(edit: Edit) -> TableError:
        path = tmp_path / "book.h5"
        path.write_bytes(original)
        forge(path, edit)
        with pytest.raises(TableError) as caught:
            read_book(path)
        message = str(caught.value)
        assert message.startswith(f"{path}: ")
        assert len(message) < 800
        assert message.isprintable()
        return caught.value

    return refused


def test_a_book_that_is_forged_without_a_change_is_read(
    original: bytes, table: ControllerTable, approached_estimate: ControllerTable, tmp_path: Path
) -> None:
    path = tmp_path / "book.h5"
    path.write_bytes(original)
    forge(path, lambda file: put(file, "mass_t", file["mass_t"][()]))
    assert read_book(path) == (table, approached_estimate)


@pytest.mark.parametrize("name", [*NAMES, *AXES])
def test_every_dataset_is_required(refuse: Refuse, name: str) -> None:
    def remove(file: h5py.File) -> None:
        del file[name]

    error = refuse(remove)
    assert type(error) is DamagedTable
    assert name in str(error)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("attribute", ["units", "meaning"])
@pytest.mark.parametrize("value", [None, ["m", "m"]], ids=repr)
def test_every_dataset_tells_its_unit_and_meaning(refuse: Refuse, name: str, attribute: str, value: object) -> None:
    def edit(file: h5py.File) -> None:
        del file[name].attrs[attribute]
        if value is not None:
            file[name].attrs[attribute] = value

    assert f"{name} has other units" in str(refuse(edit))


@pytest.mark.parametrize(
    ("name", "value", "error"),
    [
        ("format", None, UnknownFormat),
        ("format", "retarder-table", UnknownFormat),
        ("format", np.bytes_(b"retarder-book"), UnknownFormat),
        ("format", ["retarder-book"], UnknownFormat),
        ("schema_version", None, DamagedTable),
        ("schema_version", 1, DamagedTable),
        ("schema_version", 2, DamagedTable),
        ("schema_version", 4, DamagedTable),
        ("schema_version", 6, NewerVersion),
        ("schema_version", 2**63 - 1, NewerVersion),
        ("schema_version", 0, OlderVersion),
        ("schema_version", -1, OlderVersion),
        ("schema_version", 1.0, DamagedTable),
        ("schema_version", NAN, DamagedTable),
        ("schema_version", True, DamagedTable),
        ("schema_version", "1", DamagedTable),
        ("schema_version", [1], DamagedTable),
        ("schema_version", np.zeros(10_000, np.int32), DamagedTable),
        ("complete", None, DamagedTable),
        ("complete", 0, DamagedTable),
        ("complete", 2, DamagedTable),
        ("complete", 1.0, DamagedTable),
        ("complete", True, DamagedTable),
        ("complete", "1", DamagedTable),
        ("complete", [1], DamagedTable),
        ("config_sha256", None, DamagedTable),
        ("config_sha256", "", DamagedTable),
        ("config_sha256", "0" * 63, DamagedTable),
        ("config_sha256", 0, DamagedTable),
        ("tool_version", None, DamagedTable),
        ("tool_version", "", DamagedTable),
        ("tool_version", "two\nlines", DamagedTable),
        ("tool_version", 0.1, DamagedTable),
        ("surplus", 1, DamagedTable),
        ("surplus" * 1000, 1, DamagedTable),
    ],
    ids=lambda value: repr(value)[:20],
)
def test_every_root_attribute_is_required_as_it_is(
    refuse: Refuse, name: str, value: object, error: type[TableError]
) -> None:
    def edit(file: h5py.File) -> None:
        if name in file.attrs:
            del file.attrs[name]
        if value is not None:
            file.attrs[name] = value

    assert type(refuse(edit)) is error


@pytest.mark.parametrize("sha256", [None, "", "0" * 64, 0])
def test_the_payload_has_its_checksum(original: bytes, tmp_path: Path, sha256: str | int | None) -> None:
    path = tmp_path / "book.h5"
    path.write_bytes(original)
    with h5py.File(path, "r+") as file:
        del file.attrs["payload_sha256"]
        if sha256 is not None:
            file.attrs["payload_sha256"] = sha256
    reseal(path)
    with pytest.raises(DamagedTable, match=r"payload_sha256|root attributes"):
        read_book(path)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("dtype", ["<f4", "<f8", ">f8", "<i4", "<i8", "|u1", "S70", "object", "reference"])
def test_every_column_has_its_type(refuse: Refuse, name: str, dtype: str) -> None:
    column = COLUMNS[NAMES.index(name)]
    if dtype == column.dtype or (dtype == "S70" and column.dtype == "S"):
        return

    def edit(file: h5py.File) -> None:
        values = file[name][()]
        if dtype == "object":
            put(file, name, np.full(values.shape, "x", dtype=h5py.string_dtype()))
        elif dtype == "reference":
            put(file, name, np.full(values.shape, file["id"].ref, dtype=h5py.ref_dtype))
        else:
            put(file, name, np.ones(values.shape, dtype=dtype))

    assert f"{name} is " in str(refuse(edit))


@pytest.mark.parametrize(
    ("name", "axis", "change"),
    [
        (column.name, axis, change)
        for column in COLUMNS
        for axis in range(len(column.axes))
        for change in CHANGES
        if (column.name, axis, change) not in SOUND
    ],
)
def test_every_array_has_its_shape(refuse: Refuse, name: str, axis: int, change: str) -> None:
    def edit(file: h5py.File) -> None:
        values = file[name][()]
        changes: dict[str, Callable[[], npt.NDArray[Any]]] = {
            "emptied": lambda: np.take(values, [], axis=axis),
            "shortened": lambda: np.take(values, range(values.shape[axis] - 1), axis=axis),
            "lengthened": lambda: np.concatenate([values, np.take(values, [-1], axis=axis)], axis=axis),
            "removed": lambda: np.take(values, 0, axis=axis),
            "added": lambda: np.expand_dims(values, axis),
        }
        put(file, name, changes[change]())

    assert type(refuse(edit)) is DamagedTable


@pytest.mark.parametrize("name", FLOATS)
@pytest.mark.parametrize("value", [NAN, INF, -INF, -0.0, 1e30], ids=repr)
def test_no_number_gets_through_that_the_tables_do_not_give_back(
    original: bytes, tmp_path: Path, name: str, value: object
) -> None:
    path = tmp_path / "book.h5"
    indices = list(np.ndindex(shape_of(original, tmp_path, name)))
    for index in random.Random(name).sample(indices, min(len(indices), 12)):

        def edit(file: h5py.File, index: Index = index) -> None:
            file[name][index] = value

        path.write_bytes(original)
        forge(path, edit)
        try:
            tables = read_book(path)
        except DamagedTable:
            continue
        # It is another sound book, then; and what was written into it is what the tables hold.
        write_book(tables, path)
        with h5py.File(path) as file:
            assert np.array_equal(file[name][index], np.array(value, file[name].dtype), equal_nan=True)


@pytest.mark.parametrize("name", TEXTS)
@pytest.mark.parametrize("value", [b"", b"\xff", b"a\nb", b"\xed\xa0\x80"], ids=repr)
def test_no_text_gets_through_that_is_none(refuse: Refuse, name: str, value: object) -> None:
    def edit(file: h5py.File) -> None:
        file[name][0] = value

    assert type(refuse(edit)) is DamagedTable


@pytest.mark.parametrize(
    ("name", "index", "value", "reason"),
    [
        ("has_line", (0, 1, 0), 0, "coefficients holds values beside"),
        ("has_line", (0, 1, 0), 2, "has_line holds values beside"),
        ("has_line", (0, 0, 0), 1, "lower"),
        ("has_line", (1, 3, 0), 1, "has_line holds values beside"),
        ("coefficients", (1, 3, 0, 0), 1.0, "coefficients holds values beside"),
        ("coefficients", (1, 0, 0, 0), 1.0, "coefficients holds values beside"),
        ("pressure_kpa", (1, 3), 300.0, "pressure_kpa holds values beside"),
        ("axle_offsets_m", (0, 1), NAN, "axle_offsets_m holds values beside"),
        ("zones_m", (0, 0, 0), NAN, "zones_m holds values beside"),
        ("n_stages", 1, 1, "n_stages 1"),
        ("n_stages", 1, 3, "pressure_kpa"),
        ("n_stages", 1, 2**31 - 1, "n_stages"),
        ("n_stages", 0, -4, "n_stages -4"),
        ("degree", 0, 4, "degree 4"),
        ("degree", 0, -1, "degree -1"),
        ("degree", 0, 2, "coefficients holds values beside"),
        ("validated_passes", 0, 0, "validated"),
        ("validated_passes", 0, -1, "validated.passes"),
        ("validated_passes", 0, 2**60, "validated.passes"),
        ("validated_passes", 1, 1, "validated"),
        ("approach_entrance_stage", 0, 0, "approach_entrance_stage holds values beside"),
        ("approach_entrance_stage", 1, 2, "approach.entrance_stage"),
        ("approach_entrance_stage", 1, -1, "approach.entrance_stage"),
        ("approach_length_m", 0, 4.0, "approach.entrance_stage"),
        ("approach_length_m", 1, NAN, "no table has anything there"),
        ("approach_length_m", 1, 3.5, "valid.s_m"),
        ("id", 1, b"leer-22t-4.0", "2 tables of the book have the id"),
    ],
)
def test_nothing_stands_beside_the_tables(refuse: Refuse, name: str, index: Index, value: object, reason: str) -> None:
    def edit(file: h5py.File) -> None:
        file[name][index] = value

    assert reason in str(refuse(edit))


@pytest.mark.parametrize("axis", AXES)
@pytest.mark.parametrize(
    "make",
    [
        lambda n: np.arange(1, n + 1, dtype="<i4"),
        lambda n: np.arange(n + 1, dtype="<i4"),
        lambda n: np.arange(float(n)),
    ],
)
def test_every_axis_is_numbered_from_0(refuse: Refuse, axis: str, make: Callable[[int], npt.NDArray[Any]]) -> None:
    def edit(file: h5py.File) -> None:
        length = file[axis].shape[0]
        del file[axis]
        file.create_dataset(axis, data=make(length))

    assert f"{axis} does not number" in str(refuse(edit))


def test_text_that_is_padded_otherwise_is_refused(refuse: Refuse) -> None:
    error = refuse(lambda file: put(file, "category", file["category"][()].astype("S70")))
    assert "category holds values beside" in str(error)


def shape_of(original: bytes, tmp_path: Path, name: str) -> tuple[int, ...]:
    path = tmp_path / "shape.h5"
    path.write_bytes(original)
    with h5py.File(path) as file:
        return tuple(file[name].shape)
