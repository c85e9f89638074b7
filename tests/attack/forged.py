"""HDF5 files that hold something else than their writer put there, under sums that are right for it."""

from __future__ import annotations

import io
import random
from collections.abc import Callable
from contextlib import suppress
from typing import Any, Final

import h5py
import numpy as np

from tests.tuning_tables.forged_book import correct_payload
from tuning_tables.whole_file import SEAL_BYTES, is_sealed, seal_of

Edit = Callable[[h5py.File, str, random.Random], None]
"""Changes something about the dataset of that name."""

FLOATS: Final = (0.0, -0.0, -1.0, float("nan"), float("inf"), -float("inf"), 1e308, 1e30, 5e-324, 1.0, 1e9)
TEXTS: Final = (b"", b"x", b"x" * 3000, b"../../etc/passwd", b"a\nb", b"\xff", b"a\x00b", b"=1+1", "\u202e".encode())
DTYPES: Final = ("<f4", "<f8", ">f8", "<f2", "<i1", "<i4", ">i8", "<u8", "|b1", "S5", "S70", "<c16")
MOST: Final = 2**24
SIZES: Final = (2**20, 2**28, 2**34, 2**60)
"""Entries that a dataset claims to have."""

STORAGE: Final[tuple[dict[str, Any], ...]] = (
    {},
    {"chunks": True},
    {"chunks": True, "compression": "gzip"},
    {"chunks": True, "compression": "gzip", "fletcher32": True},
    {"chunks": True, "shuffle": True},
    {"chunks": True, "maxshape": None},
)


def forged(content: bytes, dice: random.Random) -> bytes:
    """The HDF5 file `content` after one to three edits; its SHA-256 and its seal, where it has them, are right."""
    sealed = is_sealed(content)
    image = io.BytesIO(content[:-SEAL_BYTES] if sealed else content)
    with h5py.File(image, "r+") as file:
        for _ in range(dice.choice((1, 1, 1, 2, 3))):
            if any(isinstance(each, h5py.Dataset) and (each.size or 0) > MOST for each in map(file.get, file)):
                break  # it claims more than may be read to change it once more
            name = dice.choice(sorted(file))
            edit = dice.choice(EDITS if isinstance(file.get(name), h5py.Dataset) else (attribute,))
            with suppress(KeyError, OSError, RuntimeError, TypeError, ValueError):  # HDF5 refuses this one after that
                edit(file, name, dice)
        with suppress(TypeError, OSError, RuntimeError, MemoryError):  # what is no column any more has no sum
            correct_payload(file, {})
    body = image.getvalue()
    return body + seal_of(body) if sealed else body


def replaced(file: h5py.File, name: str, values: Any, storage: dict[str, Any]) -> None:
    """`values` in place of the dataset, of the same attributes, and stored so where HDF5 can do it."""
    attributes = [(key, value) for key, value in file[name].attrs.items() if key != "DIMENSION_LIST"]
    del file[name]
    try:
        new = file.create_dataset(name, data=values, **storage)
    except (TypeError, ValueError):
        new = file.create_dataset(name, data=values)
    for key, value in attributes:
        new.attrs[key] = value


def as_stored(file: h5py.File, name: str) -> dict[str, Any]:
    """How the dataset is stored: in one piece with a checksum, or as it comes."""
    return {"chunks": file[name].shape, "fletcher32": True} if file[name].fletcher32 else {}


def entry(file: h5py.File, name: str, dice: random.Random) -> None:
    """One entry is another value of the type."""
    values = file[name][()]
    if not np.size(values):
        return
    flat = np.atleast_1d(values).reshape(-1).copy()
    at = dice.randrange(flat.size)
    if flat.dtype.kind in "SO":
        flat[at] = dice.choice((*TEXTS, flat[dice.randrange(flat.size)]))
    elif flat.dtype.kind in "iu":
        limits = np.iinfo(flat.dtype)
        near = (int(flat[at]) + step for step in (-1, 1))
        flat[at] = min(max(dice.choice((0, 1, -1, limits.min, limits.max, *near)), limits.min), limits.max)
    elif flat.dtype.kind == "f":
        with np.errstate(over="ignore", under="ignore"):
            flat[at] = dice.choice((*FLOATS, flat[at] * 1.0001, -flat[at], flat[dice.randrange(flat.size)]))
    replaced(file, name, flat.reshape(np.shape(values)), as_stored(file, name))


def dtype(file: h5py.File, name: str, dice: random.Random) -> None:
    """All entries are of another type."""
    kept = as_stored(file, name)
    values = np.ones(file[name].shape, dtype=dice.choice(DTYPES))
    others: dict[int, Callable[[], Any]] = {
        0: lambda: np.full(file[name].shape, "x", dtype=h5py.string_dtype()),
        1: lambda: np.full(file[name].shape, file.ref, dtype=h5py.ref_dtype),
        2: lambda: np.zeros(file[name].shape, dtype=[("a", "<f8"), ("b", "<i4")]),
    }
    replaced(file, name, others.get(dice.randrange(10), lambda: values)(), kept)


def shape(file: h5py.File, name: str, dice: random.Random) -> None:
    """The entries have another shape: fewer, more, none, an axis more or less, or their axes are exchanged."""
    kept, values = as_stored(file, name), file[name][()]
    if not np.ndim(values):
        return
    axis = dice.randrange(values.ndim)
    other = dice.choice((
        lambda: np.take(values, [], axis=axis),
        lambda: np.take(values, range(max(values.shape[axis] - 1, 0)), axis=axis),
        lambda: np.concatenate([values, values], axis=axis),
        lambda: np.expand_dims(values, axis),
        lambda: values.T,
        lambda: values.reshape(-1),
        lambda: np.flip(values, axis),
        lambda: values.reshape(-1)[0] if values.size else values,
    ))()  # fmt: skip
    replaced(file, name, other, {"chunks": other.shape, "fletcher32": True} if kept and np.size(other) else {})


def size(file: h5py.File, name: str, dice: random.Random) -> None:
    """It claims a size that it does not have, and holds nothing, or nothing but equal numbers."""
    kept = file[name].dtype if file[name].dtype.kind in "fiu" else np.dtype("<f8")
    del file[name]
    claimed = (dice.choice(SIZES),)
    how = dice.randrange(4)
    if how == 0:
        file.create_dataset(name, shape=claimed, dtype=kept, chunks=(2**20,), fillvalue=1)
    elif how == 1:
        file.create_dataset(name, shape=claimed, dtype=kept, chunks=(2**20,), compression="gzip", maxshape=(None,))
    elif how == 2:
        file.create_dataset(name, data=np.zeros(2**23, kept), chunks=(2**20,), compression="gzip", fletcher32=True)
    else:
        file.create_dataset(name, shape=claimed, dtype=kept)


def link(file: h5py.File, name: str, dice: random.Random) -> None:
    """It lies elsewhere, is something else, or is not there."""
    others = sorted(file)
    kept = file[name].shape, file[name].dtype
    del file[name]
    match dice.randrange(8):
        case 0:
            file[name] = h5py.SoftLink(f"/{dice.choice((name, 'nothing', *others))}")
        case 1:
            file[name] = h5py.ExternalLink(dice.choice(("/etc/passwd", "/dev/zero", ".", "book.h5", "log.h5")), "/id")
        case 2:
            file.create_group(name)
        case 3:
            file[name] = file["/"]
        case 4:
            file[name] = np.dtype("<f8")
        case 5:
            file[name] = file.get(dice.choice(others)) or file["/"]
        case 6:
            layout = h5py.VirtualLayout(shape=kept[0], dtype="<f8")
            file.create_virtual_dataset(name, layout, fillvalue=dice.choice((0.0, 1.0)))
        case _:
            pass


def storage(file: h5py.File, name: str, dice: random.Random) -> None:
    """The same entries stored otherwise."""
    replaced(file, name, file[name][()], dice.choice(STORAGE))


def attribute(file: h5py.File, name: str, dice: random.Random) -> None:
    """An attribute, of the file or of the dataset, is another one, missing or new."""
    owner = dice.choice((file, file.get(name) or file))
    key = dice.choice((*sorted(set(owner.attrs) - {"payload_sha256"}), "surplus"))
    value = dice.choice(
        (None, 0, -1, 2, 2**63 - 1, 1.5, float("nan"), "", "x", "x" * 5000, b"\xff", "a\nb", [1, 2], ["m", "s"], [])
    )
    if key in owner.attrs:
        del owner.attrs[key]
    if value is not None:
        owner.attrs[key] = value


def surplus(file: h5py.File, name: str, dice: random.Random) -> None:
    """There is something more."""
    new = dice.choice(("surplus", "é", "x" * 1000, "a b"))
    if new not in file:
        file[new] = dice.choice((1.0, [1.0, 2.0], "text"))


def exchanged(file: h5py.File, name: str, dice: random.Random) -> None:
    """Two datasets have each other's name."""
    other = dice.choice(sorted(file))
    if other != name:
        file.move(name, "aside")
        file.move(other, name)
        file.move("aside", other)


EDITS: Final[tuple[Edit, ...]] = (
    entry, entry, entry, entry, dtype, shape, shape, size, link, storage, attribute, attribute, surplus, exchanged,
)  # fmt: skip
