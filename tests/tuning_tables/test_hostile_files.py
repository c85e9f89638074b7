"""Whatever a path leads to, the readers refuse it with their own error, in bounded time and memory.

All files of a reader are read by one process of its own, under a limit of its address space and of time.
"""

import json
import os
import resource
import subprocess
import sys
import zipfile
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest

from tests.tuning_tables.forged_book import reseal
from tuning_tables import ControllerTable, to_json, write_book

Told = dict[str, dict[str, Any]]
"""What a reader says of each path: {"error", "text", "seconds"}."""

Forging = Callable[[h5py.File, Path], None]
Make = Callable[[h5py.File, str, Path], None]
"""Puts something under a name; the folder holds a pipe."""

LARGEST_ADDRESS_SPACE = 3 * 2**29
LONGEST_SECONDS = 5.0  # for one file; it takes a fraction of that, but a machine may be busy

pytestmark = pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="limits, pipes and devices are those of POSIX")

PROGRAM = """
import json, resource, sys, time
from tuning_tables import read_book, read_json
resource.setrlimit(resource.RLIMIT_AS, (int(sys.argv[2]),) * 2)
read = {"read_json": read_json, "read_book": read_book}[sys.argv[1]]
for path in sys.argv[3:]:
    started = time.monotonic()
    try:
        read(path)
        error = None
    except Exception as refusal:
        error = refusal
    told = {"path": path, "error": type(error).__name__, "text": str(error), "seconds": time.monotonic() - started}
    print(json.dumps(told), flush=True)
"""


def read_in_bounds(reader: str, paths: Iterable[Path]) -> Told:
    """What `reader` says of each path: {name: {"error", "text", "seconds"}}."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "OMP_NUM_THREADS": "1"}
    command = [sys.executable, "-c", PROGRAM, reader, str(LARGEST_ADDRESS_SPACE), *map(str, paths)]
    ended = subprocess.run(command, env=environment, stdout=subprocess.PIPE, timeout=120, check=True)
    told = map(json.loads, ended.stdout.splitlines())
    return {each["path"]: each for each in told}


FOREIGN = {  # name: (error of read_json, error of read_book)
    "empty": ("DamagedTable", "DamagedTable"),
    "png": ("DamagedTable", "UnknownFormat"),
    "zip": ("DamagedTable", "UnknownFormat"),
    "elf": ("DamagedTable", "UnknownFormat"),
    "summary": ("UnknownFormat", "UnknownFormat"),
    "utf-16": ("DamagedTable", "UnknownFormat"),
    "byte-order-mark": ("DamagedTable", "UnknownFormat"),
    "brackets": ("DamagedTable", "UnknownFormat"),
    "objects": ("DamagedTable", "UnknownFormat"),
    "4-gib": ("DamagedTable", "DamagedTable"),
    "4-gib-hdf5": ("DamagedTable", "DamagedTable"),
    "many-keys": ("DamagedTable", "UnknownFormat"),
    "long-number": ("UnknownFormat", "UnknownFormat"),
    "other-hdf5": ("DamagedTable", "DamagedTable"),
    "other-hdf5-sealed": ("DamagedTable", "UnknownFormat"),
    "directory": ("IsADirectoryError", "IsADirectoryError"),
    "pipe": ("OSError", "OSError"),
    "/dev/zero": ("OSError", "OSError"),
    "absent": ("FileNotFoundError", "FileNotFoundError"),
}


@pytest.fixture(scope="module")
def foreign(table: ControllerTable, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Told]:
    """{reader: what it says of every file of FOREIGN}."""
    folder = tmp_path_factory.mktemp("foreign")
    contents = {
        "empty": b"",
        "png": b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\x08\6\0\0\0\x1f\x15\xc4\x89",
        "elf": b"\x7fELF\2\1\1" + bytes(5000),
        "summary": b'{"format": "retarder-summary", "version": 1, "cases": []}',
        "utf-16": to_json(table).decode().encode("utf-16"),
        "byte-order-mark": to_json(table).decode().encode("utf-8-sig"),
        "brackets": b"[" * 1_000_000 + b"]" * 1_000_000,
        "objects": b'{"a":' * 600_000,
        "many-keys": b"{" + b"".join(b'"%d":0,' % key for key in range(300_000)) + b'"299999":0}',
        "long-number": b'{"format": 1' + b"0" * 4_000_000 + b"}",
    }
    for name, content in contents.items():
        (folder / name).write_bytes(content)
    with zipfile.ZipFile(folder / "zip", "w") as archive:
        archive.writestr("table.json", to_json(table))
    for name, content in (("4-gib", b""), ("4-gib-hdf5", b"\x89HDF\r\n\x1a\n")):
        (folder / name).write_bytes(content)
        os.truncate(folder / name, 4 * 2**30)
    for name in ("other-hdf5", "other-hdf5-sealed"):
        with h5py.File(folder / name, "w") as file:
            file["x"] = np.arange(10.0)
    reseal(folder / "other-hdf5-sealed")
    (folder / "directory").mkdir()
    os.mkfifo(folder / "pipe")
    paths = {name: folder / name for name in FOREIGN}
    told = {reader: read_in_bounds(reader, paths.values()) for reader in ("read_json", "read_book")}
    return {reader: {name: said[str(path)] for name, path in paths.items()} for reader, said in told.items()}


@pytest.mark.requirement("FILE-10")
@pytest.mark.parametrize("name", FOREIGN)
@pytest.mark.parametrize("reader", ["read_json", "read_book"])
def test_foreign_files_are_refused_in_bounds(foreign: dict[str, Told], name: str, reader: str) -> None:
    said = foreign[reader][name]
    assert said["error"] == FOREIGN[name][reader == "read_book"], said["text"]
    assert name in said["text"]
    assert said["seconds"] < LONGEST_SECONDS


def replace_by(name: str, make: Make) -> Forging:
    def edit(file: h5py.File, folder: Path) -> None:
        attributes = dict(file[name].attrs)
        del file[name]
        make(file, name, folder)
        created = file.get(name, getlink=True)
        if isinstance(created, h5py.HardLink):
            for key in ("units", "meaning"):
                file[name].attrs[key] = attributes[key]

    return edit


def claim(shape: tuple[int, ...], **storage: Any) -> Make:
    def make(file: h5py.File, name: str, folder: Path) -> None:
        file.create_dataset(name, shape=shape, dtype="<f8", **storage)

    return make


def soft_link(file: h5py.File, name: str, folder: Path) -> None:
    file[name] = h5py.SoftLink("/exit_m")


def dangling_link(file: h5py.File, name: str, folder: Path) -> None:
    file[name] = h5py.SoftLink("/nowhere")


def circular_link(file: h5py.File, name: str, folder: Path) -> None:
    file[name] = h5py.SoftLink(f"/{name}")


def external_link(target: str | None) -> Make:
    def make(file: h5py.File, name: str, folder: Path) -> None:
        file[name] = h5py.ExternalLink(str(target or folder / "pipe"), "/x")

    return make


def virtual(target: str | None, unlimited: bool) -> Make:
    def make(file: h5py.File, name: str, folder: Path) -> None:
        source = str(target or folder / "pipe")
        length = h5py.h5s.UNLIMITED if unlimited else 2
        layout = h5py.VirtualLayout(shape=(2,), maxshape=(length,), dtype="<f8")
        origin = h5py.VirtualSource(source, "x", shape=(2,), maxshape=(length,), dtype="<f8")
        layout[: length if unlimited else 2] = origin[: length if unlimited else 2]
        file.create_virtual_dataset(name, layout)

    return make


def foreign_storage(target: str | None) -> Make:
    def make(file: h5py.File, name: str, folder: Path) -> None:
        file.create_dataset(name, shape=(2,), dtype="<f8", external=[(str(target or folder / "pipe"), 0, 16)])

    return make


def bomb(file: h5py.File, name: str, folder: Path) -> None:
    zeros = file.create_dataset(name, shape=(2**23,), dtype="<f8", chunks=(2**20,), compression="gzip")
    zeros[:] = 0.0


def filler(file: h5py.File, name: str, folder: Path) -> None:
    file.create_dataset(name, shape=(2**27,), dtype="<f8", chunks=(2**20,), fletcher32=True, fillvalue=22.0)


def group(file: h5py.File, name: str, folder: Path) -> None:
    file.create_group(name)


def named_type(file: h5py.File, name: str, folder: Path) -> None:
    file[name] = np.dtype("<f8")


def alias(file: h5py.File, name: str, folder: Path) -> None:
    file[name] = file["retarder_exit_m"]


def reference_attribute(file: h5py.File, folder: Path) -> None:
    file.attrs["exported_by"] = file["cut_mass_t"].ref


def long_attribute(file: h5py.File, folder: Path) -> None:
    file.attrs.create("exported_by", ["x" * 1000] * 5000)


def surplus(file: h5py.File, folder: Path) -> None:
    for index in range(5000):
        file.create_group(f"surplus-{index}")


SLOPE = "stage_upper_slope_m_s_per_kpa"

HOSTILE: dict[str, Forging] = {
    "1-tib-contiguous": replace_by("cut_mass_t", claim((2**37,))),
    "1-tib-chunked": replace_by("cut_mass_t", claim((2**37,), chunks=(2**10,), fletcher32=True)),
    "overflowing": replace_by("valid_s_m", claim((2**62, 2**62), chunks=(1, 2), fletcher32=True)),
    "largest-chunk": replace_by("cut_mass_t", claim((2**28,), chunks=(2**28,), fletcher32=True)),
    "filler": replace_by("cut_mass_t", filler),
    "bomb": replace_by("cut_mass_t", bomb),
    "soft-link": replace_by("cut_mass_t", soft_link),
    "dangling-link": replace_by("cut_mass_t", dangling_link),
    "circular-link": replace_by("cut_mass_t", circular_link),
    "external-link-to-file": replace_by("cut_mass_t", external_link("/etc/passwd")),
    "external-link-to-pipe": replace_by("cut_mass_t", external_link(None)),
    "virtual-of-file": replace_by("cut_mass_t", virtual("/etc/passwd", False)),
    "virtual-of-pipe": replace_by("cut_mass_t", virtual(None, False)),
    "virtual-without-end": replace_by("cut_mass_t", virtual(None, True)),
    "storage-in-file": replace_by("cut_mass_t", foreign_storage("/etc/passwd")),
    "storage-in-pipe": replace_by("cut_mass_t", foreign_storage(None)),
    "group": replace_by("cut_mass_t", group),
    "named-type": replace_by("cut_mass_t", named_type),
    "alias": replace_by("cut_mass_t", alias),
    "reference-attribute": reference_attribute,
    "long-attribute": long_attribute,
    "surplus": surplus,
    "axis-link": replace_by("stage", external_link(None)),
    "slopes-1-tib": replace_by(SLOPE, claim((2**37, 2), chunks=(2**10, 2), fletcher32=True)),
    "slopes-bomb": replace_by(SLOPE, bomb),
    "slopes-link": replace_by(SLOPE, external_link(None)),
}
"""Those of slopes need a book with a table at any time."""


@pytest.fixture(scope="module")
def hostile(
    table: ControllerTable,
    linear_table: ControllerTable,
    surface_table: ControllerTable,
    tmp_path_factory: pytest.TempPathFactory,
) -> Told:
    """What read_book says of every book of HOSTILE, each under a right seal."""
    folder = tmp_path_factory.mktemp("hostile")
    os.mkfifo(folder / "pipe")
    write_book([table, linear_table], folder / "original")
    write_book([table, surface_table], folder / "slopes")
    paths = {name: folder / f"{name}.h5" for name in HOSTILE}
    for name, path in paths.items():
        path.write_bytes((folder / ("slopes" if name.startswith("slopes") else "original")).read_bytes())
        with h5py.File(path, "r+") as file:
            HOSTILE[name](file, folder)
        reseal(path)
    assert all(path.stat().st_size < 2**23 for path in paths.values())
    said = read_in_bounds("read_book", paths.values())
    return {name: said[str(path)] for name, path in paths.items()}


@pytest.mark.requirement("FILE-10")
@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_books_are_refused_in_bounds(hostile: Told, name: str) -> None:
    said = hostile[name]
    assert said["error"] == "DamagedTable", said["text"]
    assert said["seconds"] < LONGEST_SECONDS
    assert len(said["text"]) < 1000
    assert said["text"].isprintable()


def test_the_limit_of_the_address_space_is_one(tmp_path: Path) -> None:
    # Otherwise the tests above would say nothing of memory.
    allocate = "import resource, sys; resource.setrlimit(resource.RLIMIT_AS, (int(sys.argv[1]),) * 2); bytes(2**31)"
    ended = subprocess.run(
        [sys.executable, "-c", allocate, str(LARGEST_ADDRESS_SPACE)], stderr=subprocess.PIPE, check=False
    )
    assert b"MemoryError" in ended.stderr
    assert resource.getrlimit(resource.RLIMIT_AS)[0] == resource.RLIM_INFINITY
