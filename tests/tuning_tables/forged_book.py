"""Books that are wrong although every sum in them is right: what a careless or hostile writer might leave."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import numpy.typing as npt

from tuning_tables import TableError, read_any_book, write_book
from tuning_tables.book_layout import Layout, payload_sha256, stored_layout
from tuning_tables.document import StageTable
from tuning_tables.json_text import canonical_json
from tuning_tables.whole_file import seal_of

Edit = Callable[[h5py.File], None]
Arrays = Mapping[str, npt.NDArray[Any]]
NOTHING_KNOWN: Arrays = {}


def forge(path: Path, edit: Edit, known: Arrays = NOTHING_KNOWN) -> None:
    """Apply `edit` to the open file of the book at `path`, then make payload_sha256 and seal right again.

    `known`: the arrays of the datasets that `edit` leaves alone, which need not be read again.
    """
    with h5py.File(path, "r+") as file:
        edit(file)
        correct_payload(file, known)
    reseal(path)


def arrays_in(path: Path) -> Arrays:
    """The values of all datasets of the book at `path`."""
    with h5py.File(path) as file:
        return {name: dataset[()] for name, dataset in file.items()}


def reseal(path: Path) -> None:
    """End the file at `path` with a seal that fits all before it, whatever stands there."""
    body = path.read_bytes()
    path.write_bytes(body + seal_of(body))


def put(file: h5py.File, name: str, values: npt.ArrayLike) -> None:
    """Replace the dataset `name` by one that holds `values` and is stored, named and measured as the export does it."""
    values = np.asarray(values)
    attributes = dict(file[name].attrs)
    del file[name]
    # HDF5 cuts neither single numbers nor nothing into chunks, and has no checksum for texts of any length.
    in_one_piece = values.shape and values.size and values.dtype.kind != "O"
    storage = {"chunks": values.shape, "fletcher32": True} if in_one_piece else {}
    dataset = file.create_dataset(name, data=values, **storage)
    for key in ("units", "meaning"):
        dataset.attrs[key] = attributes[key]


def correct_payload(file: h5py.File, known: Arrays) -> None:
    """Only where there is a payload to speak of: all columns, and attributes that JSON can hold."""
    attributes = {name: value.item() if isinstance(value, np.generic) else value for name, value in file.attrs.items()}
    attributes.pop("payload_sha256", None)
    try:
        layout = stored_layout(file.attrs.get("kind"), set(file))
        # One that was removed is not among the known ones: its name raises.
        arrays = {
            column.name: known[column.name] if column.name in known else file[column.name][()]
            for column in layout.columns
        }
        canonical_json(attributes)
    except (KeyError, ValueError):
        return
    file.attrs["payload_sha256"] = payload_sha256(attributes, arrays, layout)


@dataclass(frozen=True)
class Forgery:
    """A book to forge: its layout, its bytes, the arrays in it, and where forged ones are put."""

    layout: Layout
    content: bytes
    arrays: Arrays
    path: Path

    def outcome(self, edit: Edit, name: str = "") -> TableError | tuple[StageTable, ...]:
        """What a reader finds in the book after `edit`, of the dataset `name` if of one alone, under right sums."""
        self.path.write_bytes(self.content)
        known = {key: array for key, array in self.arrays.items() if key != name} if name in self.arrays else {}
        forge(self.path, edit, known)
        try:
            return read_any_book(self.path)
        except TableError as refusal:
            message = str(refusal)
            assert message.startswith(f"{self.path}: ")
            assert "payload_sha256 is " not in message
            assert len(message) < 800
            assert message.isprintable()
            return refusal

    def refusal(self, edit: Edit, name: str = "") -> str:
        """The message with which the book is refused; "" if it is read."""
        found = self.outcome(edit, name)
        return str(found) if isinstance(found, TableError) else ""

    def is_another_sound_book(self, tables: tuple[StageTable, ...], name: str) -> bool:
        """Whether what was written at `name` is what the tables read from it hold."""
        with h5py.File(self.path) as file:
            forged = file[name][()]
        write_book(tables, self.path, tables[0].generator)
        again = arrays_in(self.path)[name]
        return bool(again.dtype == forged.dtype and again.tobytes() == forged.tobytes())


def set_value(name: str, index: Any, value: object) -> Edit:
    def edit(file: h5py.File) -> None:
        file[name][index] = value

    return edit


def delete(name: str) -> Edit:
    def edit(file: h5py.File) -> None:
        del file[name]

    return edit
