"""What `inspect` tells of controller code that lies about: recognised where `verify` finds it, not read."""

from __future__ import annotations

from pathlib import Path
from typing import Any, Final

from synth.checker.code_file import AIMS, LINES, PASSAGES, CodeFile, code_files, recognised

CONTENTS: Final = {LINES: "tables", AIMS: "aim tables", PASSAGES: "tables for point sensors"}


def code_at(source: Path) -> tuple[CodeFile, ...]:
    """The exports at `source`, a file of one or a directory; a header stands for the source in C beside it."""
    file = source.with_suffix(".c") if source.suffix == ".h" else source
    found = code_files(source) if source.is_dir() else recognised(file)
    return tuple(code for code in found if code.path.is_file())


def code_document(code: CodeFile) -> dict[str, Any]:
    """An export for programs."""
    return {"path": str(code.path), "language": code.language, "exported_by": code.exported_by}


def code_sentence(code: CodeFile) -> str:
    """An export in words."""
    told = f"{CONTENTS[code.kind]} in {code.language}, exported by {code.exported_by or 'an unknown program'}"
    return f"{code.path}: {told}; verify compares them with those they were made of"
