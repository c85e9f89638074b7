"""Words for a terminal: broken between words, and inside one only where it is longer than a line, as a path may be."""

from __future__ import annotations

import re
from typing import Final

SPACE: Final = " "
NO_BREAK: Final = "\u00a0"
"""Printed as a space, but no line is broken there."""

WORD: Final = re.compile(r" *[^ ]+(?:(?<=\d) [%\w/]{1,4}[,;.:)\]]*(?= |$))?")
"""A word with the spaces before it; a number and its unit are one word."""

HANGING: Final = 2
"""How much farther right a sentence goes on."""

BREAKS: Final = "/_-"
"""A word that is longer than a line is broken behind one of these."""


def wrapped(text: str, width: int, hang: int = 0) -> list[str]:
    """The lines of `text`, none longer than `width` characters; those after the first begin `hang` farther right.

    A word is broken only if a line is too short for it, so that every figure that fits into a line stays whole.
    """
    margin = SPACE * min(len(text) - len(text.lstrip(SPACE)) + hang, width // 2)
    lines = [""]
    for token in WORD.findall(text):
        if lines[-1].strip(SPACE) and len(lines[-1] + token) > width:
            lines.append(margin + token.lstrip(SPACE))
        else:
            lines[-1] += token
        word = len(token.lstrip(SPACE))
        while len(lines[-1]) > width:
            line = lines.pop()
            at = place_to_break(line, len(line) - word, width)
            lines += [line[:at], margin + line[at:]]
            word = len(line) - at
    return [line.replace(NO_BREAK, SPACE) for line in lines]


def place_to_break(line: str, begin: int, width: int) -> int:
    """Where to break the word from `begin` on to the end of `line`, so that the line is not longer than `width`."""
    return max((line.rfind(each, begin, width) for each in BREAKS), default=-1) + 1 or width


def least_width(text: str, most_lines: int) -> int:
    """The smallest width at which `text` is broken between words only, and over so many lines at most."""
    width = longest_word(text)
    while len(wrapped(text, width)) > most_lines:
        width += 1
    return width


def longest_word(text: str) -> int:
    """Characters of the longest word."""
    return max((len(word.strip(SPACE)) for word in WORD.findall(text)), default=0)
