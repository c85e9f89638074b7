"""A file that appears complete or not at all, whatever happens to the writing process or the power.

The content goes to a sibling `.NAME.<random>.part`, is forced to the disk, and takes the name in one step; then the
directory entry is forced out too. Leftovers of a killed process are known by that name and may be deleted.
"""

from __future__ import annotations

import atexit
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

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
