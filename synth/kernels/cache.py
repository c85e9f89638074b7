"""Where numba keeps compiled kernels, and how a stale or damaged cache is kept from being used.

numba renews a cached kernel when the file that defines it changes, but not when a constant or helper that it took from
another file does. The cache directory is therefore named by a fingerprint of every file that kernels are compiled from,
of the versions that compile them, and of the machine: after any change the kernels are compiled anew, in a new
directory. `synth.kernels` sets it up when it is imported, so before any kernel is.

numba's files hold pickles and machine code: whoever can write them runs code as the user. So a directory is used only
where it is the user's, or the system's, and nobody else may write to it.

This module imports no numba, so that the command line starts at once.
"""

import atexit
import contextlib
import hashlib
import os
import platform
import re
import shutil
import stat
import sys
import tempfile
import time
from collections.abc import Callable
from importlib.metadata import version
from itertools import takewhile
from pathlib import Path
from types import TracebackType
from typing import ParamSpec, TypeVar

from synth.kernels.plain import IS_PLAIN

_P = ParamSpec("_P")
_R = TypeVar("_R")

_OWNER = "retarder-synth"
_KERNEL_SOURCES = (
    "plant_models/valve_drive.py",
    "scripts/studies/**/kernels/**/*.py",
    "synth/**/kernels/**/*.py",
    "tuning_tables/programs/aim_speed.py",
    "tuning_tables/programs/at_pulse.py",
    "tuning_tables/programs/decide.py",
    "tuning_tables/programs/held.py",
    "tuning_tables/programs/motion_filter.py",
    "tuning_tables/programs/observe.py",
    "tuning_tables/programs/tracker.py",
)
"""Patterns of the files that kernels are compiled from; tests/architecture finds these by itself and compares.

Studies have kernels of their own, in a checkout. These are kept in the same directory, so its name changes with them.
"""

_COMPILERS = ("llvmlite", "numba", "numpy")
_FINGERPRINT = re.compile(r"[0-9a-f]{16}")
_UNUSED_AFTER_S = 30 * 24 * 3600.0
_HARMLESS_SETTINGS = ("NUMBA_CACHE_DIR", "NUMBA_NUM_THREADS")


def use_kernel_cache() -> Path:
    """Point numba at the cache directory of exactly these kernels, and return that directory.

    The directory is BASE/retarder-synth/FINGERPRINT, where BASE is the first absolute and writable path of
    $RETARDER_SYNTH_CACHE, $XDG_CACHE_HOME and ~/.cache; where none is, a private temporary directory that is removed
    when the process ends. What is made is the user's alone. A directory that others made, or may write to, is passed
    over with a warning on stderr. A NUMBA_CACHE_DIR set by the user is replaced: it could hold stale kernels.

    A kernel keeps the directory that it found when it was imported: hence `synth.kernels` calls this first. Calling it
    again changes nothing. Directories of other fingerprints that were not used for 30 days are removed.
    """
    fingerprint = kernel_fingerprint()
    current = cache_in_use()
    if current is not None and current.name == fingerprint and _is_writable(current) and _open_to(current) is None:
        directory = current
    else:
        directory = _first_usable(fingerprint)
        _remove_unused(directory)
    os.utime(directory)
    os.environ["NUMBA_CACHE_DIR"] = str(directory)
    if "numba" in sys.modules:
        sys.modules["numba"].config.CACHE_DIR = str(directory)
    return directory


def cache_in_use() -> Path | None:
    """The directory that `use_kernel_cache` has chosen, in this process or in the one that started it."""
    directory = Path(os.environ.get("NUMBA_CACHE_DIR", ""))
    ours = directory.parent.name == _OWNER and _FINGERPRINT.fullmatch(directory.name) is not None
    return directory if ours else None


def first_time() -> bool:
    """Whether no kernel is kept for this machine, so that all that are needed will be compiled."""
    directory = cache_in_use()
    return directory is None or next(directory.rglob("*.nbi"), None) is None


def kernel_sources(root: Path) -> list[str]:
    """The files below `root` that kernels are compiled from, sorted, as POSIX paths relative to it."""
    return sorted({path.relative_to(root).as_posix() for pattern in _KERNEL_SOURCES for path in root.glob(pattern)})


def kernel_fingerprint(root: Path | None = None) -> str:
    """Return 16 hexadecimal digits that change with any kernel source, compiler version or setting, and the processor.

    `root` is the directory that holds the packages; by default the one this module was loaded from.
    """
    root = Path(__file__).resolve().parents[2] if root is None else root
    digest = hashlib.sha256(repr(compiling_facts()).encode())
    for name in kernel_sources(root):
        content = (root / name).read_bytes()
        digest.update(f"\0{name}\0{len(content)}\0".encode() + content)
    return digest.hexdigest()[:16]


def compiling_facts() -> list[str]:
    """What compiled kernels depend on besides their sources: versions of the compilers, settings, the processor."""
    facts = [f"{name} {version(name)}" for name in _COMPILERS]
    facts += [platform.python_implementation(), platform.python_version(), sys.platform, _processor()]
    facts += ["plain"] * IS_PLAIN
    settings = (f"{k}={v}" for k, v in os.environ.items() if k.startswith("NUMBA_") and k not in _HARMLESS_SETTINGS)
    return [*facts, *sorted(settings)]


def guarded(call: Callable[_P, _R], *args: _P.args, **kwargs: _P.kwargs) -> _R:
    """Return `call(*args, **kwargs)`; where numba could not read its cache, empty the cache and call once more.

    Only an error raised while numba was reading its cache counts; any other error, and a second one, passes through.
    A call that is repeated starts afresh, so it must leave nothing behind when a kernel fails to load. What numba
    itself cannot notice (a bit flipped inside the machine code of a kernel) is not noticed here either.
    """
    try:
        return call(*args, **kwargs)
    except Exception as error:
        directory = cache_in_use()
        if directory is None or isinstance(error, OSError) or not _raised_in_numba_cache(error.__traceback__):
            raise
        empty_kernel_cache(directory)
    return call(*args, **kwargs)


def empty_kernel_cache(directory: Path) -> None:
    """Remove every compiled kernel below `directory`, but no directory: another process may be writing there."""
    for path in [*directory.rglob("*.nbi"), *directory.rglob("*.nbc")]:
        path.unlink(missing_ok=True)


def _first_usable(fingerprint: str) -> Path:
    named = (os.environ.get("RETARDER_SYNTH_CACHE"), os.environ.get("XDG_CACHE_HOME"), "~/.cache")
    passed_over = []
    for base in [os.path.expanduser(name) for name in named if name]:
        directory = Path(base, _OWNER, fingerprint)
        if os.path.isabs(base) and _is_writable(directory):
            fault = _open_to(directory)
            if fault is None:
                break
            passed_over.append(fault)
    else:
        private = tempfile.mkdtemp(prefix=f"{_OWNER}-")
        atexit.register(shutil.rmtree, private, ignore_errors=True)
        directory = Path(private, _OWNER, fingerprint)
        _make(directory)
    if passed_over:
        told = f"kernel cache: {'; '.join(passed_over)}; remove it; until then kernels are kept in {directory.parent}"
        sys.stderr.write(f"retarder-synth: warning: {told}\n")
    return directory


def _open_to(directory: Path) -> str | None:
    """Why the user alone cannot be sure of a cache `directory` and its parent of ours; None where he can.

    Where the system has no user ids (Windows), a profile's own folders are the user's.
    """
    own_id = getattr(os, "getuid", None)
    if own_id is None:
        return None
    for each in (directory.parent, directory):
        found = each.stat()
        if found.st_uid not in (own_id(), 0):
            return f"{each} was made by another user"
        if found.st_mode & (stat.S_IWGRP | stat.S_IWOTH):
            return f"other users may write to {each}"
    return None


def _make(directory: Path) -> None:
    """Make `directory` and what is missing above it for the user alone, whatever the umask."""
    missing = list(takewhile(lambda each: not each.exists(), (directory, *directory.parents)))
    for each in reversed(missing):
        with contextlib.suppress(FileExistsError):  # another process may be making the same one
            each.mkdir(0o700)


def _is_writable(directory: Path) -> bool:
    try:
        _make(directory)
        tempfile.TemporaryFile(dir=directory).close()
    except OSError:
        return False
    return True


def _remove_unused(directory: Path) -> None:
    oldest = time.time() - _UNUSED_AFTER_S
    for sibling in directory.parent.iterdir():
        with contextlib.suppress(FileNotFoundError):  # another process may be removing the same one
            if _FINGERPRINT.fullmatch(sibling.name) and sibling != directory and sibling.stat().st_mtime < oldest:
                shutil.rmtree(sibling, ignore_errors=True)


def _processor() -> str:
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        lines = []
    model = next((line for line in lines if line.startswith(("model name", "CPU part"))), platform.processor())
    return f"{platform.machine()} {model}"


def _raised_in_numba_cache(traceback: TracebackType | None) -> bool:
    from synth.kernels.vector.numba_internals import (
        CACHE_READER,  # start-up: numba, which is there when a kernel failed
    )

    while traceback is not None:
        if traceback.tb_frame.f_globals.get("__name__") == CACHE_READER:
            return True
        traceback = traceback.tb_next
    return False
