"""The checksum over everything that a book says, independent of how HDF5 lays it out in the file.

It is the SHA-256 of the canonical JSON (see `canonical`) of

    {"attributes": {root attributes less payload_sha256},
     "datasets": {name: {"dtype", "shape", "units", "meaning", "sha256": of the values, C order, little endian}}}

with `dtype` as numpy writes it ("<f4", "|S12").
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping

import numpy as np

from tuning_tables.book_layout import Layout
from tuning_tables.canonical import canonical_json
from tuning_tables.declared.columns import Columns


def payload_sha256(attributes: Mapping[str, str | int], arrays: Columns, layout: Layout) -> str:
    """64 hex digits over `attributes`, which must be without payload_sha256, and all arrays of `layout`."""
    datasets = {
        column.name: {
            "dtype": arrays[column.name].dtype.str,
            "shape": list(arrays[column.name].shape),
            "units": column.unit,
            "meaning": column.meaning,
            "sha256": hashlib.sha256(np.ascontiguousarray(arrays[column.name]).tobytes()).hexdigest(),
        }
        for column in layout.columns
    }
    return hashlib.sha256(canonical_json({"attributes": dict(attributes), "datasets": datasets})).hexdigest()
