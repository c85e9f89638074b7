"""Exports of controller code as files: found by their names, whatever their prefix, their kind and their form."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

FOLDERS: Final = ("", "c", "st", "plcopen", "twincat", "scl")
"""Of a directory, those in which exports are looked for: each form may have one of its own."""


@dataclass(frozen=True)
class CodeKind:
    """How the code of a kind of tables is called, behind the word that all its names begin with.

    `record`: that of a table; `load` and `choose`: the blocks that hold its numbers. `head`: how its text begins.
    """

    record: str
    load: str
    choose: str
    head: bytes

    @property
    def units(self) -> tuple[str, str, str]:
        """All that an export of it must hold."""
        return self.record, self.load, self.choose


LINES: Final = CodeKind("TABLE", "LOAD", "CHOOSE", b"Controller tables of a car retarder")
AIMS: Final = CodeKind("TABLE", "LOAD", "SELECT", b"Aim tables of a park position")
PASSAGES: Final = CodeKind(
    "PASSAGE_TABLE", "LOAD_PASSAGES", "PASSAGES_CHOOSE", b"Controller tables of a car retarder with point sensors"
)
WITHOUT_PREFIX: Final = ("RETARDER", "AIM")
LONGEST_HEAD: Final = 2048

LANGUAGES: Final = {
    ".c": "C99",
    ".st": "Structured Text",
    ".xml": "PLCopen XML",
    ".TcPOU": "Structured Text for TwinCAT",
    ".scl": "SCL",
}
"""By the ending of the file that an export is listed by."""
WHOLE: Final = re.compile(r"([A-Za-z]\w*)_(table|passages)\.(?:c|st|xml|scl)")
LOAD_UNIT: Final = re.compile(r"(?:\d{4}_)?([A-Za-z]\w*)_(LOAD|LOAD_PASSAGES)\.(?:st|TcPOU)")
"""Of an export with a file each unit, the one with most of the numbers."""
IS_AIM: Final = re.compile(r"(?:^|_)AIM$")
"""Whether the first word of names is that of aim tables: no prefix may end so."""


@dataclass(frozen=True)
class CodeFile:
    """An export of the tables of a kind; `path` is its only file with their numbers, or that of the block LOAD.

    `word`: what all its names begin with, in capitals.
    """

    path: Path
    kind: CodeKind
    word: str

    @property
    def language(self) -> str:
        """The title of what it is written in."""
        return LANGUAGES[self.path.suffix]

    def files(self) -> list[Path]:
        """The files with numbers of tables: one, or where each unit has a file, those in the order of their names."""
        if LOAD_UNIT.fullmatch(self.path.name) is None:
            return [self.path]
        name = re.compile(rf"(?:\d{{4}}_)?{re.escape(self.word)}_(?:{'|'.join(self.kind.units)})\.(?:st|TcPOU|TcDUT)")
        numbered = self.path.suffix == ".st"
        files = sorted(self.path.parent.iterdir())
        return [file for file in files if name.fullmatch(file.name) and (file.suffix == ".st") == numbered]


def code_files(folder: Path) -> Iterator[CodeFile]:
    """The exports in the directory `folder` and in those of its folders that a form may have for its own."""
    for place in FOLDERS:
        for file in sorted((folder / place).iterdir()) if (folder / place).is_dir() else ():
            yield from recognised(file)


def recognised(file: Path) -> Iterator[CodeFile]:
    """The export that `file` stands for, if it does for any.

    A file with another prefix than none must begin as an export does, so that nobody else's is taken for one.
    """
    whole, unit = WHOLE.fullmatch(file.name), LOAD_UNIT.fullmatch(file.name)
    found = whole or unit
    if found is None:
        return
    word = found[1].upper()
    kind = PASSAGES if "PASSAGES" in found[2].upper() else AIMS if IS_AIM.search(word) else LINES
    if unit or word in WITHOUT_PREFIX or kind.head in beginning(file):
        yield CodeFile(file, kind, word)


def beginning(file: Path) -> bytes:
    """The first bytes of a file; none where it cannot be read."""
    try:
        if not file.is_file():  # a pipe or device might never end
            return b""
        with file.open("rb") as content:
            return content.read(LONGEST_HEAD)
    except OSError:
        return b""
