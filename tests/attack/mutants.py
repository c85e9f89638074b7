"""Mutants of a file: bytes of any file, numbers, words, lines and encodings of a text. Each follows from its dice."""

from __future__ import annotations

import random
import re
from collections.abc import Callable
from typing import Final

Change = Callable[[bytes, random.Random], bytes]

NUMBER: Final = re.compile(rb"(?<![\w.])[-+]?\d[\d_]*(?:\.\d+)?(?:[eE][-+]?\d+)?")
WORD: Final = re.compile(rb"[A-Za-z_][\w-]*")
QUOTED: Final = re.compile(rb'"[^"\n]*"')

NUMBERS: Final = (
    *(b"0", b"-0.0", b"-1", b"nan", b"inf", b"-inf", b"1e308", b"-1e308", b"1e999", b"1e-320", b"1e99999999"),
    *(
        b"9223372036854775807",
        b"9223372036854775808",
        b"9" * 30,
        b"9" * 5000,
        b"0x" + b"f" * 5000,
        b"0x10",
        b"1_000",
        b"007",
        b"1,5",
    ),
    *(b"true", b'""', b"[]", b"{}", b"[[]]", b"1979-05-27", b""),
)
TEXTS: Final = (
    *("", " ", "$x^$", "=HYPERLINK(1)", "x" * 3000, "../../../etc/passwd", "/", ".", "/dev/zero", "~", "-", "%s{}"),
    *("a\\u0000b", "\\u001b[31m", "\x1b[31m", "\u202e", "é", "\U0001d518", "\\\\", "a\\nb", "nan", "1", "<b>", "&#7;"),
)
SIGNS: Final[tuple[str, ...]] = (
    *"[]{}()\"',;:=#$&<>\\/|.-+%\n\r\t \x00\x1b\x7f\u2028\ufeffé",
    *('"""', "'''", "[[a]]\n", "[a]\n", "<!--", "]]>", "\r\n", "\\ud800", "&amp;", "&x;"),
)
DEEP: Final = (b"[", b"{a=", b"<a>", b"(", b'"')
WHOLE: Final[tuple[Callable[[bytes], bytes], ...]] = (
    lambda content: content.replace(b"\n", b"\r\n"),
    lambda content: content.replace(b"\n", b"\r"),
    lambda content: b"\xef\xbb\xbf" + content,
    lambda content: content.decode("utf-8", "replace").encode("utf-16"),
    lambda content: content + b"\xe9",
    lambda content: content + bytes(1000),
)


def mutant(content: bytes, dice: random.Random, text: bool) -> bytes:
    """`content` after one to three changes; `text`: mostly such as a text may suffer."""
    changes = (bytes_changed, *OF_TEXT) if text else (bytes_changed,)
    for _ in range(dice.choice((1, 1, 1, 2, 3))):
        content = dice.choice(changes)(content, dice)
    return content


def changed_text(content: bytes, dice: random.Random) -> bytes:
    """The mutant of a text."""
    return mutant(content, dice, text=True)


def bytes_changed(content: bytes, dice: random.Random) -> bytes:
    """A bit is flipped; or bytes in a row are replaced, taken out, put in, or moved; or the end is cut off."""
    at, size = dice.randrange(len(content) + 1), dice.choice((1, 1, 2, 4, 8, 40))
    before, here, after = content[:at], content[at : at + size], content[at + size :]
    match dice.randrange(6):
        case 0:
            flipped = bytes(byte ^ 1 << dice.randrange(8) for byte in here[:1])
            return before + flipped + here[1:] + after
        case 1:
            return before + dice.choice((dice.randbytes(len(here)), bytes(len(here)), b"\xff" * len(here))) + after
        case 2:
            return before + after
        case 3:
            return before + dice.randbytes(size) + here + after
        case 4:
            to = dice.randrange(len(content) + 1)
            return content[:to] + here + content[to:]
        case _:
            return before


def exchanged(pattern: re.Pattern[bytes], other: Change) -> Change:
    """A change that puts `other` of something that the pattern finds in its place."""

    def change(content: bytes, dice: random.Random) -> bytes:
        found = list(pattern.finditer(content))
        if not found:
            return content
        chosen = dice.choice(found)
        return content[: chosen.start()] + other(chosen.group(), dice) + content[chosen.end() :]

    return change


def scaled(number: bytes, dice: random.Random) -> bytes:
    """The number times something."""
    return repr(float(number.replace(b"_", b"")) * dice.choice((-1.0, 0.5, 1.0001, 2.0, 1e3, 1e-3))).encode()


def misspelt(word: bytes, dice: random.Random) -> bytes:
    """A letter is missing, doubled, or another."""
    at = dice.randrange(len(word))
    return word[:at] + dice.choice((b"", word[at : at + 1] * 2, b"x")) + word[at + 1 :]


def word_for_word(content: bytes, dice: random.Random) -> bytes:
    """A word stands where another one stood."""
    words = [found.group() for found in WORD.finditer(content)]
    return exchanged(WORD, lambda word, dice: dice.choice(words))(content, dice)


def line_changed(content: bytes, dice: random.Random) -> bytes:
    """A line is missing, repeated, moved, or changes places with another."""
    lines = content.splitlines(keepends=True) or [b"\n"]
    one, other = dice.randrange(len(lines)), dice.randrange(len(lines))
    match dice.randrange(4):
        case 0:
            del lines[one]
        case 1:
            lines.insert(other, lines[one])
        case 2:
            lines[one] *= dice.choice((2, 2, 3, 1000))
        case _:
            lines[one], lines[other] = lines[other], lines[one]
    return b"".join(lines)


def sign_in(content: bytes, dice: random.Random) -> bytes:
    """A sign comes in, or stands where another one stood."""
    at, sign = dice.randrange(len(content) + 1), dice.choice(SIGNS)
    return content[:at] + sign.encode() + content[at + dice.randrange(2) :]


OF_TEXT: Final[tuple[Change, ...]] = (
    exchanged(NUMBER, lambda number, dice: dice.choice(NUMBERS)),
    exchanged(NUMBER, lambda number, dice: dice.choice(NUMBERS)),
    exchanged(NUMBER, lambda number, dice: dice.choice(DEEP) * dice.choice((25, 1000, 100_000))),
    exchanged(NUMBER, scaled),
    exchanged(WORD, misspelt),
    exchanged(QUOTED, lambda text, dice: b'"' + dice.choice(TEXTS).encode() + b'"'),
    word_for_word,
    line_changed,
    line_changed,
    sign_in,
    lambda content, dice: dice.choice(WHOLE)(content),
)
