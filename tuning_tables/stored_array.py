"""One array, axis or attribute of a book, read only where it lies in the file as the export puts it there.

HDF5 offers more than a book needs, and some of it reads other files (external and soft links, virtual and external
storage), runs other programs (filter plugins) or fills the memory from a few bytes (fill values, compression). None of
it is followed: what is looked at first are descriptions, which cost nothing.
"""

from __future__ import annotations

import math
from typing import Any, Final

import h5py
import numpy as np
import numpy.typing as npt

from tuning_tables.declared.columns import Column
from tuning_tables.errors import DamagedTable

AXIS_DTYPE: Final = np.dtype("<i4")
CHECKSUM_BYTES: Final = 4


def scalar_attribute(owner: h5py.File | h5py.Dataset, name: str) -> str | int | None:
    """The text or whole number in the attribute `name` of `owner`; None where there is none, or something else."""
    if name not in owner.attrs or owner.attrs.get_id(name).shape != ():
        return None
    value = owner.attrs[name]
    if isinstance(value, np.integer):
        return int(value)
    return value if isinstance(value, str) else None


def stored_array(file: h5py.File, column: Column, most_bytes: int, source: str) -> npt.NDArray[Any]:
    """The values of `column`, whose dataset must be of its type, axes, units and meaning.

    Raises `DamagedTable` naming `source` and the column for any other, and for one that does not lie in the file
    itself, in one piece of at most `most_bytes`, with fletcher32 as its only filter.
    """
    dataset = _own_dataset(file, column.name, source)
    if _filters(dataset) != [h5py.h5z.FILTER_FLETCHER32]:
        raise DamagedTable(
            f"{source}: {column.name} is not stored as the export does it, in one chunk with fletcher32 alone; "
            "export the book again."
        )
    fits = dataset.dtype.kind == "S" if column.dtype == "S" else dataset.dtype == np.dtype(column.dtype)
    if not fits or dataset.ndim != len(column.axes):
        raise DamagedTable(
            f"{source}: {column.name} is {dataset.dtype} {dataset.shape}, but it must be {column.dtype} {column.axes}."
        )
    # Not dataset.nbytes, which overflows for the sizes that a file may claim.
    n_bytes = dataset.dtype.itemsize * math.prod(map(int, dataset.shape))
    whole = dataset.chunks == dataset.shape and dataset.id.get_storage_size() == n_bytes + CHECKSUM_BYTES
    if not whole or n_bytes > most_bytes:
        raise DamagedTable(
            f"{source}: {column.name} claims {n_bytes} bytes, shape {dataset.shape}, which are not in the file as one "
            "piece; export the book again."
        )
    found = scalar_attribute(dataset, "units"), scalar_attribute(dataset, "meaning")
    if found != (column.unit, column.meaning):
        raise DamagedTable(f"{source}: {column.name} has other units than {column.unit!r}; export the book again.")
    values: npt.NDArray[Any] = dataset[()]
    return values


def require_axis(file: h5py.File, axis: str, length: int, source: str) -> None:
    """The scale of `axis` numbers its `length` entries from 0; raises `DamagedTable` naming `source` and the axis."""
    dataset = _own_dataset(file, axis, source)
    plain = dataset.shape == (length,) and _is_plain(dataset, AXIS_DTYPE)
    if not plain or not np.array_equal(dataset[()], np.arange(length)):
        raise DamagedTable(f"{source}: {axis} does not number {length} entries from 0; export the book again.")


def plain_column(file: h5py.File, name: str, dtype: str, source: str) -> npt.NDArray[Any]:
    """The values of the dataset `name`, which has one axis, this type and no filter, and lies in the file itself.

    Raises `DamagedTable` naming `source` and the dataset for any other.
    """
    dataset = _own_dataset(file, name, source)
    if dataset.ndim != 1 or not _is_plain(dataset, np.dtype(dtype)):
        raise DamagedTable(f"{source}: {name} is not stored as the export does it, a plain column; export it again.")
    values: npt.NDArray[Any] = dataset[()]
    return values


def _is_plain(dataset: h5py.Dataset, dtype: np.dtype[Any]) -> bool:
    """Whether it is of that type, without filters, and allocated to the full: the rest would be made up when read."""
    n_bytes = dataset.dtype.itemsize * math.prod(map(int, dataset.shape or ()))
    return _filters(dataset) == [] and dataset.dtype == dtype and dataset.id.get_storage_size() == n_bytes


def _own_dataset(file: h5py.File, name: str, source: str) -> h5py.Dataset:
    """The dataset `name`, known to lie in the file itself, values and all."""
    # Asked before the link is followed.
    if not isinstance(file.get(name, getlink=True), h5py.HardLink):
        raise DamagedTable(f"{source}: {name} is a link to elsewhere, but it must be in the file itself.")
    dataset = file[name]
    if isinstance(dataset, h5py.Dataset):
        creation = dataset.id.get_create_plist()
        # Asked before the shape, for which HDF5 may open the sources of a virtual dataset.
        if creation.get_layout() != h5py.h5d.VIRTUAL and creation.get_external_count() == 0:
            return dataset
    raise DamagedTable(f"{source}: {name} is no dataset whose values are in the file itself; export it again.")


def _filters(dataset: h5py.Dataset) -> list[int]:
    creation = dataset.id.get_create_plist()
    return [creation.get_filter(index)[0] for index in range(creation.get_nfilters())]
