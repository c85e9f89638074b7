"""The bytes of a file, however odd the file is."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path
from typing import Final

from synth.checker.finding import DamagedError

LARGEST_BYTES: Final = 64 * 2**20


def content_of(path: Path) -> bytes:
    """All of a regular file of bearable size; `DamagedError` for what is not one, or cannot be read."""
    try:
        if not path.is_file():  # a pipe or device might never end
            raise DamagedError("it is no regular file")
        with path.open("rb") as file:
            content = file.read(LARGEST_BYTES + 1)
    except OSError as fault:
        raise DamagedError(f"it cannot be read ({fault.strerror})") from None
    if len(content) > LARGEST_BYTES:
        raise DamagedError(f"it has more than {LARGEST_BYTES} bytes")
    return content


def text_of(path: Path) -> str:
    """A file of ASCII text; `DamagedError` otherwise."""
    try:
        return content_of(path).decode("ascii")
    except UnicodeDecodeError as fault:
        raise DamagedError(f"byte {fault.start} is not ASCII") from None


def rows_below(head: Sequence[str], content: bytes) -> list[list[str]]:
    """The rows of a CSV file below its first line, which must be `head`; `DamagedError` otherwise."""
    try:
        rows = list(csv.reader(io.StringIO(content.decode("utf-8"), newline=""), strict=True))
    except (UnicodeDecodeError, csv.Error) as fault:
        raise DamagedError(f"it is no CSV: {fault}") from None
    if not rows or rows[0] != list(head):
        raise DamagedError(f"its first line is not {','.join(head)}")
    return rows[1:]
