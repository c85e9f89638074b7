"""Controller code that lies about: recognised with its layout, not read."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from tuning_tables.regular_file import first_bytes
from tuning_tables.table_block import LAYOUT

BEGINNING = b"Controller tables of a car retarder"
PASSAGES_BEGINNING = b"Controller tables of a car retarder with point sensors"
AIM_BEGINNING = b"Aim tables of a park position"
UNLAID = {
    AIM_BEGINNING: "aim tables in {}; verify compares them with the tables",
    PASSAGES_BEGINNING: "tables for point sensors in {}; their self-test tells whether they are whole",
}
"""What is said of code that has no layout, by its beginning."""
LAYOUTS = {
    "C99": re.compile(rb"#define \w+_LAYOUT (\d{1,6})u"),
    "Structured Text": re.compile(rb"^   layout +(\d{1,6}) ", re.MULTILINE),
}
LANGUAGES = {".h": "C99", ".c": "C99", ".st": "Structured Text"}
FOLDERS = ("", "c", "st")
PATTERNS = ("*_table.h", "*_passages.h", "*.st")
MOST_BYTES = 65536
"""The layout stands near the beginning."""


@dataclass(frozen=True)
class ExportedCode:
    """An export of controller code, and its layout: 1 where it states none, None of tables that have none.

    `beginning`: which of these it is, a key of `UNLAID`; empty for code with a layout.
    """

    path: Path
    language: str
    layout: int | None
    beginning: bytes = b""

    @property
    def sentence(self) -> str:
        """What it is, and what to do if it is not of today's layout."""
        if self.layout is None:
            return UNLAID[self.beginning].format(self.language)
        if self.layout > LAYOUT:
            return f"{self.language}, layout {self.layout}; this version knows layout {LAYOUT}: update it"
        if self.layout == LAYOUT:
            return f"{self.language}, layout {LAYOUT}; verify compares it with the tables"
        return f"{self.language}, layout 1, whose numbers of categories follow the order of the tables: export again"

    def document(self) -> dict[str, Any]:
        """The same for programs."""
        told = {"path": str(self.path), "language": self.language}
        return told if self.layout is None else {**told, "layout": self.layout, "current": LAYOUT}


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
    for beginning in UNLAID:
        if beginning in text[: 2 * len(beginning)]:
            yield ExportedCode(file, language, None, beginning)
            return
    if BEGINNING in text[: 2 * len(BEGINNING)]:
        found = LAYOUTS[language].search(text)
        yield ExportedCode(file, language, int(found[1]) if found else 1)
