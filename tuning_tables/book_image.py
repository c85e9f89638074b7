"""The HDF5 image of a book: root attributes, axes and columns, made in memory. Needs h5py, when called."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

from tuning_tables.book_layout import Layout
from tuning_tables.declared.columns import Column, Columns

if TYPE_CHECKING:
    import h5py

FORMAT: Final = "retarder-book"
VERSION: Final = 1
# The oldest file version whose metadata carry checksums, for readers that know nothing of the seal.
FILE_VERSION: Final = ("v108", "v108")
COORDINATES: Final = ("id", "cut_category", "cut_mass_t", "target_speed_m_s")
ATTRIBUTES: Final = ("complete", "config_sha256", "exported_by", "format", "kind", "payload_sha256", "version")


def image_of(attributes: Mapping[str, str | int], arrays: Columns, layout: Layout) -> bytes:
    """The HDF5 file of a book, made in memory."""
    import h5py

    # The name stands nowhere in the file, and nothing is written to the disk.
    with h5py.File("book", "w", libver=FILE_VERSION, driver="core", backing_store=False) as file:
        for axis, meaning in layout.axes.items():
            write_axis(file, axis, layout.length(axis, arrays), meaning)
        for column in layout.columns:
            write_column(file, column, arrays[column.name])
        for name in ATTRIBUTES:
            file.attrs[name] = attributes[name]
        file.flush()
        image: bytes = file.id.get_file_image()
    return image


def write_axis(file: h5py.File, axis: str, length: int, meaning: str) -> None:
    """Write an axis: a dimension scale of its own name, numbered from 0."""
    scale = file.create_dataset(axis, data=np.arange(length, dtype="<i4"), track_times=False)
    scale.make_scale(axis)
    scale.attrs["meaning"] = meaning


def write_column(file: h5py.File, column: Column, values: npt.NDArray[Any]) -> None:
    """Write a column with its unit and meaning, in one piece and with a checksum, and attach its axes."""
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
