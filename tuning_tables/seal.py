"""A seal at the end of a file: one line with the SHA-256 of all that stands before it.

It is for formats whose own library must not meet a damaged file. HDF5 is one: a single flipped bit in a part that it
keeps without a checksum (the heap of strings and references) can hold it in an endless loop, as was measured with
HDF5 2.0. With the seal, plain Python has read every byte before the library sees the first. HDF5 ignores what follows
its own end, so that h5py and xarray open a sealed file as any other; a program that writes into it breaks the seal.
"""

from __future__ import annotations

import hashlib
from typing import Final

from tuning_tables.errors import DamagedTable

SEAL_PREFIX: Final = b"\n# sealed, sha256 of all before this line: "
SEAL_BYTES: Final = len(SEAL_PREFIX) + 64 + 1


def seal_of(body: bytes | memoryview) -> bytes:
    """The line to append to `body`: SEAL_PREFIX, 64 hex digits, line feed."""
    return SEAL_PREFIX + hashlib.sha256(body).hexdigest().encode("ascii") + b"\n"


def is_sealed(content: bytes) -> bool:
    """Whether a seal stands at the end of `content`; it need not fit."""
    return content[-SEAL_BYTES:].startswith(SEAL_PREFIX)


def seal_fits(content: bytes) -> bool:
    """Whether the seal at the end of the sealed `content` is that of all before it."""
    return content[-SEAL_BYTES:] == seal_of(memoryview(content)[:-SEAL_BYTES])


def unsealed(content: bytes, source: str) -> memoryview:
    """The body of the sealed `content`, not copied; `source` names the file it was read from in messages.

    Raises `DamagedTable` where the seal is missing or does not fit.
    """
    if not is_sealed(content):
        raise DamagedTable(
            f"{source}: there is no seal at its end, so it was cut off, edited or made by another program; "
            "export it again."
        )
    if not seal_fits(content):
        raise DamagedTable(f"{source}: the seal at its end does not fit what is before it; export it again.")
    return memoryview(content)[:-SEAL_BYTES]
