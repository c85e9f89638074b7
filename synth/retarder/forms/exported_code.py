"""Controller code that lies about: recognised, not read."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tuning_tables.regular_file import first_bytes

BEGINNINGS = {
    b"Aim tables of a park position": "aim tables in {}; verify compares them with the tables",
    b"Controller tables of a car retarder with point sensors": (
        "tables for point sensors in {}; their self-test tells whether they are whole"
    ),
    b"Controller tables of a car retarder": "{}; verify compares it with the tables",
}
"""What is said of code, by its beginning."""
LANGUAGES = {".h": "C99", ".c": "C99", ".st": "Structured Text"}
FOLDERS = ("", "c", "st")
PATTERNS = ("*_table.h", "*_passages.h", "*.st")
MOST_BYTES = 4096


@dataclass(frozen=True)
class ExportedCode:
    """An export of controller code: where it is, in which language, and what is said of it."""

    path: Path
    language: str
    sentence: str

    def document(self) -> dict[str, Any]:
        """The same for programs."""
        return {"path": str(self.path), "language": self.language}


def exported_code(path: Path) -> tuple[ExportedCode, ...]:
    """The exports at `path`: a file, or what a directory holds, also in its c/ and st/; empty where there is none."""
    if not path.is_dir():
        return tuple(recognised(path))
    folders = [path / name for name in FOLDERS]
    files = [file for folder in folders for pattern in PATTERNS for file in sorted(folder.glob(pattern))]
    return tuple(code for file in files for code in recognised(file))


def recognised(file: Path) -> Iterator[ExportedCode]:
    """The export that `file` is the head of; nothing for other files. Of a C file the header beside it counts."""
    language = LANGUAGES.get(file.suffix)
    head = file.with_suffix(".h") if file.suffix == ".c" else file
    if language is None or not head.is_file():
        return
    try:
        text = first_bytes(head, MOST_BYTES)
    except OSError:  # whoever reads it for its tables tells why
        return
    for beginning, sentence in BEGINNINGS.items():
        if beginning in text[: 2 * len(beginning)]:
            yield ExportedCode(file, language, sentence.format(language))
            return
