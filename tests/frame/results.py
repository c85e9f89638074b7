"""What lies in a directory of results."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from synth.frame.input_error import InputError
from synth.frame.own_files import MARKER
from synth.frame.results_directory import results_directory

SUMMARY = b"{}"


def results_in(directory: Path) -> dict[str, bytes]:
    """The content of every file below `directory` by name, without the marker that lists them."""
    files = {path.relative_to(directory).as_posix(): path for path in directory.rglob("*") if path.is_file()}
    return {name: path.read_bytes() for name, path in files.items() if path.name != MARKER}


def run(
    path: Path, contents: dict[str, bytes], command: str = "tune", reads: tuple[Path, ...] = (), inputs: str = ""
) -> None:
    """A whole run that writes `contents`."""
    with results_directory(path, command, reads, inputs) as results:
        results.write_all(contents)
        results.finish(SUMMARY)


def files(path: Path) -> dict[str, bytes]:
    """All files but the marker."""
    found = {file.relative_to(path).as_posix(): file for file in path.rglob("*") if file.is_file()}
    return {name: file.read_bytes() for name, file in found.items() if name != MARKER}


@contextmanager
def refused(*words: str) -> Iterator[None]:
    """Within, a refusal in one sentence that holds all of `words`."""
    with pytest.raises(InputError) as caught:
        yield
    assert len(caught.value.sentences) == 1
    for word in words:
        assert word in str(caught.value)
