"""Faults planted in a generated C text: operators swapped, numbers changed, assignments left out."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Final

SWAPPED: Final = {
    "+": "-", "-": "+", "*": "/", "/": "*", "<": "<=", ">": ">=", "<=": "<", ">=": ">", "&&": "||", "||": "&&",
    "==": "!=", "!=": "==",
}  # fmt: skip
OPERATOR: Final = re.compile(r"(?<= )(?:[-+*/<>]|[<>=!]=|&&|\|\|)(?= |\n)")
CONSTANT: Final = re.compile(r"^#define (\w+) (-?0x\S+f)", re.M)
ASSIGNED: Final = re.compile(r"^ +(?:\*?\w+|[\w>\-\[\].]+) = [^;]*;$", re.M)
COARSE: Final = ("GATE_SQUARED", "FEW_READINGS")
"""Constants of which a hundredth is lost when it comes to readings."""

COMMENT: Final = re.compile(r"/\*.*?\*/", re.S)


def planted_faults(code: str) -> Iterator[tuple[str, str]]:
    """(what was changed, the code with it) for every fault, in the order of the text."""
    hidden = {at for match in COMMENT.finditer(code) for at in range(*match.span())}
    for match in OPERATOR.finditer(code):
        if match.start() not in hidden:
            yield changed(code, match, SWAPPED[match[0]])
    for match in CONSTANT.finditer(code):
        yield changed(code, match, f"#define {match[1]} ({match[2]} * {1.5 if match[1] in COARSE else 1.01}f)")
    for match in ASSIGNED.finditer(code):
        if match.start() not in hidden:
            yield changed(code, match, "(void)0;")


def changed(code: str, match: re.Match[str], to: str) -> tuple[str, str]:
    """What is changed, as its line and the change, and the code."""
    line = code[code.rfind("\n", 0, match.start()) + 1 : code.index("\n", match.start())].strip()
    shown = "left out" if to == "(void)0;" else f"{match[0]} -> {to}"
    return f"{line}: {shown}", code[: match.start()] + to + code[match.end() :]
