"""A book of tables as an HDF5 file, readable by h5py and xarray without this project. Needs h5py, and only when called.

Root attributes: format "retarder-book", schema_version, tool_version, config_sha256, payload_sha256, complete = 1.
Datasets: those of `book_columns.COLUMNS`, each with attributes `units` and `meaning`, chunked in one piece with a
fletcher32 checksum; text as fixed-length UTF-8. Each axis is a dimension scale of its own name, numbered from 0.

payload_sha256 is the SHA-256 of the canonical JSON (see `canonical`) of

    {"attributes": {root attributes less payload_sha256},
     "datasets": {name: {"dtype", "shape", "units", "meaning", "sha256": of the values, C order, little endian}}}

with `dtype` as numpy writes it ("<f4", "|S12"). Equal books give equal bytes: nothing in the file tells time or place.
The file ends with a seal (see `seal`), and is read only under an unbroken one.
"""

from __future__ import annotations

import hashlib
import io
import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

from tuning_tables.atomic_file import replacing
from tuning_tables.book_columns import AXES, COLUMNS, Column, columns_of, tables_of
from tuning_tables.canonical import canonical_json
from tuning_tables.errors import DamagedTable, InvalidTable, NewerVersion, OlderVersion, TableError, UnknownFormat
from tuning_tables.provenance import Generator
from tuning_tables.seal import seal_of, unsealed
from tuning_tables.table import ControllerTable

if TYPE_CHECKING:
    import h5py

FORMAT: Final = "retarder-book"
SCHEMA_VERSION: Final = 1
SIGNATURE: Final = b"\x89HDF\r\n\x1a\n"
# The oldest file version whose metadata carry checksums, for readers that know nothing of the seal.
FILE_VERSION: Final = ("v108", "v108")
LARGEST_DATASET_BYTES: Final = 2**30

_ATTRIBUTES: Final = ("complete", "config_sha256", "format", "payload_sha256", "schema_version", "tool_version")


def write_book(
    tables: Sequence[ControllerTable], path: str | os.PathLike[str], generator: Generator | None = None
) -> None:
    """Write `tables` to the file at `path`, complete or not at all.

    `generator`: the run that bound the book, by default the generator of the tables, which must then be one for all.
    Raises `InvalidTable` for no tables, an id given twice, generators that differ; `OSError`; `ImportError` without
    h5py.
    """
    import h5py

    arrays = columns_of(tables)
    origin = generator or _common_generator(tables)
    attributes: dict[str, str | int] = {
        "complete": 1,
        "config_sha256": origin.config_sha256,
        "format": FORMAT,
        "schema_version": SCHEMA_VERSION,
        "tool_version": origin.version,
    }
    attributes["payload_sha256"] = _payload_sha256(attributes, arrays)
    with replacing(path) as part:
        with h5py.File(part, "w", libver=FILE_VERSION) as file:
            for axis, meaning in AXES.items():
                _write_axis(file, axis, _axis_length(axis, arrays), meaning)
            for column in COLUMNS:
                _write_column(file, column, arrays[column.name])
            for name in _ATTRIBUTES:
                file.attrs[name] = attributes[name]
        body = part.read_bytes()
        part.write_bytes(body + seal_of(body))


def read_book(path: str | os.PathLike[str]) -> tuple[ControllerTable, ...]:
    """The tables in the file at `path`, in the order in which they were written.

    Raises `UnknownFormat` for a file that is no HDF5 or holds another sealed format, `NewerVersion`, `OlderVersion` for
    a book of another version, `DamagedTable` for everything that is no complete, unchanged book, unsealed HDF5 files
    among them; `OSError` where the file cannot be opened; `ImportError` without h5py.
    """
    import h5py

    source = os.fspath(path)
    content = Path(path).read_bytes()
    # A beginning of the signature alone may be a book that was cut off.
    if not content.startswith(SIGNATURE[: len(content)]):
        raise UnknownFormat(f"{source}: not an HDF5 file; give a table book.")
    body = unsealed(content, source)
    try:
        # From memory: what was found unbroken is what is read.
        with h5py.File(io.BytesIO(body), "r") as file:
            return tables_of(_checked_arrays(file, source))
    except InvalidTable as invalid:
        raise DamagedTable(f"{source}: {invalid}") from invalid
    except TableError:
        raise
    # What is wrong with a file under a right seal surfaces in h5py as one of a dozen types.
    except Exception as fault:
        raise DamagedTable(f"{source}: not a readable table book ({fault}); export it again.") from fault


def _common_generator(tables: Sequence[ControllerTable]) -> Generator:
    generators = {table.generator for table in tables}
    if len(generators) > 1:
        raise InvalidTable("the tables have different generators; name the one that binds the book.")
    return generators.pop()


def _axis_length(axis: str, arrays: dict[str, npt.NDArray[Any]]) -> int:
    column = next(column for column in COLUMNS if axis in column.axes)
    return int(arrays[column.name].shape[column.axes.index(axis)])


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
    for position, axis in enumerate(column.axes):
        dataset.dims[position].attach_scale(file[axis])


def _checked_arrays(file: h5py.File, source: str) -> dict[str, npt.NDArray[Any]]:
    """The arrays of the book, after everything about the file was found to be as written."""
    attributes = {name: _plain(value) for name, value in file.attrs.items()}
    _require_version(attributes, source)
    if tuple(sorted(attributes)) != _ATTRIBUTES:
        raise DamagedTable(f"{source}: root attributes are {sorted(attributes)}, but must be {list(_ATTRIBUTES)}.")
    if attributes["complete"] != 1:
        raise DamagedTable(f"{source}: complete is {attributes['complete']!r}, but must be 1; export the book again.")
    expected = {column.name for column in COLUMNS} | set(AXES)
    if set(file) != expected:
        raise DamagedTable(f"{source}: {sorted(set(file) ^ expected)} are missing or unknown; export the book again.")
    arrays = {column.name: _read_column(file[column.name], column, source) for column in COLUMNS}
    stored = attributes.pop("payload_sha256")
    if stored != _payload_sha256(attributes, arrays):
        raise DamagedTable(f"{source}: payload_sha256 is {stored!r}, but the content gives another; export it again.")
    return arrays


def _require_version(attributes: dict[str, Any], source: str) -> None:
    if attributes.get("format") != FORMAT:
        raise UnknownFormat(
            f'{source}: format is {attributes.get("format")!r:.60}, but it must be "{FORMAT}"; give a table book.'
        )
    version = attributes.get("schema_version")
    if not isinstance(version, int):
        raise DamagedTable(f"{source}: schema_version is {version!r:.60}, but it must be {SCHEMA_VERSION}.")
    if version > SCHEMA_VERSION:
        raise NewerVersion(f"{source}: schema_version is {version}, this reader knows {SCHEMA_VERSION}; update it.")
    if version < SCHEMA_VERSION:
        raise OlderVersion(f"{source}: schema_version is {version}, not {SCHEMA_VERSION}; export the book again.")


def _read_column(dataset: h5py.Dataset, column: Column, source: str) -> npt.NDArray[Any]:
    fits = dataset.dtype.kind == "S" if column.dtype == "S" else dataset.dtype == np.dtype(column.dtype)
    if not fits or dataset.ndim != len(column.axes) or dataset.nbytes > LARGEST_DATASET_BYTES:
        raise DamagedTable(
            f"{source}: {column.name} is {dataset.dtype} {dataset.shape}, but it must be {column.dtype} {column.axes}."
        )
    if (dataset.attrs["units"], dataset.attrs["meaning"]) != (column.unit, column.meaning):
        raise DamagedTable(f"{source}: {column.name} has other units than {column.unit!r}; export the book again.")
    values: npt.NDArray[Any] = dataset[()]
    return values


def _payload_sha256(attributes: dict[str, Any], arrays: dict[str, npt.NDArray[Any]]) -> str:
    datasets = {
        column.name: {
            "dtype": arrays[column.name].dtype.str,
            "shape": list(arrays[column.name].shape),
            "units": column.unit,
            "meaning": column.meaning,
            "sha256": hashlib.sha256(np.ascontiguousarray(arrays[column.name]).tobytes()).hexdigest(),
        }
        for column in COLUMNS
    }
    return hashlib.sha256(canonical_json({"attributes": attributes, "datasets": datasets})).hexdigest()


def _plain(value: Any) -> Any:
    """An attribute as Python value: h5py gives numbers as numpy scalars."""
    return value.item() if isinstance(value, np.generic) else value
