"""What `inspect` tells of controller code that lies about: recognised where `verify` finds it, not read."""

from __future__ import annotations

from typing import Any, Final

from synth.checker.code_file import AIMS, LINES, PASSAGES, CodeFile

CONTENTS: Final = {LINES: "tables", AIMS: "aim tables", PASSAGES: "tables for point sensors"}


def code_document(code: CodeFile) -> dict[str, Any]:
    """An export for programs."""
    return {"path": str(code.path), "language": code.language, "exported_by": code.exported_by}


def code_sentence(code: CodeFile) -> str:
    """An export in words."""
    told = f"{CONTENTS[code.kind]} in {code.language}, exported by {code.exported_by or 'an unknown program'}"
    return f"{code.path}: {told}; verify compares them with those they were made of"
