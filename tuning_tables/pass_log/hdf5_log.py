"""Measured passes as HDF5: the columns of the rows and those of the passes, each a dataset. Needs h5py, when called.

Root attributes `format`, `version`, `path`. Rows: datasets of `PassLog.ROWS`; passes: `first_row` and those of
`PassLog.PASSES`; all under their names, compressed, with checksums.
"""

from __future__ import annotations

import io
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

from tuning_tables.atomic_file import write_atomically
from tuning_tables.errors import DamagedTable, InvalidLog
from tuning_tables.excerpt import excerpt
from tuning_tables.pass_log.log_columns import LARGEST_FILE_BYTES, NUMBERS, TEXTS, LogColumns, TextRuns
from tuning_tables.pass_log.log_mapping import PATHS, LogMapping
from tuning_tables.pass_log.pass_log import PASSES, ROWS, PassLog
from tuning_tables.regular_file import read_regular_file

if TYPE_CHECKING:
    import h5py

FORMAT: Final = "retarder-pass-log"
VERSION: Final = 1


def write_hdf5_log(log: PassLog, path: Path) -> None:
    """Write `log` to the file at `path`, complete or not at all. `OSError`; `ImportError` without h5py."""
    import h5py

    # HDF5 never writes to the disk itself: its library keeps silent about some writes that fail.
    with h5py.File("log", "w", libver=("v108", "v108"), driver="core", backing_store=False) as file:
        file.attrs["format"], file.attrs["version"] = FORMAT, VERSION
        file.attrs["path"] = next(word for word, independent in PATHS.items() if independent == log.path_is_independent)
        for name in (*ROWS, "first_row", *PASSES):
            values = getattr(log, name)
            if isinstance(values, tuple):
                values = np.array([text.encode() for text in values], dtype=np.bytes_)
            file.create_dataset(
                name, data=values, chunks=True, compression="gzip", fletcher32=True, track_times=False
            )  # fmt: skip
        file.flush()
        image: bytes = file.id.get_file_image()
    write_atomically(path, image)


def read_hdf5_log(path: Path, mapping: LogMapping) -> LogColumns:
    """The rows of the HDF5 file at `path`; only `path` of a mapping is used: such files have their own units.

    `InvalidLog` for anything that is no whole log; `OSError`; `ImportError` without h5py.
    """
    import h5py

    source = os.fspath(path)
    try:
        content = read_regular_file(path, LARGEST_FILE_BYTES)
    except DamagedTable as fault:
        raise InvalidLog(str(fault)) from fault
    try:
        with h5py.File(io.BytesIO(content), "r") as file:
            return _columns(file, source, mapping)
    except (InvalidLog, MemoryError):
        raise
    # What is wrong with a file surfaces in h5py as one of a dozen types.
    except Exception as fault:
        reason = excerpt(" ".join(str(fault).split()), 200)
        raise InvalidLog(f"{source}: not readable as an HDF5 pass log ({reason}); write it anew.") from fault


def _columns(file: h5py.File, source: str, mapping: LogMapping) -> LogColumns:
    found, version, word = (file.attrs.get(name) for name in ("format", "version", "path"))
    if not isinstance(found, str) or found != FORMAT or version != VERSION:
        raise InvalidLog(
            f'{source}: format is {excerpt(repr(found))}, version {excerpt(repr(version))}; it must be "{FORMAT}", '
            f"version {VERSION}."
        )
    if word not in PATHS:
        raise InvalidLog(f"{source}: path is {excerpt(repr(word))}; it must be one of {', '.join(PATHS)}.")
    rows = {name: _stored(file, name, source) for name in ROWS}
    passes = {name: _stored(file, name, source) for name in PASSES}
    ends = _stored(file, "first_row", source)
    _require_lengths(source, rows, passes, ends)
    counts = np.diff(ends).astype(np.int64)
    numbers = {name: value.astype(np.float64) for name, value in rows.items()}
    numbers |= {name: np.repeat(passes[name].astype(np.float64), counts) for name in PASSES if name not in TEXTS}
    first = tuple(ends[:-1].astype(int).tolist())
    cut_id, category = (TextRuns(first, _decoded(source, name, passes[name])) for name in TEXTS)
    independent = PATHS[word] if mapping.path_is_independent is None else mapping.path_is_independent
    return LogColumns(source, 1, {name: numbers[name] for name in NUMBERS}, cut_id, category, independent)


def _stored(file: h5py.File, name: str, source: str) -> npt.NDArray[Any]:
    import h5py

    kept = file.get(name)
    kinds = "S" if name in TEXTS else "fiub"
    if not isinstance(kept, h5py.Dataset) or kept.ndim != 1 or kept.dtype.kind not in kinds:
        raise InvalidLog(f"{source}: column {name} is missing or no column of {'text' if kinds == 'S' else 'numbers'}.")
    if kept.size * kept.dtype.itemsize > LARGEST_FILE_BYTES:
        raise InvalidLog(f"{source}: column {name} has {kept.size} entries; that is more than is read at a time.")
    values: npt.NDArray[Any] = kept[()]
    return values


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
    texts = tuple(value.decode() for value in values.tolist())
    for number, text in enumerate(texts):
        if not text or not text.isprintable():
            raise InvalidLog(f"{source}: column {name}, pass {number + 1}: {text!r:.60} is no name; write one.")
    return texts
