"""The columns of an HDF5 pass log as arrays, just as they are stored; a log without a seal is read by a process of
its own, which has a limit of time and of memory. Needs h5py, when called.

A single changed byte can hold HDF5 in an endless loop (`seal`), and no thread can stop that. Logs of other programs
have no seal, so a child reads them: it gets the content of the file, and hands back arrays or a sentence. Nothing that
comes back is a pickle.
"""

from __future__ import annotations

import contextlib
import io
import os
import signal
import subprocess
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np
import numpy.typing as npt

from tuning_tables.errors import InvalidLog, excerpt
from tuning_tables.pass_log.log_columns import TEXTS
from tuning_tables.pass_log.log_mapping import PATHS
from tuning_tables.pass_log.pass_log import PASSES, ROWS

if TYPE_CHECKING:
    import h5py

FORMAT: Final = "retarder-pass-log"
VERSION: Final = 1
STORED: Final = (*ROWS, "first_row", *PASSES)
"""Datasets of a log, in the order in which they are written."""

MOST_ROWS: Final = 20_000_000
LARGEST_COLUMNS_BYTES: Final = 2**30
"""All columns of a file together: a small file can claim any number of rows."""


@dataclass(frozen=True, eq=False)
class StoredColumns:
    """`path_word`, where the path comes from, and the read-only arrays (n,) of all names of `STORED`."""

    path_word: str
    arrays: Mapping[str, npt.NDArray[Any]]

    def __post_init__(self) -> None:
        for array in self.arrays.values():
            array.setflags(write=False)


def stored_columns(content: bytes) -> StoredColumns:
    """What the HDF5 file with this content holds; HDF5 may never come to an end with damaged content.

    `InvalidLog`, which names no file, for anything that is no pass log; `MemoryError`; `ImportError` without h5py.
    """
    import h5py

    try:
        with h5py.File(io.BytesIO(content), "r") as file:
            return _columns(file)
    except (InvalidLog, MemoryError):
        raise
    # What is wrong with a file surfaces in h5py as one of a dozen types.
    except Exception as fault:
        reason = excerpt(" ".join(str(fault).split()), 200)
        raise InvalidLog(f"not readable as an HDF5 pass log ({reason}); write it anew.") from fault


def _columns(file: h5py.File) -> StoredColumns:
    found, version, word = (file.attrs.get(name) for name in ("format", "version", "path"))
    if not isinstance(found, str) or found != FORMAT or version != VERSION:
        raise InvalidLog(
            f'format is {excerpt(repr(found))}, version {excerpt(repr(version))}; it must be "{FORMAT}", version '
            f"{VERSION}."
        )
    if not isinstance(word, str) or word not in PATHS:
        raise InvalidLog(f"path is {excerpt(repr(word))}; it must be one of {', '.join(PATHS)}.")
    kept = {name: _dataset(file, name) for name in STORED}
    length = sum(each.size * each.dtype.itemsize for each in kept.values())
    if length > LARGEST_COLUMNS_BYTES:
        raise InvalidLog(f"its columns have {length} bytes; at most {LARGEST_COLUMNS_BYTES} may be; write it in parts.")
    for name, each in kept.items():
        if not _is_whole(each):
            raise InvalidLog(f"column {name}: some of its values are not there; write all of them, NaN for no reading.")
    return StoredColumns(word, {name: each[()] for name, each in kept.items()})


def _dataset(file: h5py.File, name: str) -> h5py.Dataset:
    import h5py

    kept = file.get(name)
    kinds = "S" if name in TEXTS else "fiub"
    if not isinstance(kept, h5py.Dataset) or kept.ndim != 1 or kept.dtype.kind not in kinds:
        raise InvalidLog(f"column {name} is missing or no column of {'text' if kinds == 'S' else 'numbers'}.")
    if kept.size > MOST_ROWS:
        raise InvalidLog(f"column {name} has {kept.size} entries; at most {MOST_ROWS} may be; write the log in parts.")
    return kept


def _is_whole(kept: h5py.Dataset) -> bool:
    """Whether all values are stored. HDF5 reads those that it does not find in its index as 0, without a word."""
    if kept.chunks is None:
        return bool(kept.id.get_storage_size() >= kept.size * kept.dtype.itemsize)
    whole_bytes = kept.chunks[0] * kept.dtype.itemsize
    for first in range(0, kept.size, kept.chunks[0]):
        try:
            skipped_filters, chunk = kept.id.read_direct_chunk((first,))
        except (OSError, RuntimeError, MemoryError):  # a large chunk that was never written has any size for HDF5
            return False
        # A compression is skipped only where it makes nothing shorter.
        if skipped_filters and len(chunk) < whole_bytes:
            return False
    return True


LEAST_TIME_S: Final = 10.0
TIME_S_PER_BYTE: Final = 1e-6
"""A million rows of 40 bytes last 0.5 s."""

WAITED: Final = 3.0
"""The clock on the wall may show so many times the processor time that is allowed: other programs run, too."""

MEMORY_BYTES: Final = LARGEST_COLUMNS_BYTES + 2**29
"""Beside the content itself: the columns, and what Python, numpy and HDF5 take."""

REFUSED, NO_MEMORY = 10, 11
"""Exit codes of the child: a sentence is on stdout; the limit of memory was met."""


def columns_by_child(content: bytes, least_time_s: float = LEAST_TIME_S) -> StoredColumns:
    """`stored_columns` by a process of its own, in at most `least_time_s` and 1 s more a megabyte of processor time.

    `InvalidLog`, which names no file, also where HDF5 does not come to an end, or breaks down. `OSError` where no
    process can be started.
    """
    limit_s = least_time_s + TIME_S_PER_BYTE * len(content)
    command = [sys.executable, "-P", "-m", __name__, str(limit_s), str(len(content) + MEMORY_BYTES)]
    try:
        ended = subprocess.run(
            command, input=content, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, env=_environment(),
            timeout=WAITED * limit_s, check=False,
        )  # fmt: skip
    except subprocess.TimeoutExpired as fault:
        raise _endless(limit_s) from fault
    if ended.returncode == REFUSED:
        raise InvalidLog(ended.stdout.decode())
    if ended.returncode == NO_MEMORY:
        raise InvalidLog("HDF5 takes more memory for it than a log of its size may; copy it again, or write it anew.")
    if ended.returncode == _OUT_OF_TIME:
        raise _endless(limit_s)
    if ended.returncode != 0:
        raise InvalidLog(f"HDF5 breaks down over it (code {ended.returncode}); copy it again, or write it anew.")
    return _unpacked(ended.stdout)


def _endless(limit_s: float) -> InvalidLog:
    return InvalidLog(f"HDF5 does not come to an end with it in {limit_s:.0f} s; copy it again, or write it anew.")


def _environment() -> Mapping[str, str]:
    """That of this process; modules are found where this process finds them."""
    places = os.pathsep.join(place or os.getcwd() for place in sys.path)
    return {**os.environ, "PYTHONPATH": places, "OPENBLAS_NUM_THREADS": "1"}


def _unpacked(stream: bytes) -> StoredColumns:
    """The columns in the .npy files that `_packed` has put one behind the other."""
    file = io.BytesIO(stream)
    arrays: list[npt.NDArray[Any]] = [np.lib.format.read_array(file, allow_pickle=False) for _ in ("path", *STORED)]
    return StoredColumns(arrays[0].tobytes().decode(), dict(zip(STORED, arrays[1:], strict=True)))


def _pack(columns: StoredColumns) -> None:
    """Write `columns` to stdout."""
    word = np.frombuffer(columns.path_word.encode(), dtype=np.uint8)
    for array in (word, *(columns.arrays[name] for name in STORED)):
        np.lib.format.write_array(sys.stdout.buffer, array, allow_pickle=False)
    sys.stdout.buffer.flush()


try:
    import resource
except ImportError:
    # Windows has no such limits: the parent's clock ends the child, and the checks of `stored_columns` bound memory.
    _OUT_OF_TIME: int | None = None

    def _limit(time_s: float, memory_bytes: int) -> None: ...

else:
    _OUT_OF_TIME = -signal.SIGXCPU

    def _limit(time_s: float, memory_bytes: int) -> None:
        """Let this process have `time_s` more of processor time, and `memory_bytes` in all."""
        used = resource.getrusage(resource.RUSAGE_SELF)
        whole_s = int(used.ru_utime + used.ru_stime + time_s) + 1
        for limited, most in ((resource.RLIMIT_CPU, whole_s), (resource.RLIMIT_AS, memory_bytes)):
            soft, hard = resource.getrlimit(limited)
            known = [each for each in (soft, hard, most) if each != resource.RLIM_INFINITY]
            with contextlib.suppress(ValueError):  # macOS limits no address space that is larger already
                resource.setrlimit(limited, (min(known), hard))


def main() -> int:
    """The child: the content comes by stdin, time and memory allowed are its arguments; returns the exit code."""
    import h5py  # noqa: F401  # what its start costs is no part of the time allowed

    content = sys.stdin.buffer.read()
    _limit(float(sys.argv[1]), int(sys.argv[2]))
    try:
        _pack(stored_columns(content))
    except InvalidLog as fault:
        sys.stdout.buffer.write(str(fault).encode())
        return REFUSED
    except MemoryError:
        return NO_MEMORY
    return 0


if __name__ == "__main__":
    sys.exit(main())
