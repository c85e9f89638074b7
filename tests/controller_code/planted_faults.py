"""Faults planted in a generated C text: every operator swapped, every number changed, every assignment left out."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final

SWAPPED: Final = {
    "+": "-", "-": "+", "*": "/", "/": "*", "<": "<=", ">": ">=", "<=": "<", ">=": ">", "&&": "||", "||": "&&",
    "==": "!=", "!=": "==",
}  # fmt: skip
OPERATOR: Final = re.compile(r"(?<= )(?:[-+*/<>]|[<>=!]=|&&|\|\|)(?= |\n)")
NUMBER: Final = re.compile(r"(?<![\w.])(?:\d+\.\d+f|0x[0-9a-f.]+p[-+]\d+f|\d+)(?![\w.])")
ASSIGNED: Final = re.compile(r"^ +(?:\*?\w+|[\w>\-\[\]]+) = [^;]*;$", re.M)
COMMENT: Final = re.compile(r"/\*.*?\*/", re.S)


def planted_faults(code: str) -> Iterator[tuple[str, str]]:
    """(what was changed, the code with it) for every fault, in the order of the text."""
    hidden = [range(*match.span()) for match in COMMENT.finditer(code)]

    def is_hidden(at: int) -> bool:
        return any(at in each for each in hidden)

    for match in OPERATOR.finditer(code):
        if not is_hidden(match.start()):
            yield changed(code, match, SWAPPED[match[0]])
    for match in NUMBER.finditer(code):
        if not is_hidden(match.start()):
            yield changed(code, match, another(match[0]))
    for match in ASSIGNED.finditer(code):
        if not is_hidden(match.start()):
            yield changed(code, match, "(void)0;")


def another(number: str) -> str:
    """A number beside it: a last bit or so, or one more."""
    if number == "0.0f":
        return "0.001f"
    if number.endswith("f"):
        return f"({number} * 1.01f)"
    return str(int(number) + 1)


def changed(code: str, match: re.Match[str], to: str) -> tuple[str, str]:
    """What is changed, as its line and the change, and the code."""
    line = code[code.rfind("\n", 0, match.start()) + 1 : code.index("\n", match.start())].strip()
    shown = "left out" if to == "(void)0;" else f"{match[0]} -> {to}"
    return f"{line}: {shown}", code[: match.start()] + to + code[match.end() :]
