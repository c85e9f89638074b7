"""The content of a file, read whole but never without bound: neither a device nor a pipe can hold the reader."""

from __future__ import annotations

import contextlib
import errno
import os
import stat
from collections.abc import Iterator

from tuning_tables.errors import DamagedTable


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
