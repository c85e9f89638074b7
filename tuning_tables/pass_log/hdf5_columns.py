"""The columns of an HDF5 pass log as arrays, just as they are stored. Needs h5py, when called."""

from __future__ import annotations

import io
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy.typing as npt

from tuning_tables.errors import InvalidLog
from tuning_tables.excerpt import excerpt
from tuning_tables.pass_log.log_columns import TEXTS
from tuning_tables.pass_log.log_mapping import PATHS
from tuning_tables.pass_log.pass_log import PASSES, ROWS

if TYPE_CHECKING:
    import h5py

FORMAT: Final = "retarder-pass-log"
VERSION: Final = 1
STORED: Final = (*ROWS, "first_row", *PASSES)
"""Datasets of a log, in the order in which they are written."""

MOST_ROWS: Final = 20_000_000
LARGEST_COLUMNS_BYTES: Final = 2**30
"""All columns of a file together: a small file can claim any number of rows."""


@dataclass(frozen=True, eq=False)
class StoredColumns:
    """`path_word`, where the path comes from, and the read-only arrays (n,) of all names of `STORED`."""

    path_word: str
    arrays: Mapping[str, npt.NDArray[Any]]

    def __post_init__(self) -> None:
        for array in self.arrays.values():
            array.setflags(write=False)


def stored_columns(content: bytes) -> StoredColumns:
    """What the HDF5 file with this content holds; HDF5 may never come to an end with damaged content.

    `InvalidLog`, which names no file, for anything that is no pass log; `MemoryError`; `ImportError` without h5py.
    """
    import h5py

    try:
        with h5py.File(io.BytesIO(content), "r") as file:
            return _columns(file)
    except (InvalidLog, MemoryError):
        raise
    # What is wrong with a file surfaces in h5py as one of a dozen types.
    except Exception as fault:
        reason = excerpt(" ".join(str(fault).split()), 200)
        raise InvalidLog(f"not readable as an HDF5 pass log ({reason}); write it anew.") from fault


def _columns(file: h5py.File) -> StoredColumns:
    found, version, word = (file.attrs.get(name) for name in ("format", "version", "path"))
    if not isinstance(found, str) or found != FORMAT or version != VERSION:
        raise InvalidLog(
            f'format is {excerpt(repr(found))}, version {excerpt(repr(version))}; it must be "{FORMAT}", version '
            f"{VERSION}."
        )
    if not isinstance(word, str) or word not in PATHS:
        raise InvalidLog(f"path is {excerpt(repr(word))}; it must be one of {', '.join(PATHS)}.")
    kept = {name: _dataset(file, name) for name in STORED}
    length = sum(each.size * each.dtype.itemsize for each in kept.values())
    if length > LARGEST_COLUMNS_BYTES:
        raise InvalidLog(f"its columns have {length} bytes; at most {LARGEST_COLUMNS_BYTES} may be; write it in parts.")
    for name, each in kept.items():
        if not _is_whole(each):
            raise InvalidLog(f"column {name}: some of its values are not there; write all of them, NaN for no reading.")
    return StoredColumns(word, {name: each[()] for name, each in kept.items()})


def _dataset(file: h5py.File, name: str) -> h5py.Dataset:
    import h5py

    kept = file.get(name)
    kinds = "S" if name in TEXTS else "fiub"
    if not isinstance(kept, h5py.Dataset) or kept.ndim != 1 or kept.dtype.kind not in kinds:
        raise InvalidLog(f"column {name} is missing or no column of {'text' if kinds == 'S' else 'numbers'}.")
    if kept.size > MOST_ROWS:
        raise InvalidLog(f"column {name} has {kept.size} entries; at most {MOST_ROWS} may be; write the log in parts.")
    return kept


def _is_whole(kept: h5py.Dataset) -> bool:
    """Whether all values are stored. HDF5 reads those that it does not find in its index as 0, without a word."""
    if kept.chunks is None:
        return bool(kept.id.get_storage_size() >= kept.size * kept.dtype.itemsize)
    whole_bytes = kept.chunks[0] * kept.dtype.itemsize
    for first in range(0, kept.size, kept.chunks[0]):
        try:
            skipped_filters, chunk = kept.id.read_direct_chunk((first,))
        except (OSError, RuntimeError, MemoryError):  # a large chunk that was never written has any size for HDF5
            return False
        # A compression is skipped only where it makes nothing shorter.
        if skipped_filters and len(chunk) < whole_bytes:
            return False
    return True
