"""The directory of a command's results: nothing in it that the command did not write is ever changed or removed.

A command writes into a directory that is new, empty, or marked as its own (`own_files`). It replaces and removes only
files that it wrote itself and nobody changed, and none that it reads. What breaks this rule is told before anything is
computed, but for a file that comes into the place of a result later: that is told when the result would be written.
One command at a time holds a directory.
"""

from __future__ import annotations

import contextlib
import errno
import hashlib
import os
import re
import tempfile
import threading
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Final

from synth.frame.faults import MACHINE_FAULTS, InputError
from synth.frame.own_files import CHANGING, LOCK, MARKER, OwnFiles, command_of, held, sha256_of
from tuning_tables.whole_file import replacing

SUMMARY: Final = "summary.json"
CONFIGURATION: Final = "configuration.toml"
"""The user's configuration as it was; a run may begin from it, for it writes nothing there."""
LEFTOVER: Final = re.compile(r"\.(.+)\.[0-9a-f]{16}\.part")
"""Name of an unfinished file, and in it the name that it would have got."""

ELSEWHERE: Final = "give another directory by -o"


class ResultsDirectory:
    """A directory that is held, and what this run has written into it; made by `results_directory`.

    Names are relative to `path`, with slashes. `write`, `store` and `writing` raise `InputError` for a file that the
    command did not write, that was changed since, or that it reads; `OSError` where the disk does.
    """

    def __init__(self, path: Path, own: OwnFiles, reads: frozenset[Path]) -> None:
        self.path = path
        self._own, self._reads = own, reads
        self._written: dict[str, str] = {}
        self._lock = threading.Lock()

    @property
    def written(self) -> dict[str, str]:
        """SHA-256 of each file of this run by name, sorted; without those of `store`."""
        with self._lock:
            return {name: content for name, content in sorted(self._written.items()) if content != CHANGING}

    @property
    def goes_on(self) -> bool:
        """Whether a next run of the command goes on from what this one or an earlier one has stored."""
        return self._own.stores

    @property
    def run(self) -> int:
        """The number of this run; the same as of the one before, if that was killed before its summary was there."""
        return self._own.run

    def names_below(self, folder: str) -> tuple[str, ...]:
        """The files below `folder` that this command wrote, in this run or earlier."""
        return tuple(name for name in sorted(self._own) if name.startswith(f"{folder}/") and self._own.content_of(name))

    def written_below(self, folder: str) -> dict[str, str]:
        """`written` below `folder`, by names relative to it."""
        prefix = f"{folder}/"
        return {name.removeprefix(prefix): sha for name, sha in self.written.items() if name.startswith(prefix)}

    def require_own_below(self, folder: str) -> None:
        """`InputError` if there is a file below `folder` that this command did not write."""
        for file in sorted((self.path / folder).rglob("*")):
            if not file.is_dir() and self._own.content_of(file.relative_to(self.path).as_posix()) is None:
                raise InputError(not_own(file))

    def write(self, name: str, content: bytes) -> Path:
        """Make `content` the content of the file `name`; it appears as it was written or not at all."""
        target, digest = self.path / name, hashlib.sha256(content).hexdigest()
        if self._own.content_of(name) == digest:  # a run may begin from its own results
            self.retain(name)
            return target
        with self.writing(name) as part:
            part.write_bytes(content)
            if sha256_of(part) != digest:
                raise OSError(errno.EIO, "what was written does not read back", str(target))
        return target

    def write_all(self, contents: Mapping[str, bytes]) -> list[Path]:
        """`write` each of `contents`; the files."""
        return [self.write(name, content) for name, content in contents.items()]

    @contextlib.contextmanager
    def writing(self, name: str) -> Iterator[Path]:
        """Hand out an empty file to be written in the `with` block; afterwards it is the file `name`."""
        target = self._replaceable(name)
        self._own.begin(name)
        with replacing(target) as part:
            yield part
            content = sha256_of(part)
            self._own.add(name, content)
        self._note(name, content)

    def store(self, name: str, content: bytes) -> None:
        """`write` what a later run may go on from: it is sealed by its writer, and replaced where it was damaged."""
        target = self._replaceable(name)
        self._own.begin(name)
        with replacing(target) as part:
            part.write_bytes(content)
            self._own.add(name, CHANGING)
        self._note(name, CHANGING)

    def growing(self, name: str) -> Path:
        """The file `name`, to which its caller appends; it stays where a run does not write it."""
        target = self._replaceable(name)
        self._own.add(name, CHANGING)
        self._note(name, CHANGING)
        return target

    def retain(self, *names: str) -> None:
        """Count files of an earlier run, if they are as they were written, among those of this one."""
        for name in names:
            content = self._own.content_of(name)
            if content is not None:
                self._note(name, content)

    def keep_configuration(self, source: Path, text: str) -> None:
        """Keep the `text` of the user's file `source`, unless that is the very place where it would lie."""
        if source.resolve() == (self.path / CONFIGURATION).resolve():
            self.retain(CONFIGURATION)
        else:
            self.write(CONFIGURATION, text.encode("utf-8"))

    def remove(self, name: str) -> None:
        """Remove the file `name` of an earlier run, if it is there and as it was written."""
        target = self.path / name
        if self._own.content_of(name) is not None and target.resolve() not in self._reads:
            target.unlink(missing_ok=True)

    def remove_others(self) -> None:
        """Remove the files of earlier runs that are not among those of this one."""
        for name in self._own:
            if name not in self._written:
                self.remove(name)

    def finish(self, summary: bytes) -> None:
        """Remove the files of earlier runs, then write the summary: where it is, the rest is whole."""
        self.remove_others()
        self.write(SUMMARY, summary)

    def remove_leftovers(self) -> None:
        """Remove unfinished files of this command, of this run or of one that was killed."""
        own = {self.path / name for name in (MARKER, *self._own)}
        for folder in sorted({file.parent for file in own}):
            for part in folder.glob(".*.part"):
                if folder / finished_name(part.name) in own:
                    part.unlink(missing_ok=True)

    def _note(self, name: str, content: str) -> None:
        with self._lock:
            self._written[name] = content

    def _replaceable(self, name: str) -> Path:
        """The path of the file `name`, which may be written; its folder is made."""
        target = self.path / name
        if os.path.lexists(target):
            if self._own.content_of(name) is None:
                raise InputError(not_own(target))
            if target.resolve() in self._reads:
                raise InputError(read_and_written(target))
        make_directory(target.parent)
        return target


@contextlib.contextmanager
def results_directory(
    path: Path, command: str, reads: Iterable[Path] = (), inputs: str = ""
) -> Iterator[ResultsDirectory]:
    """Make and hold `path` for the results of `command`, which reads the files `reads`.

    Within: no summary, which would not belong to what is written next, and no leftovers of a killed run. `inputs`: a
    folder of copies of what is read, which may be read from there, as it is written before anything is computed.
    `InputError` where the directory is not the command's, cannot be written, or is held by another run.
    """
    make_directory(path)
    with held(path) as is_ours:
        if not is_ours:
            raise InputError(
                f"{path}: another {command_of(path) or command} is writing there; wait for it, or {ELSEWHERE}"
            )
        require_own(path, command)
        own, reading = OwnFiles(path, command), frozenset(each.resolve() for each in reads)
        require_as_written(path, own)
        require_apart(path, own, reading, inputs)
        results = ResultsDirectory(path, own, reading)
        results.remove_leftovers()
        if own.content_of(SUMMARY) is not None:
            own.begin_run()
        results.remove(SUMMARY)
        own.tidy()  # which has the names in the directory on the disk, too
        yield results
        own.tidy()


def finished_name(name: str) -> str:
    """The name that an unfinished file would have got: whoever writes one may write it from an unfinished file, too."""
    while named := LEFTOVER.fullmatch(name):
        name = named[1]
    return name


def require_own(path: Path, command: str) -> None:
    """`InputError` if `path` is marked as another command's, or not marked and holds a file."""
    owner = command_of(path)
    if owner not in (None, command):
        raise InputError(f"{path}: it holds the results of '{owner}'; {ELSEWHERE}")
    stranger = None if owner else first_file(path)
    if stranger is not None:
        raise InputError(
            f"{path}: it holds {stranger.relative_to(path)}, which '{command}' did not write; give a new or an empty "
            "directory by -o"
        )


def first_file(path: Path) -> Path | None:
    """The first file below `path` that belongs to nobody; None where there is none.

    Directories of results may lie in it, as out/aim lies in out.
    """
    for each in sorted(path.iterdir()):
        if each.is_symlink() or not each.is_dir():
            named = LEFTOVER.fullmatch(each.name)
            unfinished = named is not None and named[1] == MARKER  # by a command that was killed
            if not unfinished and each.name != LOCK:
                return each
        elif command_of(each) is None:
            found = first_file(each)
            if found is not None:
                return found
    return None


def require_as_written(path: Path, own: OwnFiles) -> None:
    """`InputError` if somebody has changed a file that the command wrote."""
    for name in own:
        if own.is_changed(name):
            raise InputError(
                f"{path / name}: it was changed after retarder-synth wrote it; move it away, or {ELSEWHERE}"
            )


def require_apart(path: Path, own: OwnFiles, reads: frozenset[Path], inputs: str) -> None:
    """`InputError` if the command reads one of its own files in `path`, unless that is a copy of what is read."""
    for name in own:
        is_copy = name == CONFIGURATION or (inputs and name.startswith(f"{inputs}/"))
        if (path / name).resolve() in reads and not is_copy:
            raise InputError(read_and_written(path / name))


def not_own(file: Path) -> str:
    """What is wrong with a file in the place of an output."""
    return f"{file}: retarder-synth did not write it; move it away, or {ELSEWHERE}"


def read_and_written(file: Path) -> str:
    """What is wrong with an input that is an output."""
    return f"{file}: this run reads it and would write or remove it; {ELSEWHERE}"


def make_directory(path: Path) -> None:
    """Make `path` a directory that can be written, if it is not; `InputError` otherwise."""
    try:
        path.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=path).close()
    except FileExistsError:
        raise InputError(f"{path}: this is a file; give a directory by -o") from None
    except NotADirectoryError:
        raise InputError(f"{path}: a part of this path is a file; give a directory by -o") from None
    except OSError as error:
        if error.errno in MACHINE_FAULTS:
            raise
        raise InputError(f"{path}: cannot be written ({error.strerror}); {ELSEWHERE}") from None
