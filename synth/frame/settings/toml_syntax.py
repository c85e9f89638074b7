"""What is wrong with a text that is no TOML: a sentence for each mistake that has a known remedy, then for the first
other one."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final

from tuning_tables.errors import excerpt

MOST_FAULTS: Final = 50
LONGEST_MENDED: Final = 200_000
"""Characters of a text of which more than the first fault is told: each costs to read it once more."""

LONGEST_NUMBER: Final = 60

PLACE: Final = re.compile(r"\(at line (\d+), column (\d+)\)")
COMMA: Final = re.compile(r"(?<![\w.,])[-+]?\d+,\d+(?!\w|,\d)")
WORD: Final = re.compile(r"[^\W\d][\w-]*")
QUOTED: Final = re.compile(r"[“”„‘’«»]([^“”„‘’«»\n]*)[“”„‘’«»]")
MINUS: Final = re.compile(r"[−–](?=[\d.])")
POINT: Final = re.compile(r"[-+]?(?:\d+\.(?!\d)|\.\d+)")
UNIT: Final = re.compile(r"[ \t]*(%|‰|°|[a-zA-Z]+[²/]?\w*)")
VALUE: Final = re.compile(r"""[\[{"'\d+-]""")
KEY: Final = re.compile(r"[\w.\"'-]+\s*=")
TRUTH: Final = {"true": "true", "yes": "true", "on": "true", "false": "false", "no": "false", "off": "false"}
"""What users write for true and false."""


@dataclass(frozen=True)
class Mend:
    """A mistake: what is told of it, and the text without it, None where it is not known what was meant."""

    sentence: str
    text: str | None


Rule = Callable[[str, int, str], Mend | None]
"""The mistake at a place of a text that tomllib refuses there with a message; None where it is another one."""


@dataclass(frozen=True)
class SyntaxFaults:
    """`sentences`, each behind the file and its line; `mended`: the text as it was meant, and `tree`, its tables; both
    None where that is not known."""

    sentences: tuple[str, ...]
    mended: str | None = None
    tree: dict[str, Any] | None = None


def syntax_faults(text: str, file: str) -> SyntaxFaults:
    """Those of `text`, which may have none; `file` is what messages call it. `ValueError`, `RecursionError` as
    tomllib."""
    told: list[str] = []
    while len(told) < MOST_FAULTS:
        try:
            tree = tomllib.loads(text)
        except tomllib.TOMLDecodeError as error:
            at, message = place_of(text, str(error)), str(error)
            mend = next((mend for rule in RULES if (mend := rule(text, at, message)) is not None), None)
            if mend is None:
                told.append(f"{file}: this is not valid TOML: {excerpt(message, 200)}; correct the file there")
                return SyntaxFaults(tuple(told))
            line = text.count("\n", 0, min(at, len(text) - 1)) + 1
            told.append(f"{file}, line {line}: {mend.sentence}")
            if mend.text is None or len(text) > LONGEST_MENDED:
                return SyntaxFaults(tuple(told))
            text = mend.text
        else:
            return SyntaxFaults(tuple(told), text, tree)
    return SyntaxFaults(tuple(told))


def place_of(text: str, message: str) -> int:
    """Where in `text` tomllib stopped."""
    found = PLACE.search(message)
    if found is None:
        return len(text)
    lines = text.split("\n")
    return sum(len(line) + 1 for line in lines[: int(found[1]) - 1]) + int(found[2]) - 1


def decimal_comma(text: str, at: int, message: str) -> Mend | None:
    """0,6 in place of 0.6."""
    if at >= len(text):
        return None
    line = max(text.rfind("\n", 0, at) + 1, at - LONGEST_NUMBER)
    for found in COMMA.finditer(text, line):
        if found.start() > at:
            break
        if not text[found.end() : at].strip():
            meant = found[0].replace(",", ".")
            told = f"{found[0]} is no number of TOML; write {meant}, with a decimal point"
            return Mend(told, text[: found.start()] + meant + text[found.end() :])
    return None


def missing_comma(text: str, at: int, message: str) -> Mend | None:
    """Two items of a list, or two keys of a table, without a comma between them."""
    rest = text[at:]
    inner = message.startswith("Unclosed inline table") and KEY.match(rest)
    listed = message.startswith("Unclosed array") and VALUE.match(rest) and not KEY.match(rest)
    if not inner and not listed:
        return None
    return Mend(f"a comma is missing before {excerpt(rest.split(chr(10))[0], 30)!r}", f"{text[:at]}, {rest}")


def not_closed(text: str, at: int, message: str) -> Mend | None:
    """A list that is not closed before the next key, or a table in braces that goes over more than one line."""
    if message.startswith("Unclosed array") and KEY.match(text[at:]):
        return Mend(
            f"the list before {excerpt(text[at:].split(chr(10))[0], 30)!r} is not closed; add ]", closed(text, at)
        )
    broken = text[at : at + 1] == "\n" and ("inline table" in message or "key part" in message)
    if broken and text.rfind("{", text.rfind("\n", 0, at) + 1, at) >= 0:
        joined = text[:at].rstrip().removesuffix(",") + ", " + text[at + 1 :].lstrip()
        return Mend("a table in { } must end on its line; join it with the next line, or close it with }", joined)
    return None


def closed(text: str, at: int) -> str:
    """`text` with ] before the line of `at`."""
    line = text.rfind("\n", 0, at)
    return f"{text[:line]}]{text[line:]}" if line >= 0 else text


def wrong_value(text: str, at: int, message: str) -> Mend | None:
    """A word without quotes, or with those of a word processor; True; a long minus; a bare decimal point."""
    rest = text[at:]
    word, quoted, minus, point = (form.match(rest) for form in (WORD, QUOTED, MINUS, POINT))
    if word and (truth := TRUTH.get(word[0].lower())):
        return Mend(f"{word[0]} must be written {truth}", text[:at] + truth + rest[word.end() :])
    if word and message.startswith("Invalid value"):
        return Mend(f'words need quotes: write "{word[0]}"', f'{text[:at]}"{word[0]}"{rest[word.end() :]}')
    if quoted:
        return Mend(f'write "{quoted[1]}", with straight quotes', f'{text[:at]}"{quoted[1]}"{rest[quoted.end() :]}')
    if minus:
        return Mend("the sign before this number is a dash; write -", f"{text[:at]}-{rest[1:]}")
    if point and message.startswith("Invalid value"):
        return Mend(f"{point[0]} must be written 0{point[0]}", f"{text[:at]}0{rest}")
    return None


def unit_behind(text: str, at: int, message: str) -> Mend | None:
    """A number with a unit, or with nothing behind its decimal point."""
    rest = text[at:]
    if not text[:at].rstrip(" \t").endswith(tuple("0123456789")) or not message.startswith(
        ("Expected newline", "Unclosed")
    ):
        return None
    if rest.startswith("."):
        return Mend("nothing stands behind the decimal point; write .0", f"{text[:at]}.0{rest[1:]}")
    unit = UNIT.match(rest)
    if unit is None:
        return None
    return Mend(
        f"{unit[1]} stands behind a number; the key tells the unit, write the number alone",
        text[:at] + rest[unit.end() :],
    )


def wrong_sign(text: str, at: int, message: str) -> Mend | None:
    """A colon, or two equals signs, behind a key."""
    if message.startswith("Expected '=' after a key") and text[at : at + 1] == ":":
        return Mend("write = behind a key, not a colon", f"{text[:at]}={text[at + 1 :]}")
    if message.startswith("Invalid value") and text[at : at + 1] == "=":
        return Mend("write one = behind a key", text[:at] + text[at + 1 :])
    return None


def twice(text: str, at: int, message: str) -> Mend | None:
    """A key or a table that is there before, a comma too many, or a quote too few."""
    if message.startswith("Cannot overwrite a value"):
        return Mend("this key is there before; keep one of the two", None)
    if message.startswith("Cannot declare"):
        return Mend("this table is there before; put the two together", None)
    if message.startswith("Invalid initial character for a key part") and text[at : at + 1] == "}":
        return Mend("take the comma before } out", text[:at].rstrip().removesuffix(",") + text[at:])
    if message.startswith("Illegal character '\\n'"):
        return Mend("a quote is missing at the end of this line", None)
    return None


RULES: Final[tuple[Rule, ...]] = (
    decimal_comma,
    missing_comma,
    not_closed,
    wrong_value,
    unit_behind,
    wrong_sign,
    twice,
)
