"""What lies in a directory of results."""

from __future__ import annotations

from pathlib import Path

from synth.frame.own_files import MARKER


def results_in(directory: Path) -> dict[str, bytes]:
    """The content of every file below `directory` by name, without the marker that lists them."""
    files = {path.relative_to(directory).as_posix(): path for path in directory.rglob("*") if path.is_file()}
    return {name: path.read_bytes() for name, path in files.items() if path.name != MARKER}
