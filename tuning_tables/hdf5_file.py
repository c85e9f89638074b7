"""A book of tables as an HDF5 file, readable by h5py and xarray without this project. Needs h5py, and only when called.

Root attributes: format "retarder-book", version, kind, exported_by, config_sha256, payload_sha256 (see `payload`),
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
import os
from collections.abc import Sequence
from pathlib import Path

from tuning_tables.book_arrays import LONGEST_REASON, stored_arrays
from tuning_tables.book_layout import FORMAT, VERSION, book_layout, image_of, payload_sha256, stored_tables
from tuning_tables.declared.columns import Columns
from tuning_tables.document import MEANINGS, StageTable, kind_of
from tuning_tables.errors import DamagedTable, InvalidTable, OtherKind, TableError, excerpt
from tuning_tables.export_names import exporter
from tuning_tables.provenance import Generator
from tuning_tables.table import ControllerTable
from tuning_tables.whole_file import replacing, seal_of


def write_book(tables: Sequence[StageTable], path: str | os.PathLike[str], generator: Generator | None = None) -> None:
    """Write tables of one kind to an HDF5 file, complete or not at all.

    Parameters
    ----------
    tables
        The tables; ids differ.
    path
        The file; one that is there is replaced.
    generator
        The run that bound the book; by default the generator of the tables, which must then be one for all.

    Raises
    ------
    InvalidTable
        No tables, an id given twice, generators that differ, tables of two kinds.
    OSError
        The disk refuses it, or the file does not read back as it was written.
    ImportError
        There is no h5py.

    Examples
    --------
    With `table` from the example of `ControllerTable`:

    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> from tuning_tables import read_book, write_book
    >>> with TemporaryDirectory() as folder:
    ...     write_book([table], Path(folder, "book.h5"))
    ...     read_book(Path(folder, "book.h5")) == (table,)
    True
    """
    content = book_bytes(tables, generator)
    with replacing(path) as part:
        part.write_bytes(content)
        _require_read_back(part)


def book_bytes(tables: Sequence[StageTable], generator: Generator | None = None) -> bytes:
    """The file that `write_book` writes, for a caller that writes files himself; raises as it does."""
    layout = book_layout(tables)
    arrays = layout.arrays_of(tables)
    origin = generator or _common_generator(tables)
    attributes: dict[str, str | int] = {
        "complete": 1,
        "config_sha256": origin.config_sha256,
        "exported_by": exporter(),
        "format": FORMAT,
        "kind": layout.kind,
        "version": VERSION,
    }
    attributes["payload_sha256"] = payload_sha256(attributes, arrays, layout)
    body = image_of(attributes, arrays, layout)
    return body + seal_of(body)


def read_book(path: str | os.PathLike[str]) -> tuple[ControllerTable, ...]:
    """Read the tables of lines from an HDF5 file.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    tuple of ControllerTable
        The tables in the order in which they were written. `TableBook` chooses among them.

    Raises
    ------
    OtherKind
        The tables have no lines; `read_any_book` reads them.
    DamagedTable, UnknownFormat, NewerVersion
        The file is no complete, unchanged book of a known version.
    OSError
        The file cannot be opened.
    ImportError
        There is no h5py.

    Examples
    --------
    See `write_book`.
    """
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
    """Read tables of lines, or tables for point sensors, from an HDF5 file.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    tuple of ControllerTable or of PassageTable
        The tables, all of one kind, in the order in which they were written.

    Raises
    ------
    DamagedTable, UnknownFormat, NewerVersion
        The file is no complete, unchanged book of a known version.
    OSError
        The file cannot be opened.
    ImportError
        There is no h5py.

    Examples
    --------
    With `table` from the example of `ControllerTable`:

    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> from tuning_tables import read_any_book, write_book
    >>> with TemporaryDirectory() as folder:
    ...     write_book([table], Path(folder, "book.h5"))
    ...     len(read_any_book(Path(folder, "book.h5")))
    1
    """
    source = os.fspath(path)
    layout, arrays = stored_arrays(path)
    try:
        tables = stored_tables(layout, arrays)
        _require_as_written(arrays, book_layout(tables).arrays_of(tables), source)
    except InvalidTable as invalid:
        raise DamagedTable(f"{source}: {excerpt(str(invalid), LONGEST_REASON)}") from invalid
    except UnicodeDecodeError as fault:
        raise DamagedTable(f"{source}: not a readable table book ({fault}); export it again.") from fault
    return tables


def _require_read_back(part: Path) -> None:
    """Other values than were written would not have the `payload_sha256` that was written with them."""
    try:
        stored_arrays(part)
    except TableError as fault:
        reason = str(fault).removeprefix(f"{part}: ")
        raise OSError(errno.EIO, f"what was written does not read back ({reason})") from None


def _common_generator(tables: Sequence[StageTable]) -> Generator:
    generators = {table.generator for table in tables}
    if len(generators) > 1:
        raise InvalidTable("the tables have different generators; name the one that binds the book.")
    return generators.pop()


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
