"""The constants of the weight categories in the header of an export in C."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from synth.checker.category_number import YARD


def category_differences(prefix: str, numbers: Mapping[str, int], header: str) -> Iterator[str]:
    """What is wrong with the constants that begin so: `numbers` by category; those of the yard are always there."""
    defined = re.findall(rf"#define {prefix}_CATEGORY_(\w+) (\d{{1,6}}) /\* (.*?) \*/", header)
    found = [(number, comment) for _, number, comment in defined]
    by_number = sorted({**YARD, **numbers}.items(), key=lambda each: each[1])
    wanted = [(str(number), ascii_comment(name)) for name, number in by_number]
    if found != wanted:
        yield f"its header defines the categories {found}, but the tables have {wanted}"
    if len({name for name, _, _ in defined}) < len(found):
        yield "its header gives two categories one name"


def ascii_comment(text: str) -> str:
    """A name as the export writes it into comments."""
    plain = "".join(x if x.isascii() and (x.isalnum() or x in " ._+,()-") else f"<U+{ord(x):04X}>" for x in text)
    return plain.replace("RETARDER_", "RETARDER<U+005F>").replace("retarder_", "retarder<U+005F>")
