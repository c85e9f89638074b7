"""Controller code as files: found whatever its prefix, read as if it had none."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from synth.checker.source_file import content_of, text_of

HEAD: Final = b"Controller tables of a car retarder"
C_COMMENT: Final = r"/\*.*?\*/"
COMMENT: Final = {".st": r"\(\*.*?\*\)"}
"""By the ending of a file, where it is not as in C."""
UNIT_FILE: Final = re.compile(r"\d{4}_(\w+)_LOAD\.st")
"""Of an export with a file each unit, the one with most of the tables."""

LINE_UNITS: Final = "TABLE|CATEGORIES|LOAD|CHOOSE"
AIM_UNITS: Final = "TABLE|LOAD|SELECT"
"""The units that hold numbers of tables, with lines and of aims."""

IS_AIM: Final = re.compile(r"(?:^|_)AIM$")
"""Whether what stands before _LOAD is of an aim table: no prefix may end so."""


@dataclass(frozen=True)
class CodeFile:
    """An export of controller code at `path`, with the text in which names begin with RETARDER and retarder."""

    path: Path
    prefix: str

    def text(self, path: Path | None = None) -> str:
        """The text of the file, or of another one of the same export; comments, with ids of tables, as they are."""
        file = path or self.path
        upper, lower = re.escape(self.prefix.upper()), re.escape(self.prefix.lower())
        return re.sub(
            rf"{COMMENT.get(file.suffix, C_COMMENT)}|\b(?:(?P<upper>{upper})|(?P<lower>{lower}))_",
            lambda found: "RETARDER_" if found["upper"] else "retarder_" if found["lower"] else found[0],
            text_of(file),
            flags=re.DOTALL,
        )

    def units(self) -> str:
        """The text of all units of the tables in Structured Text: one file, or several in the order of their names."""
        if not UNIT_FILE.fullmatch(self.path.name):
            return self.text()
        return "\n".join(self.text(file) for file in unit_files(self.path.parent, self.prefix, LINE_UNITS))


def unit_files(folder: Path, prefix: str, units: str) -> list[Path]:
    """The files of an export with a file each unit, of these units alone, in the order of their names."""
    parts = re.compile(rf"\d{{4}}_{re.escape(prefix)}_({units})\.st")
    return [file for file in sorted(folder.iterdir()) if parts.fullmatch(file.name)]


def c_files(folder: Path) -> Iterator[CodeFile]:
    """The C99 exports in `folder`."""
    return whole_files(folder, "_table.c")


def st_files(folder: Path) -> Iterator[CodeFile]:
    """The exports in Structured Text in `folder`."""
    yield from whole_files(folder, "_table.st")
    for file in sorted(folder.glob("*_LOAD.st")):
        found = UNIT_FILE.fullmatch(file.name)
        if found and not IS_AIM.search(found[1]):
            yield CodeFile(file, found[1])


def whole_files(folder: Path, ending: str) -> Iterator[CodeFile]:
    """The files whose names end so: of no other prefix than RETARDER unless they begin as an export does."""
    for file in sorted(folder.glob(f"*{ending}")):
        prefix = file.name.removesuffix(ending)
        if prefix == "retarder" or HEAD in content_of(file)[: 2 * len(HEAD)]:
            yield CodeFile(file, prefix)
