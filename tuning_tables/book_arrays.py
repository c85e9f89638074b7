"""The arrays of a stored book, read only where seal and checksums are right. Needs h5py, when called."""

from __future__ import annotations

import io
import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy.typing as npt

from tuning_tables.book_layout import ATTRIBUTES, FORMAT, VERSION, Layout, payload_sha256, stored_layout
from tuning_tables.declared.columns import Column, Columns
from tuning_tables.document import BOOK_KINDS
from tuning_tables.errors import (
    SHA256_HEX,
    DamagedTable,
    InvalidTable,
    NewerVersion,
    TableError,
    UnknownFormat,
    excerpt,
    require_match,
    require_text,
)
from tuning_tables.whole_file import read_regular_file, unsealed

if TYPE_CHECKING:
    import h5py

SIGNATURE: Final = b"\x89HDF\r\n\x1a\n"
# 1.7 times what 10 000 tables of the largest shape take (32 stages, degree 9: 38 MB).
LARGEST_FILE_BYTES: Final = 64 * 2**20
LONGEST_REASON: Final = 400


def stored_arrays(path: str | os.PathLike[str]) -> tuple[Layout, dict[str, npt.NDArray[Any]]]:
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
            return checked_arrays(file, len(body), source)
    except InvalidTable as invalid:
        raise DamagedTable(f"{source}: {excerpt(str(invalid), LONGEST_REASON)}") from invalid
    except TableError:
        raise
    # What is wrong with a file under a right seal surfaces in h5py as one of a dozen types.
    except Exception as fault:
        reason = excerpt(" ".join(str(fault).split()), LONGEST_REASON)
        raise DamagedTable(f"{source}: not a readable table book ({reason}); export it again.") from fault


def checked_arrays(file: h5py.File, most_bytes: int, source: str) -> tuple[Layout, dict[str, npt.NDArray[Any]]]:
    """The layout and arrays of the book, `most_bytes` in all, after all about the file was found to be as written."""
    from tuning_tables.stored_array import require_axis, scalar_attribute, stored_array

    attributes = {name: scalar_attribute(file, name) for name in ATTRIBUTES}
    layout = layout_of(file, attributes, source)
    if tuple(sorted(file.attrs)) != ATTRIBUTES:
        found = excerpt(str(sorted(file.attrs)), LONGEST_REASON)
        raise DamagedTable(f"{source}: root attributes are {found}, but must be {list(ATTRIBUTES)}.")
    if attributes["complete"] != 1:
        raise DamagedTable(f"{source}: complete is {attributes['complete']!r}, but must be 1; export the book again.")
    require_match(attributes["config_sha256"], "config_sha256", SHA256_HEX, "of 64 lower-case hex digits")
    require_text(attributes["exported_by"], "exported_by")
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
        require_lengths(column, arrays, layout, source)
    for axis in layout.axes:
        require_axis(file, axis, layout.length(axis, arrays), source)
    return layout, arrays


def require_lengths(column: Column, arrays: Columns, layout: Layout, source: str) -> None:
    """Every axis of `column` has one length in the whole book, and none is empty."""
    for axis, length in zip(column.axes, arrays[column.name].shape, strict=True):
        wanted = layout.length(axis, arrays)
        if length != wanted or length == 0:
            raise DamagedTable(
                f"{source}: {column.name} has {length} entries along {axis}, but the book has {wanted} there and needs "
                "at least one; export the book again."
            )


def layout_of(file: h5py.File, attributes: Mapping[str, str | int | None], source: str) -> Layout:
    """The layout of a book of that head: `UnknownFormat`, `NewerVersion`, `DamagedTable`."""
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
