"""Files whole: one appears complete or not at all, one is read whole but never without bound, so that neither a device
nor a pipe can hold the reader; and a seal ends a file.

What is written goes to a sibling `.NAME.<random>.part`, is forced to the disk, and takes the name in one step; then the
directory entry is forced out too. So whatever happens to the writing process or the power, the file is complete or not
there. Leftovers of a killed process are known by that name and may be deleted.

The seal is one line with the SHA-256 of all that stands before it, for formats whose own library must not meet a
damaged file. HDF5 is one: a single flipped bit in a part that it keeps without a checksum (the heap of strings and
references) can hold it in an endless loop, as was measured with HDF5 2.0. With the seal, plain Python has read every
byte before the library sees the first. HDF5 ignores what follows its own end, so that h5py and xarray open a sealed
file as any other; a program that writes into it breaks the seal.
"""

from __future__ import annotations

import atexit
import contextlib
import errno
import hashlib
import os
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

from tuning_tables.errors import DamagedTable

_UNFINISHED: Final[set[Path]] = set()
"""Files that this process is writing; removed by what it does at its end, also where a signal has it leave a block."""


@contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Hand out a new empty file to be written and closed in the `with` block; afterwards it is found at `path`.

    Where the block raises, `path` is left as it was and the temporary file is removed. The file's permissions are those
    of any new file of this process. Raises `OSError` where the directory cannot be written; it names `path`, also where
    the system names no file, as for a full disk, or the temporary one.
    """
    target = Path(path)
    part = target.with_name(f".{target.name}.{os.urandom(8).hex()}.part")
    with faults_naming(target, part):
        try:
            _UNFINISHED.add(part)
            os.close(os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))
            yield part
            _force_to_disk(part)
            os.replace(part, target)
            _force_to_disk(target.parent)
        except BaseException:
            part.unlink(missing_ok=True)
            raise
        finally:
            _UNFINISHED.discard(part)


@atexit.register
def _remove_unfinished() -> None:
    for part in tuple(_UNFINISHED):
        with suppress(OSError):
            part.unlink()


def write_atomically(path: str | os.PathLike[str], content: bytes) -> None:
    """Make `content` the content of the file at `path`, replacing what was there; raises `OSError`."""
    with replacing(path) as part:
        part.write_bytes(content)


@contextmanager
def faults_naming(path: Path, stand_in: Path | None = None) -> Iterator[None]:
    """Within, an `OSError` that names no file, as for a full disk, or only `stand_in`, is raised naming `path`."""
    try:
        yield
    except OSError as fault:
        if fault.errno is None or fault.filename not in (None, stand_in and str(stand_in)):
            raise
        raise OSError(fault.errno, fault.strerror, str(path)) from fault


def _force_to_disk(path: Path) -> None:
    if path.is_dir() and os.name == "nt":
        return  # Windows opens no directory as a file; its file system keeps a journal of names itself.
    descriptor = os.open(path, os.O_RDONLY if path.is_dir() else os.O_RDWR)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def read_regular_file(path: str | os.PathLike[str], largest_bytes: int) -> bytes:
    """The content of the regular file at `path`, at most `largest_bytes` long.

    Raises `DamagedTable` for a longer file, which is not read; `OSError` for one that cannot be read and for whatever
    is no regular file: a directory, a pipe, a socket, a device. Their content may never come, or never end.
    """
    source = os.fspath(path)
    with _opened(source) as descriptor:
        length = os.fstat(descriptor).st_size
        _require_length(length, largest_bytes, source)
        with open(descriptor, "rb", closefd=False) as file:
            # Python sets aside as much memory as is asked for, so that is not all that is allowed.
            content = file.read(length + 1)
            if len(content) > length:  # it has grown since
                content += file.read(largest_bytes + 1 - len(content))
    _require_length(len(content), largest_bytes, source)
    return content


def first_bytes(path: str | os.PathLike[str], count: int) -> bytes:
    """At most `count` bytes from the beginning of the regular file at `path`; `OSError` as `read_regular_file`."""
    with _opened(os.fspath(path)) as descriptor:
        return os.read(descriptor, count)


@contextlib.contextmanager
def _opened(source: str) -> Iterator[int]:
    # Without O_NONBLOCK the opening of a pipe waits for somebody to write into it.
    descriptor = os.open(source, os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0))
    try:
        mode = os.fstat(descriptor).st_mode
        if stat.S_ISDIR(mode):
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), source)
        if not stat.S_ISREG(mode):
            raise OSError(errno.EINVAL, "not a regular file", source)
        yield descriptor
    finally:
        os.close(descriptor)


def _require_length(length: int, largest_bytes: int, source: str) -> None:
    if length > largest_bytes:
        raise DamagedTable(
            f"{source}: {length} bytes long, but at most {largest_bytes} are allowed; give a file that was exported."
        )


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
