"""What is in the hand of a command: a directory that one run at a time holds; its marker, which tells who writes
there and which files it wrote; and a single new file that is asked for by name.

One run at a time holds a directory. The lock is that of the system on a file in the directory, so it ends with the
process, however that ends. The file goes with the run; one that a killed run has left holds nobody back, and neither
does a file system without locks.

The marker of a directory of results: which command writes there, and which files it wrote. A line of JSON each: first
the command; then a name when its file is begun, and the name with the SHA-256 of the content before the file takes that
name. So whatever a killed command has left is known. A line that was torn is passed over: its file has not got its
name.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

from filelock import FileLock, Timeout

from synth.frame.faults import InputError
from tuning_tables.whole_file import faults_naming, write_atomically

LOCK: Final = ".retarder-synth.lock"
"""Name of the file."""

PATIENCE_S: Final = 0.5
"""The lock is asked for so long: `is_held` takes it for a moment to see whether it is free."""


@contextlib.contextmanager
def held(path: Path) -> Iterator[bool]:
    """Hold the directory `path` within; False where another run holds it."""
    lock = FileLock(path / LOCK, timeout=PATIENCE_S, thread_local=False)
    try:
        lock.acquire()
    except Timeout:
        yield False
        return
    except OSError:  # a file system without locks
        yield True
        return
    try:
        yield True
    finally:
        with contextlib.suppress(OSError):  # Windows removes it after the release, not before
            (path / LOCK).unlink()
        lock.release()


def is_held(path: Path) -> bool:
    """Whether a run holds the directory `path` now; False where the system does not let us ask."""
    if not (path / LOCK).exists():
        return False
    lock = FileLock(path / LOCK, timeout=0.0, thread_local=False)
    try:
        lock.acquire()
    except Timeout:
        return True
    except OSError:
        return False
    lock.release()
    return False


def require_new(path: Path) -> None:
    """`InputError` if there is something at `path`: no command overwrites what it did not write."""
    if os.path.lexists(path):
        raise InputError(f"{path}: it is there already, and is not overwritten; give another name, or move it away")


MARKER: Final = ".retarder-synth"
FORMAT: Final = "retarder-synth-results"
CHANGING: Final = "changes"
"""In place of a SHA-256: a file that knows by itself whether it is whole, or that grows."""


def sha256_of(path: Path) -> str:
    """SHA-256 of the file at `path`; `OSError` where it cannot be read."""
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def command_of(directory: Path) -> str | None:
    """The command whose results `directory` holds; None where no marker says so."""
    lines = lines_of(directory)
    first = next(lines, None)
    if isinstance(first, dict) and first.get("format") == FORMAT and isinstance(first.get("command"), str):
        return str(first["command"])
    return None


def lines_of(directory: Path) -> Iterator[Any]:
    """The lines of a marker that can be read; nothing where there is none."""
    try:
        content = (directory / MARKER).read_bytes()
    except (OSError, ValueError):
        return
    for line in content.split(b"\n"):
        try:
            yield json.loads(line)
        except (ValueError, RecursionError):
            continue


def is_inside(directory: Path, name: str) -> bool:
    """Whether `name` is that of a file below `directory`: a marker may come from somebody else, as in an archive."""
    try:
        return (directory / name).resolve().is_relative_to(directory.resolve())
    except (OSError, ValueError, RuntimeError):  # a name with a zero byte, a link to itself
        return False


class OwnFiles:
    """The files that a command wrote into `directory`, in this run or earlier; only its holder may make one.

    Names are relative to the directory, with slashes. `run`: its number, from 0; a run that goes on where another was
    killed has the number of that one. Raises `OSError` where the marker cannot be written.
    """

    def __init__(self, directory: Path, command: str) -> None:
        self._directory, self._command = directory, command
        self._contents: dict[str, set[str]] = {}
        self._lock = threading.Lock()
        self.run = 0
        for line in lines_of(directory):
            match line:
                case [str(name), *contents] if is_inside(directory, name):
                    self._contents.setdefault(name, set()).update(map(str, contents))
                case {"run": int(number)}:
                    self.run = number

    def __iter__(self) -> Iterator[str]:
        """Names of the files, of which some may be gone or only begun."""
        return iter(tuple(self._contents))

    @property
    def stores(self) -> bool:
        """Whether there is something that a later run may go on from; asks no lock, since Ctrl-C asks it."""
        return any(CHANGING in contents for contents in tuple(self._contents.values()))

    def content_of(self, name: str) -> str | None:
        """SHA-256 of the file `name` as the command wrote it, or `CHANGING`; None for one that it did not write, that
        was changed since, or that is gone."""
        contents, file = self._contents.get(name, set()), self._directory / name
        if not contents or not file.is_file():
            return None
        if CHANGING in contents:
            return CHANGING
        found = sha256_of(file)
        return found if found in contents else None

    def is_changed(self, name: str) -> bool:
        """Whether something else is now where the command wrote the file `name`."""
        was_written = bool(self._contents.get(name))
        return was_written and os.path.lexists(self._directory / name) and self.content_of(name) is None

    def begin_run(self) -> None:
        """Note, on the disk when this returns, that the run before has ended, and this is the next one."""
        self.run += 1
        self._append({"run": self.run}, to_disk=True)

    def begin(self, name: str) -> None:
        """Note that the file `name` is being written, beside the name that it will get."""
        with self._lock:
            if name not in self._contents:
                self._contents[name] = set()
                self._append([name])

    def add(self, name: str, content: str) -> None:
        """Note, on the disk when this returns, that the file `name` gets the `content` with this SHA-256."""
        with self._lock:
            if content not in self._contents.setdefault(name, set()):
                self._contents[name].add(content)
                self._append([name, content], to_disk=True)

    def _append(self, line: object, to_disk: bool = False) -> None:
        marker = self._directory / MARKER
        with faults_naming(marker), marker.open("ab") as file:
            file.write(b"\n" + line_of(line))  # the newline ends a line that was torn
            file.flush()
            if to_disk:
                os.fsync(file.fileno())

    def tidy(self) -> None:
        """Write the marker anew, without files that are gone and contents that a file no longer has."""
        with self._lock:
            kept = {name: self.content_of(name) for name in sorted(self._contents)}
            lost = {name: self._contents[name] for name, content in kept.items() if self.is_changed(name)}
            self._contents = {name: {content} for name, content in kept.items() if content is not None} | lost
            lines = [line_of({"format": FORMAT, "command": self._command, "run": self.run})]
            lines += [line_of([name, each]) for name, contents in self._contents.items() for each in sorted(contents)]
            write_atomically(self._directory / MARKER, b"\n".join(lines) + b"\n")


def line_of(value: object) -> bytes:
    """A line of the marker."""
    return json.dumps(value, ensure_ascii=True, separators=(",", ":")).encode("ascii")
