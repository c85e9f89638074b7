"""Tables in an HDF5 book, as the documents that their JSON files would hold; the only part that needs h5py."""

from __future__ import annotations

import hashlib
import io
import math
import re
from collections.abc import Mapping
from typing import Any, Final

from synth.checker.book_layout import (
    HEAD,
    axes_of,
    datasets_of,
    require_axes,
    require_filled_up,
    require_stored,
)
from synth.checker.content import LARGEST_BYTES, canonical_form
from synth.checker.document_shape import TEXT, OneOf, OrNull, Pair, Row, Single, is_a
from synth.checker.finding import DamagedError, shown

SIGNATURE: Final = b"\x89HDF\r\n\x1a\n"
SEAL: Final = b"\n# sealed, sha256 of all before this line: "
NUMBERED: Final = frozenset({"version", "complete"})
ATTRIBUTES: Final = NUMBERED | {"format", "kind", "exported_by", "config_sha256", "payload_sha256"}
SHA256: Final = re.compile("[0-9a-f]{64}")

Shape = Mapping[str, Any]
Cells = Mapping[str, Any]


def read_documents(content: bytes, shapes: Mapping[str, Shape]) -> list[dict[str, Any]]:
    """The documents of the tables in a book, less their checksums, in their order; `DamagedError` otherwise.

    `shapes`: what documents must look like, by the kind of tables that the book may hold.
    """
    body = unsealed(content)
    try:
        import h5py
    except ImportError:
        raise DamagedError("it is an HDF5 book, which cannot be checked without h5py; install h5py") from None
    try:
        with h5py.File(io.BytesIO(body), "r") as book:
            return checked_documents(book, shapes)
    except DamagedError:
        raise
    except Exception as fault:  # h5py tells what it finds wrong in a dozen types
        raise DamagedError(f"it is no readable book ({type(fault).__name__}: {fault})") from None


def unsealed(content: bytes) -> bytes:
    """What stands before the seal, which must fit."""
    if not content.startswith(SIGNATURE):
        raise DamagedError("it is no HDF5 file")
    body, mark, rest = content.rpartition(SEAL)
    if not mark or rest != hashlib.sha256(body).hexdigest().encode("ascii") + b"\n":
        raise DamagedError("its seal is missing or broken: it was cut off, edited, or made by another program")
    return body


def checked_documents(book: Any, shapes: Mapping[str, Shape]) -> list[dict[str, Any]]:
    """All documents, once attributes, names, `payload_sha256` and what fills gaps are right."""
    attributes = root_attributes(book)
    kind = attributes["kind"]
    if attributes["version"] != 1 or kind not in shapes:
        found = f"version {shown(attributes['version'])} of the kind {shown(kind)}"
        raise DamagedError(f"it is {found}, but this checker knows only version 1 of {', '.join(shapes)}")
    datasets = datasets_of(shapes[kind], set(book))
    unlike = set(book) ^ (datasets.keys() | axes_of(datasets))
    if unlike:
        raise DamagedError(f"the datasets {shown(sorted(unlike))} are missing or unknown")
    stored = attributes.pop("payload_sha256")
    for name in book:
        require_own(book, name)
    for name in datasets:
        require_stored(name, book[name], datasets[name])
    values = {name: book[name][()] for name in datasets}
    described = {
        name: {
            "dtype": array.dtype.str,
            "shape": list(array.shape),
            "units": book[name].attrs["units"],
            "meaning": book[name].attrs["meaning"],
            "sha256": hashlib.sha256(array.tobytes()).hexdigest(),
        }
        for name, array in values.items()
    }
    payload = canonical_form({"attributes": attributes, "datasets": described})
    if stored != hashlib.sha256(payload.encode("utf-8")).hexdigest():
        raise DamagedError("its payload_sha256 does not fit its content")
    require_axes(book, values, datasets)
    columns = {name: array.tolist() for name, array in values.items()}
    members = {key: form for key, form in shapes[kind].items() if key not in HEAD}
    head = {"format": "retarder-table", "version": 1, "kind": kind, "exported_by": attributes["exported_by"]}
    rows = ({name: column[row] for name, column in columns.items()} for row in range(len(columns["id"])))
    documents = [head | section_of(members, cells, "") for cells in rows]
    require_filled_up(columns, datasets, documents)
    return documents


def require_own(book: Any, name: str) -> None:
    """Raise `DamagedError` unless the dataset lies in this very file, for HDF5 can point anywhere, and is not huge."""
    import h5py

    if not isinstance(book.get(name, getlink=True), h5py.HardLink) or not isinstance(book[name], h5py.Dataset):
        raise DamagedError(f"{name} is no dataset of its own")
    dataset = book[name]
    if dataset.is_virtual or dataset.external or dataset.nbytes > LARGEST_BYTES:
        raise DamagedError(f"{name} does not lie in the file, or is larger than {LARGEST_BYTES} bytes")


def root_attributes(book: Any) -> dict[str, Any]:
    """The attributes of the book itself, each a single text or whole number as documented."""
    found = {name: value.item() if getattr(value, "shape", None) == () else value for name, value in book.attrs.items()}
    whole = found.keys() == ATTRIBUTES and found["format"] == "retarder-book" and found["complete"] == 1
    whole = whole and all(type(value) is (int if name in NUMBERED else str) for name, value in found.items())
    whole = whole and is_a(TEXT, found["exported_by"]) and bool(SHA256.fullmatch(found["config_sha256"]))
    if not whole:
        raise DamagedError(f"its attributes {shown(found)} are not those of a complete book")
    return found


def section_of(members: Shape, cells: Cells, prefix: str) -> dict[str, Any]:
    """The object whose members stand in the cells of one table that begin with `prefix`."""
    return {key: member_of(form, cells, prefix + key) for key, form in members.items()}


def member_of(form: Any, cells: Cells, name: str) -> Any:
    """The member in the cells called `name`; `DamagedError` for cells that make none."""
    inner = form.form if isinstance(form, OrNull | Row) else form
    if not isinstance(inner, Mapping):
        return leaf_of(form, cells[name])
    if isinstance(form, Row):
        below = {key: cell for key, cell in cells.items() if key.startswith(f"{form.axis}_")}
        room, count = min(map(len, below.values())), cells[name]
        if not 0 <= count <= room:
            raise DamagedError(f"it says that there are {count} {name}, but it has room for {room}")
        return [
            section_of(inner, {key: cell[index] for key, cell in below.items()}, f"{form.axis}_")
            for index in range(count)
        ]
    if isinstance(form, OrNull):
        if cells[name] not in (0, 1):
            raise DamagedError(f"{name} is {shown(cells[name])}, but it must be 0 or 1")
        if cells[name] == 0:
            return None
    return section_of(inner, cells, f"{name}_")


def leaf_of(form: Any, cell: Any) -> Any:
    """A text, a number or a row of numbers, as JSON has it."""
    match form:
        case OrNull():
            return None if is_gap(cell) else leaf_of(form.form, cell)
        case Row() if isinstance(form.form, OrNull):  # an infinity in a book is null in JSON
            return [None if math.isinf(each) else each for each in cell if not is_gap(each)]
        case Row():
            return [leaf_of(form.form, each) for each in cell if not is_gap(each)]
        case Pair():
            return cell
        case OneOf():
            return cell.decode("utf-8")
        case Single():
            return cell
    return cell.decode("utf-8") if form == TEXT else cell


def is_gap(cell: Any) -> bool:
    """Whether a cell, or all of its numbers, is what fills gaps."""
    if isinstance(cell, list):
        return all(map(is_gap, cell))
    return math.isnan(cell) if isinstance(cell, float) else cell in (0, b"")
