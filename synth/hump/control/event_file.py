"""The log of a hump as HDF5, readable by h5py and xarray without this project. Needs h5py, and only when called."""

from __future__ import annotations

import io
import os
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from synth.frame.input_error import InputError
from synth.hump.control.event import Event, Kind
from tuning_tables.atomic_file import write_atomically
from tuning_tables.errors import TableError
from tuning_tables.excerpt import excerpt
from tuning_tables.regular_file import read_regular_file
from tuning_tables.seal import seal_of, unsealed

FORMAT, VERSION = "hump-log", 1
LARGEST_FILE_BYTES = 512 * 2**20

DATASETS = {
    "time_s": ("<f8", "s", "time from the begin of the train"),
    "element": ("<i4", "1", "number of the element, 0: none"),
    "cut": ("<i4", "1", "serial number of the cut, 0: none"),
    "event": ("<i4", "1", "number of the kind of event, see the attribute kinds of the file"),
    "data": ("<f8", "1", "value of the event"),
}
"""Type, unit and meaning of each."""


def write_events(events: Sequence[Event], path: str | os.PathLike[str]) -> None:
    """Write `events` to the file at `path`, complete or not at all; equal events give equal bytes. Raises `OSError`."""
    import h5py

    columns = {
        "time_s": [event.time_s for event in events],
        "element": [event.element for event in events],
        "cut": [event.cut for event in events],
        "event": [int(event.kind) for event in events],
        "data": [event.value for event in events],
    }
    with h5py.File("log", "w", libver=("v108", "v108"), driver="core", backing_store=False) as file:
        file.attrs["format"], file.attrs["schema_version"] = FORMAT, VERSION
        file.attrs["kinds"] = ", ".join(f"{int(kind)} {kind.name.lower()}" for kind in Kind)
        for name, (dtype, units, meaning) in DATASETS.items():
            data = file.create_dataset(name, data=np.array(columns[name], dtype=dtype), track_times=False)
            data.attrs["units"], data.attrs["meaning"] = units, meaning
        file.flush()
        body: bytes = file.id.get_file_image()
    write_atomically(path, body + seal_of(body))


def read_events(path: str | os.PathLike[str]) -> tuple[Event, ...]:
    """The events in the file at `path`. `InputError` for what is no unbroken log; `OSError` where it cannot be read."""
    import h5py

    from tuning_tables.stored_array import plain_column

    source = os.fspath(path)
    try:
        body = unsealed(read_regular_file(Path(path), LARGEST_FILE_BYTES), source)
        with h5py.File(io.BytesIO(body), "r") as file:
            if file.attrs["format"] != FORMAT or file.attrs["schema_version"] != VERSION:
                raise InputError(f"{source}: this is no {FORMAT} of version {VERSION}; give a log of a hump")
            columns = [plain_column(file, name, DATASETS[name][0], source).tolist() for name in DATASETS]
        return tuple(
            Event(time, element, cut, Kind(kind), value)
            for time, element, cut, kind, value in zip(*columns, strict=True)
        )
    except InputError:
        raise
    except TableError as fault:
        raise InputError(str(fault)) from None
    # What is wrong with a file under a right seal surfaces in h5py as one of a dozen types.
    except Exception as fault:
        reason = excerpt(" ".join(str(fault).split()), 200)
        raise InputError(f"{source}: not a readable log ({reason}); export it again") from fault
