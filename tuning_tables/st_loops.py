"""FOR loops of the exported Structured Text that turn once, taken out: compilers differ in how often they turn.

MATIEC since 2024 makes no turn where start and end are equal, other compilers made one where the start was beyond the
end. So no FOR of the text may turn once or never. Where the ends are known here, the texts are written with FOR, and
one over an array of one element becomes a statement; where only the controller knows them, they are written as WHILE.
"""

from __future__ import annotations

import re
import textwrap
from typing import Final

_ONE_TURN: Final = re.compile(
    r"^(?P<indent> *)FOR (?P<counter>\w+) := (?P<only>\d+) TO (?P=only) DO\n(?P<body>.*?)^(?P=indent)END_FOR;$",
    re.MULTILINE | re.DOTALL,
)


def without_single_turns(text: str) -> str:
    """The text with each FOR from a number to the same number written as an assignment of it and the body."""
    while _ONE_TURN.search(text):
        text = _ONE_TURN.sub(_once, text)
    return text


def _once(loop: re.Match[str]) -> str:
    indent, body = loop["indent"], textwrap.dedent(loop["body"])
    return textwrap.indent(f"{loop['counter']} := {loop['only']};\n{body}", indent).removesuffix("\n")
