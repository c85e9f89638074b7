"""A book whose sums are right but whose content is not: each key, type, length and value is looked at by itself."""

import math
import random
import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import numpy.typing as npt
import pytest

from tests.tuning_tables.forged_book import Arrays, Edit, arrays_in, forge, put, reseal
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
from tuning_tables.book_columns import ANY_TIME_COLUMNS, WITH_ESTIMATORS, with_approaches

Refuse = Callable[..., TableError]
Index = int | tuple[int, ...]

LAYOUT = with_approaches(WITH_ESTIMATORS)
COLUMNS, AXES = (*LAYOUT.columns, *ANY_TIME_COLUMNS), LAYOUT.axes
ANY_TIME_NAMES = [column.name for column in ANY_TIME_COLUMNS]
AT_ANY_TIME = "at any time"
"""Their datasets, one or all together, are forged in a book of their own, as only such a book has them."""
NAMES = [column.name for column in COLUMNS]
FLOATS = [column.name for column in COLUMNS if column.dtype in ("<f4", "<f8")]
TEXTS = [column.name for column in COLUMNS if column.dtype == "S"]
CHANGES = ("emptied", "shortened", "lengthened", "removed", "added")
# Both tables have as many zones and axles; one fewer of each makes other tables, but sound ones.
SOUND = {("zones_m", 1, "shortened"), ("axle_offsets_m", 1, "shortened")}
DTYPES = ("<f4", "<f8", ">f8", "<i4", "<i8", "|u1", "S70", "object", "reference")
KINDS = sorted({column.dtype for column in COLUMNS})
PLACES = 4
"""Of an array, others for every value, where a number is put that none of the tables has."""

NAN, INF = float("nan"), float("inf")


@dataclass(frozen=True)
class Original:
    """A book to forge: its bytes, and the arrays in it."""

    content: bytes
    arrays: Arrays

    def without(self, name: str) -> Arrays:
        """The arrays that stay as they are where the dataset `name` is forged; none if it is not said which."""
        return {key: array for key, array in self.arrays.items() if key != name} if name in self.arrays else {}


Originals = Callable[[str], Original]
"""By the name of a dataset."""


@pytest.fixture(scope="module")
def original(
    table: ControllerTable,
    approached_estimate: ControllerTable,
    surface_table: ControllerTable,
    tmp_path_factory: pytest.TempPathFactory,
) -> Originals:
    """A book of two tables that differ in every length, one with estimator and approach.

    For a dataset that only tables at any time have: of a book of one without and one with slopes.
    """
    path = tmp_path_factory.mktemp("original") / "book.h5"
    write_book([table, approached_estimate], path)
    first = Original(path.read_bytes(), arrays_in(path))
    shorter = replace(surface_table, stages=surface_table.stages[:3])
    write_book([table, shorter], path)
    second = Original(path.read_bytes(), arrays_in(path))
    return lambda name: second if name in (*ANY_TIME_NAMES, AT_ANY_TIME) else first


def require_right_sum(refusal: TableError) -> None:
    """The sum over the content is not what is wrong: of what was forged it was made right again."""
    assert "payload_sha256 is " not in str(refusal)


@pytest.fixture
def refuse(original: Originals, tmp_path: Path) -> Refuse:
    """A function that forges the book by an edit, reads it, and gives the error, which must be a `TableError`.

    Its second argument is the dataset that is forged, if it is one alone.
    """

    def refused(edit: Edit, name: str = "") -> TableError:
        path = tmp_path / "book.h5"
        book = original(name)
        path.write_bytes(book.content)
        forge(path, edit, book.without(name))
        with pytest.raises(TableError) as caught:
            read_book(path)
        message = str(caught.value)
        assert message.startswith(f"{path}: ")
        require_right_sum(caught.value)
        assert len(message) < 800
        assert message.isprintable()
        return caught.value

    return refused


def test_a_book_that_is_forged_without_a_change_is_read(
    original: Originals, table: ControllerTable, approached_estimate: ControllerTable, tmp_path: Path
) -> None:
    path = tmp_path / "book.h5"
    path.write_bytes(original("mass_t").content)
    forge(path, lambda file: put(file, "mass_t", file["mass_t"][()]))
    assert read_book(path) == (table, approached_estimate)
    path.write_bytes(original("slopes").content)
    forge(path, lambda file: put(file, "slopes", file["slopes"][()]))
    assert [each.has_gauge for each in read_book(path)] == [False, True]


@pytest.mark.parametrize("name", [*NAMES, *AXES])
def test_every_dataset_is_required(refuse: Refuse, name: str) -> None:
    def remove(file: h5py.File) -> None:
        del file[name]

    error = refuse(remove, name)
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

    assert f"{name} has other units" in str(refuse(edit, name))


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
        ("schema_version", 5, DamagedTable),
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
def test_the_payload_has_its_checksum(original: Originals, tmp_path: Path, sha256: str | int | None) -> None:
    path = tmp_path / "book.h5"
    path.write_bytes(original("").content)
    with h5py.File(path, "r+") as file:
        del file.attrs["payload_sha256"]
        if sha256 is not None:
            file.attrs["payload_sha256"] = sha256
    reseal(path)
    with pytest.raises(DamagedTable, match=r"payload_sha256|root attributes"):
        read_book(path)


def other_types() -> list[tuple[str, str]]:
    """Names of columns and types that are not theirs: two or more for each, and all of them for those of one type."""
    found = []
    for kind in KINDS:
        names = [column.name for column in COLUMNS if column.dtype == kind]
        others = [each for each in DTYPES if each != kind and (each, kind) != ("S70", "S")]
        count = max(2, math.ceil(len(others) / len(names)))
        found += [
            (name, others[(count * place + n) % len(others)]) for place, name in enumerate(names) for n in range(count)
        ]
    return found


@pytest.mark.parametrize(("name", "dtype"), other_types())
def test_every_column_has_its_type(refuse: Refuse, name: str, dtype: str) -> None:
    def edit(file: h5py.File) -> None:
        values = file[name][()]
        if dtype == "object":
            put(file, name, np.full(values.shape, "x", dtype=h5py.string_dtype()))
        elif dtype == "reference":
            put(file, name, np.full(values.shape, file["id"].ref, dtype=h5py.ref_dtype))
        else:
            put(file, name, np.ones(values.shape, dtype=dtype))

    assert f"{name} is " in str(refuse(edit, name))


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

    error = refuse(edit, name)
    assert type(error) is DamagedTable
    # The first array of a length tells the others theirs; so the fault may be told of another, or of the axis.
    long = COLUMNS[NAMES.index(name)].axes[axis]
    assert re.search(rf"\b({name}|along {long}|{long} does not number)\b", str(error))


@pytest.mark.parametrize("name", FLOATS)
@pytest.mark.parametrize("value", [NAN, INF, -INF, -0.0, 1e30], ids=repr)
def test_no_number_gets_through_that_the_tables_do_not_give_back(
    original: Originals, tmp_path: Path, name: str, value: object
) -> None:
    path, book = tmp_path / "book.h5", original(name)
    known, indices = book.without(name), list(np.ndindex(book.arrays[name].shape))
    for index in random.Random(f"{name} {value}").sample(indices, min(len(indices), PLACES)):

        def edit(file: h5py.File, index: Index = index) -> None:
            file[name][index] = value

        path.write_bytes(book.content)
        forge(path, edit, known)
        try:
            tables = read_book(path)
        except DamagedTable as refusal:
            require_right_sum(refusal)
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

    assert type(refuse(edit, name)) is DamagedTable


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
        ("at_any_time", 1, 0, "decisions are at rest"),
        ("at_any_time", 1, 2, "at_any_time holds values beside"),
        ("has_gauge", 0, 1, "decisions are at rest"),
        ("has_gauge", 1, 0, "slopes holds values beside"),
        ("has_gauge", 1, 2, "has_gauge holds values beside"),
        ("slopes", (0, 0, 1), 0.5, "slopes holds values beside"),
        ("slopes", (1, 3, 0), 0.0, "slopes holds values beside"),
        ("slopes", (1, 0, 0), 0.5, "slopes holds values beside"),
        ("slopes", (1, 0, 0), NAN, "slopes holds values beside"),
        ("slopes", (1, 1, 0), NAN, "stages[1].lower_slope_m_s_per_kpa"),
        ("slopes", (1, 1, 0), -0.0, "stages[1].lower_slope_m_s_per_kpa"),
        ("slopes", (1, 1, 1), -0.0625, "stages[1]: upper - lower comes down to"),
        ("id", 1, b"leer-22t-4.0", "2 tables of the book have the id"),
    ],
)
def test_nothing_stands_beside_the_tables(refuse: Refuse, name: str, index: Index, value: object, reason: str) -> None:
    def edit(file: h5py.File) -> None:
        file[name][index] = value

    assert reason in str(refuse(edit, name))


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

    assert f"{axis} does not number" in str(refuse(edit, axis))


def test_text_that_is_padded_otherwise_is_refused(refuse: Refuse) -> None:
    error = refuse(lambda file: put(file, "category", file["category"][()].astype("S70")), "category")
    assert "category holds values beside" in str(error)


def test_a_book_without_a_table_at_any_time_is_of_an_older_version(refuse: Refuse) -> None:
    def rest(file: h5py.File) -> None:
        file["at_any_time"][:] = file["has_gauge"][:] = 0
        file["slopes"][:] = np.where(np.isnan(file["slopes"][:]), np.nan, 0.0)

    assert "at_any_time, has_gauge, slopes, but no table has anything there" in str(refuse(rest, AT_ANY_TIME))
