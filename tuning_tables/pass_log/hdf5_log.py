"""Measured passes as HDF5: the columns of the rows and those of the passes, each a dataset. Needs h5py, when called.

Root attributes `format`, `version`, `path`. Rows: datasets of `PassLog.ROWS`; passes: `first_row` and those of
`PassLog.PASSES`; all under their names, compressed, with checksums. Behind the end of HDF5 stands a seal.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from tuning_tables.errors import DamagedTable, InvalidLog
from tuning_tables.pass_log.hdf5_child import FORMAT, STORED, VERSION, StoredColumns, columns_by_child, stored_columns
from tuning_tables.pass_log.log_columns import LARGEST_FILE_BYTES, NUMBERS, TEXTS, LogColumns, TextRuns
from tuning_tables.pass_log.log_mapping import PATHS, LogMapping
from tuning_tables.pass_log.pass_log import PASSES, ROWS, PassLog
from tuning_tables.whole_file import is_sealed, read_regular_file, seal_fits, seal_of, write_atomically


def write_hdf5_log(log: PassLog, path: Path) -> None:
    """Write `log` to the file at `path`, complete or not at all. `OSError`; `ImportError` without h5py."""
    import h5py

    # HDF5 never writes to the disk itself: its library keeps silent about some writes that fail.
    with h5py.File("log", "w", libver=("v108", "v108"), driver="core", backing_store=False) as file:
        file.attrs["format"], file.attrs["version"] = FORMAT, VERSION
        file.attrs["path"] = next(word for word, independent in PATHS.items() if independent == log.path_is_independent)
        for name in STORED:
            values = getattr(log, name)
            if isinstance(values, tuple):
                values = np.array([text.encode() for text in values], dtype=np.bytes_)
            file.create_dataset(
                name, data=values, chunks=True, compression="gzip", fletcher32=True, track_times=False
            )  # fmt: skip
        file.flush()
        image: bytes = file.id.get_file_image()
    write_atomically(path, image + seal_of(image))


def read_hdf5_log(path: Path, mapping: LogMapping) -> LogColumns:
    """The rows of the HDF5 file at `path`; only `path` of a mapping is used: such files have their own units.

    A file without a seal, as other programs write it, is read by a process of its own (`hdf5_child`).
    `InvalidLog` for anything that is no whole log; `OSError`; `ImportError` without h5py.
    """
    source = os.fspath(path)
    try:
        content = read_regular_file(path, LARGEST_FILE_BYTES)
    except DamagedTable as fault:
        raise InvalidLog(str(fault)) from fault
    sealed = is_sealed(content)
    if sealed and not seal_fits(content):
        raise InvalidLog(f"{source}: the seal at its end does not fit what is before it; copy it again.")
    try:
        stored = stored_columns(content) if sealed else columns_by_child(content)
    except InvalidLog as fault:
        raise InvalidLog(f"{source}: {fault}") from fault
    return _columns(stored, source, mapping)


def _columns(stored: StoredColumns, source: str, mapping: LogMapping) -> LogColumns:
    rows = {name: stored.arrays[name] for name in ROWS}
    passes = {name: stored.arrays[name] for name in PASSES}
    ends = stored.arrays["first_row"]
    _require_lengths(source, rows, passes, ends)
    counts = np.diff(ends).astype(np.int64)
    numbers = {name: value.astype(np.float64) for name, value in rows.items()}
    numbers |= {name: np.repeat(passes[name].astype(np.float64), counts) for name in PASSES if name not in TEXTS}
    first = tuple(ends[:-1].astype(int).tolist())
    cut_id, category = (TextRuns(first, _decoded(source, name, passes[name])) for name in TEXTS)
    independent = PATHS[stored.path_word] if mapping.path_is_independent is None else mapping.path_is_independent
    return LogColumns(source, 1, {name: numbers[name] for name in NUMBERS}, cut_id, category, independent)


def _require_lengths(
    source: str, rows: dict[str, npt.NDArray[Any]], passes: dict[str, npt.NDArray[Any]], ends: npt.NDArray[Any]
) -> None:
    count = len(rows["time_s"])
    if ends.dtype.kind not in "iu" or len(ends) < 2 or ends[0] != 0 or ends[-1] != count or (np.diff(ends) < 1).any():
        raise InvalidLog(f"{source}: first_row must rise from 0 to the number of rows, {count}.")
    for name, values in (*rows.items(), *passes.items()):
        wanted = count if name in rows else len(ends) - 1
        if len(values) != wanted:
            raise InvalidLog(f"{source}: column {name} has {len(values)} entries; it must have {wanted}.")


def _decoded(source: str, name: str, values: npt.NDArray[Any]) -> tuple[str, ...]:
    # Bytes that are no UTF-8 become signs that are not printable, and are told like these.
    texts = tuple(value.decode(errors="surrogateescape") for value in values.tolist())
    for number, text in enumerate(texts):
        if not text or not text.isprintable():
            raise InvalidLog(f"{source}: column {name}, pass {number + 1}: {text!r:.60} is no name; write one.")
    return texts
