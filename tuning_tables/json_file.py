"""Tables as JSON files: written for people and machines, read without mercy.

One table has exactly two texts: the layout of the export, and the canonical form of RFC 8785 of the whole document
(without a line feed at its end) for writers in other languages. Any other text is refused, even where it says the same:
the checksum covers what is said, this covers how, so that no byte of a file can change unnoticed.
"""

from __future__ import annotations

import os
from typing import Any, TypeVar, overload

from tuning_tables.document import KINDS, AnyTable, from_document, to_document
from tuning_tables.json_text import LARGEST_FILE_BYTES, laid_out, read_json_text, require_layout
from tuning_tables.table import ControllerTable
from tuning_tables.whole_file import read_regular_file, write_atomically

_T = TypeVar("_T")


def to_json(table: AnyTable) -> bytes:
    """A table as JSON, laid out for people.

    Parameters
    ----------
    table
        A table of any kind.

    Returns
    -------
    bytes
        UTF-8, floats in the shortest form that reads back exactly; equal tables give equal bytes.

    Raises
    ------
    InvalidTable
        A number is -0.0.

    Examples
    --------
    With `table` from the example of `ControllerTable`:

    >>> from tuning_tables import from_json, to_json
    >>> from_json(to_json(table)) == table
    True
    """
    return laid_out(to_document(table))


@overload
def from_json(content: bytes, *, source: str = "table") -> ControllerTable: ...
@overload
def from_json(content: bytes, *kinds: type[_T], source: str = "table") -> _T: ...
def from_json(content: bytes, *kinds: type[Any], source: str = "table") -> Any:
    """The table in a JSON text.

    Parameters
    ----------
    content
        The text, UTF-8, 4 MiB at most.
    *kinds
        The classes that the table may be of; by default `ControllerTable`.
    source
        What messages call the text.

    Returns
    -------
    ControllerTable, PassageTable or AimTable
        The table.

    Raises
    ------
    DamagedTable
        A text that is not, byte for byte, what an export writes: cut off, changed, laid out otherwise.
    UnknownFormat, OtherKind, NewerVersion
        It holds something else, a table of another kind, or one of a later version of the format.

    Examples
    --------
    With `table` from the example of `ControllerTable`:

    >>> from tuning_tables import from_json, to_json
    >>> from_json(to_json(table)).id
    'by-hand'
    >>> from_json(to_json(table).replace(b"52.0", b"53.0"))
    Traceback (most recent call last):
    ...
    tuning_tables.errors.DamagedTable: table: crc32 is ..., but the content gives ...: it was changed after ...
    """
    wanted = kinds or (ControllerTable,)
    document, table = read_json_text(content, source, lambda found, at: from_document(found, at, wanted))
    require_layout(content, document, laid_out(to_document(table, str(document["exported_by"]))), source)
    return table


def write_json(table: AnyTable, path: str | os.PathLike[str]) -> None:
    """Write `to_json` of a table to a file, complete or not at all.

    Parameters
    ----------
    table
        A table of any kind.
    path
        The file; one that is there is replaced.

    Raises
    ------
    InvalidTable
        As `to_json`.
    OSError
        The disk refuses it.

    Examples
    --------
    With `table` from the example of `ControllerTable`:

    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> from tuning_tables import read_json, write_json
    >>> with TemporaryDirectory() as folder:
    ...     write_json(table, Path(folder, "table.json"))
    ...     read_json(Path(folder, "table.json")) == table
    True
    """
    write_atomically(path, to_json(table))


@overload
def read_json(path: str | os.PathLike[str]) -> ControllerTable: ...
@overload
def read_json(path: str | os.PathLike[str], *kinds: type[_T]) -> _T: ...
def read_json(path: str | os.PathLike[str], *kinds: type[Any]) -> Any:
    """Read a table from a JSON file.

    Parameters
    ----------
    path
        The file.
    *kinds
        The classes that the table may be of; by default `ControllerTable`.

    Returns
    -------
    ControllerTable, PassageTable or AimTable
        The table.

    Raises
    ------
    DamagedTable, UnknownFormat, OtherKind, NewerVersion
        As `from_json`.
    OSError
        There is no such regular file, or it cannot be read.

    Examples
    --------
    See `write_json`.
    """
    content = read_regular_file(path, LARGEST_FILE_BYTES)
    return from_json(content, *(kinds or (ControllerTable,)), source=os.fspath(path))


def read_table(path: str | os.PathLike[str]) -> AnyTable:
    """Read a table of any kind from a JSON file.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    ControllerTable, PassageTable or AimTable
        The table.

    Raises
    ------
    DamagedTable, UnknownFormat, NewerVersion
        As `from_json`.
    OSError
        There is no such regular file, or it cannot be read.

    Examples
    --------
    With `table` from the example of `ControllerTable`:

    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> from tuning_tables import read_table, write_json
    >>> with TemporaryDirectory() as folder:
    ...     write_json(table, Path(folder, "table.json"))
    ...     type(read_table(Path(folder, "table.json"))).__name__
    'ControllerTable'
    """
    return read_json(path, *KINDS.values())
