"""A table goes from JSON to a book and back without the loss of a bit, and each format has one text for it."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.effort import sized
from tests.tuning_tables.random_tables import tables
from tuning_tables import (
    ControllerTable,
    Generator,
    InvalidTable,
    Stage,
    from_json,
    read_book,
    read_json,
    to_csv,
    to_json,
    write_book,
    write_csv,
    write_json,
)

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


@pytest.mark.requirement("FILE-06")
@pytest.mark.parametrize("name", ["table", "surface_table"])
def test_a_table_written_twice_has_the_same_bytes_in_every_format(
    request: pytest.FixtureRequest, name: str, tmp_path: Path
) -> None:
    table: ControllerTable = request.getfixturevalue(name)
    twin = read_back(table, tmp_path)
    assert twin is not table
    for write, name in ((write_json, "json"), (write_csv, "csv"), (lambda t, p: write_book([t], p), "h5")):
        write(table, tmp_path / f"first.{name}")
        write(twin, tmp_path / f"second.{name}")
        assert (tmp_path / f"first.{name}").read_bytes() == (tmp_path / f"second.{name}").read_bytes()


def read_back(table: ControllerTable, folder: Path) -> ControllerTable:
    write_json(table, folder / "table.json")
    return read_json(folder / "table.json")


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


def test_a_coefficient_keeps_its_last_bit(table: ControllerTable, tmp_path: Path) -> None:
    last_bits = [1e-45, 1.1754942e-38, np.nextafter(np.float32(4.0), np.float32(5.0)), 3.0e-39]
    line = tuple(float(np.float32(value)) for value in last_bits)
    original = replace(table, stages=(Stage(0, 0.0, None, line), *table.stages[1:]))
    write_book([original], tmp_path / "book.h5")
    (from_book,) = read_book(tmp_path / "book.h5")
    assert from_book.stages[0].upper == from_json(to_json(original)).stages[0].upper == line
