"""A book of tables as an HDF5 file, readable by h5py and xarray without this project. Needs h5py, and only when called.

Root attributes: format "retarder-book", version, kind, tool_version, config_sha256, payload_sha256 (see `payload`),
complete = 1.

Datasets: the columns of tables of that kind (`declared.columns`), each with attributes `units` and `meaning`, chunked
in one piece with a fletcher32 checksum.
Each axis is a dimension scale of its own name, numbered from 0.

Two attributes are for xarray: `_Encoding` has it decode text (fixed-length UTF-8), `coordinates` names what tells the
tables apart. Equal books give equal bytes: nothing in the file tells time or place. The file ends with a seal (see
`seal`), and is read only under an unbroken one; and only where the tables in it give the very same arrays again, so
that nothing is in a book, not even in the padding, that was not read.

HDF5 never writes to the disk itself: its library keeps silent about some writes that fail, and the seal would then be
set over the damage. It makes the book in memory; what was written from there is read back before it takes the name.
"""

from __future__ import annotations

import errno
import io
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

from tuning_tables.atomic_file import replacing
from tuning_tables.book_layout import Layout, book_layout, stored_layout, stored_tables
from tuning_tables.declared.columns import Column, Columns
from tuning_tables.errors import (
    DamagedTable,
    InvalidTable,
    NewerVersion,
    OtherKind,
    TableError,
    UnknownFormat,
)
from tuning_tables.excerpt import excerpt
from tuning_tables.payload import payload_sha256
from tuning_tables.provenance import Generator
from tuning_tables.regular_file import read_regular_file
from tuning_tables.requirement import SHA256_HEX, require_match, require_text
from tuning_tables.seal import seal_of, unsealed
from tuning_tables.table import ControllerTable
from tuning_tables.table_kinds import BOOK_KINDS, MEANINGS, StageTable, kind_of

if TYPE_CHECKING:
    import h5py

FORMAT: Final = "retarder-book"
VERSION: Final = 1
SIGNATURE: Final = b"\x89HDF\r\n\x1a\n"
# The oldest file version whose metadata carry checksums, for readers that know nothing of the seal.
FILE_VERSION: Final = ("v108", "v108")
# 1.7 times what 10 000 tables of the largest shape take (32 stages, degree 9: 38 MB).
LARGEST_FILE_BYTES: Final = 64 * 2**20
LONGEST_REASON: Final = 400
COORDINATES: Final = ("id", "cut_category", "cut_mass_t", "target_speed_m_s")

_ATTRIBUTES: Final = ("complete", "config_sha256", "format", "kind", "payload_sha256", "tool_version", "version")


def write_book(tables: Sequence[StageTable], path: str | os.PathLike[str], generator: Generator | None = None) -> None:
    """Write `tables`, all of one kind, to the file at `path`, complete or not at all.

    `generator`: the run that bound the book, by default the generator of the tables, which must then be one for all.
    Raises `InvalidTable` for no tables, an id given twice, generators that differ, tables of two kinds; `OSError`, also
    where the file does not read back as it was written; `ImportError` without h5py.
    """
    content = book_bytes(tables, generator)
    with replacing(path) as part:
        part.write_bytes(content)
        _require_read_back(part, book_layout(tables).arrays_of(tables))


def book_bytes(tables: Sequence[StageTable], generator: Generator | None = None) -> bytes:
    """The file that `write_book` writes, for a caller that writes files himself; raises as it does."""
    layout = book_layout(tables)
    arrays = layout.arrays_of(tables)
    origin = generator or _common_generator(tables)
    attributes: dict[str, str | int] = {
        "complete": 1,
        "config_sha256": origin.config_sha256,
        "format": FORMAT,
        "kind": layout.kind,
        "tool_version": origin.version,
        "version": VERSION,
    }
    attributes["payload_sha256"] = payload_sha256(attributes, arrays, layout)
    body = _body(attributes, arrays, layout)
    return body + seal_of(body)


def read_book(path: str | os.PathLike[str]) -> tuple[ControllerTable, ...]:
    """The tables in the file at `path`, which must have lines, else `OtherKind`; raises as `read_any_book`."""
    tables = read_any_book(path)
    lines = tuple(table for table in tables if isinstance(table, ControllerTable))
    if len(lines) < len(tables):
        found, wanted = kind_of(type(tables[0])), kind_of(ControllerTable)
        raise OtherKind(
            f"{os.fspath(path)}: the kind of this book is {found} ({MEANINGS[found]}), but here one is needed whose "
            f"kind is {wanted}."
        )
    return lines


def read_any_book(path: str | os.PathLike[str]) -> tuple[StageTable, ...]:
    """The tables in the file at `path`, all of one kind, in the order in which they were written.

    Raises `UnknownFormat` for a file that is no HDF5 or holds another sealed format, `NewerVersion` for a later
    version, `DamagedTable` for everything that is no complete, unchanged book, unsealed HDF5 files among them;
    `OSError` where the file cannot be opened; `ImportError` without h5py.
    """
    source = os.fspath(path)
    layout, arrays = _stored_arrays(path)
    try:
        tables = stored_tables(layout, arrays)
        _require_as_written(arrays, book_layout(tables).arrays_of(tables), source)
    except InvalidTable as invalid:
        raise DamagedTable(f"{source}: {excerpt(str(invalid), LONGEST_REASON)}") from invalid
    except UnicodeDecodeError as fault:
        raise DamagedTable(f"{source}: not a readable table book ({fault}); export it again.") from fault
    return tables


def _body(attributes: Mapping[str, str | int], arrays: Columns, layout: Layout) -> bytes:
    """The HDF5 file of a book, made in memory."""
    import h5py

    # The name stands nowhere in the file, and nothing is written to the disk.
    with h5py.File("book", "w", libver=FILE_VERSION, driver="core", backing_store=False) as file:
        for axis, meaning in layout.axes.items():
            _write_axis(file, axis, layout.length(axis, arrays), meaning)
        for column in layout.columns:
            _write_column(file, column, arrays[column.name])
        for name in _ATTRIBUTES:
            file.attrs[name] = attributes[name]
        file.flush()
        image: bytes = file.id.get_file_image()
    return image


def _stored_arrays(path: str | os.PathLike[str]) -> tuple[Layout, dict[str, npt.NDArray[Any]]]:
    """The layout and arrays of the book at `path`, whose seal and checksums are right; raises as `read_book`."""
    import h5py

    source = os.fspath(path)
    content = read_regular_file(path, LARGEST_FILE_BYTES)
    # A beginning of the signature alone may be a book that was cut off.
    if not content.startswith(SIGNATURE[: len(content)]):
        raise UnknownFormat(f"{source}: not an HDF5 file; give a table book.")
    body = unsealed(content, source)
    try:
        # From these bytes, not from the file: what was found unbroken is what is read.
        with h5py.File(io.BytesIO(body), "r") as file:
            return _checked_arrays(file, len(body), source)
    except InvalidTable as invalid:
        raise DamagedTable(f"{source}: {excerpt(str(invalid), LONGEST_REASON)}") from invalid
    except TableError:
        raise
    # What is wrong with a file under a right seal surfaces in h5py as one of a dozen types.
    except Exception as fault:
        reason = excerpt(" ".join(str(fault).split()), LONGEST_REASON)
        raise DamagedTable(f"{source}: not a readable table book ({reason}); export it again.") from fault


def _require_read_back(part: Path, arrays: Columns) -> None:
    try:
        _, found = _stored_arrays(part)
        reason = (
            "" if all(found[name].tobytes() == array.tobytes() for name, array in arrays.items()) else "other values"
        )
    except DamagedTable as fault:
        reason = str(fault).removeprefix(f"{part}: ")
    if reason:
        raise OSError(errno.EIO, f"what was written does not read back ({reason})")


def _common_generator(tables: Sequence[StageTable]) -> Generator:
    generators = {table.generator for table in tables}
    if len(generators) > 1:
        raise InvalidTable("the tables have different generators; name the one that binds the book.")
    return generators.pop()


def _write_axis(file: h5py.File, axis: str, length: int, meaning: str) -> None:
    scale = file.create_dataset(axis, data=np.arange(length, dtype="<i4"), track_times=False)
    scale.make_scale(axis)
    scale.attrs["meaning"] = meaning


def _write_column(file: h5py.File, column: Column, values: npt.NDArray[Any]) -> None:
    import h5py

    text = values.dtype.kind == "S"
    dtype = h5py.string_dtype("utf-8", values.dtype.itemsize) if text else values.dtype
    dataset = file.create_dataset(
        column.name, data=values.astype(dtype), chunks=values.shape, fletcher32=True, track_times=False
    )
    dataset.attrs["units"] = column.unit
    dataset.attrs["meaning"] = column.meaning
    if text:
        dataset.attrs["_Encoding"] = "utf-8"
    elif column.name not in COORDINATES:
        dataset.attrs["coordinates"] = " ".join(COORDINATES)
    for position, axis in enumerate(column.axes):
        dataset.dims[position].attach_scale(file[axis])


def _checked_arrays(file: h5py.File, most_bytes: int, source: str) -> tuple[Layout, dict[str, npt.NDArray[Any]]]:
    """The layout and arrays of the book, `most_bytes` in all, after all about the file was found to be as written."""
    from tuning_tables.stored_array import require_axis, scalar_attribute, stored_array

    attributes = {name: scalar_attribute(file, name) for name in _ATTRIBUTES}
    layout = _layout(file, attributes, source)
    if tuple(sorted(file.attrs)) != _ATTRIBUTES:
        found = excerpt(str(sorted(file.attrs)), LONGEST_REASON)
        raise DamagedTable(f"{source}: root attributes are {found}, but must be {list(_ATTRIBUTES)}.")
    if attributes["complete"] != 1:
        raise DamagedTable(f"{source}: complete is {attributes['complete']!r}, but must be 1; export the book again.")
    require_match(attributes["config_sha256"], "config_sha256", SHA256_HEX, "of 64 lower-case hex digits")
    require_text(attributes["tool_version"], "tool_version")
    expected = {column.name for column in layout.columns} | set(layout.axes)
    if set(file) != expected:
        found = excerpt(str(sorted(set(file) ^ expected)), LONGEST_REASON)
        raise DamagedTable(f"{source}: {found} are missing or unknown; export the book again.")
    arrays: dict[str, npt.NDArray[Any]] = {}
    for column in layout.columns:
        arrays[column.name] = stored_array(file, column, most_bytes, source)
        most_bytes -= arrays[column.name].nbytes
    stored = attributes.pop("payload_sha256")
    if stored != payload_sha256({k: v for k, v in attributes.items() if v is not None}, arrays, layout):
        raise DamagedTable(
            f"{source}: payload_sha256 is {stored!r:.80}, but the content gives another; export it again."
        )
    for column in layout.columns:
        _require_lengths(column, arrays, layout, source)
    for axis in layout.axes:
        require_axis(file, axis, layout.length(axis, arrays), source)
    return layout, arrays


def _require_lengths(column: Column, arrays: Columns, layout: Layout, source: str) -> None:
    """Every axis of `column` has one length in the whole book, and none is empty."""
    for axis, length in zip(column.axes, arrays[column.name].shape, strict=True):
        wanted = layout.length(axis, arrays)
        if length != wanted or length == 0:
            raise DamagedTable(
                f"{source}: {column.name} has {length} entries along {axis}, but the book has {wanted} there and needs "
                "at least one; export the book again."
            )


def _require_as_written(found: Columns, written: Columns, source: str) -> None:
    """Padding, lengths of text and missing lines are as the export makes them; values then are, too."""
    if found.keys() != written.keys():
        surplus = ", ".join(sorted(found.keys() - written.keys()))
        raise DamagedTable(f"{source}: it holds {surplus}, but no table has anything there; export it again.")
    for name, array in written.items():
        if found[name].dtype.str != array.dtype.str or found[name].tobytes() != array.tobytes():
            raise DamagedTable(
                f"{source}: {name} holds values beside those of the tables, or pads them otherwise than the export; "
                "export the book again."
            )


def _layout(file: h5py.File, attributes: Mapping[str, str | int | None], source: str) -> Layout:
    found, version, kind = attributes["format"], attributes["version"], attributes["kind"]
    if found != FORMAT:
        raise UnknownFormat(f'{source}: format is {found!r:.60}, but it must be "{FORMAT}"; give a table book.')
    if isinstance(version, int) and version > VERSION:
        raise NewerVersion(f"{source}: version is {version}, this reader knows only {VERSION}; update retarder-synth.")
    if version != VERSION:
        raise DamagedTable(f"{source}: version is {version!r:.60}, but it must be {VERSION}; export the book again.")
    if kind not in BOOK_KINDS:
        raise DamagedTable(f"{source}: kind is {kind!r:.60}, but it must be {' or '.join(BOOK_KINDS)}.")
    return stored_layout(str(kind), set(file))
