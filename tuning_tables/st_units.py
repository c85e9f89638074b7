"""Units of Structured Text, types and function blocks, as files of their own."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Final

UNIT: Final = re.compile(r"^(?:FUNCTION_BLOCK (\w+)$|    (\w+) : STRUCT\b)", re.MULTILINE)
"""How a unit begins: a block or a type, with its name."""


def unit_files(texts: Sequence[str]) -> Mapping[str, bytes]:
    """Each text as a file; by their names in the order in which they need each other."""
    names = ["".join(*UNIT.findall(text)) for text in texts]
    return {
        f"{place:04d}_{name}.st": text.encode("ascii")
        for place, (name, text) in enumerate(zip(names, texts, strict=True), start=1)
    }
