"""Weight categories and names as controller code can hold them: ASCII macros, ASCII comments."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

LONGEST_MACRO: Final = 16
"""Characters kept of a name; with a prefix such as RETARDER_CATEGORY_ it stays within limits of 32 and more."""

_LATIN: Final = str.maketrans(
    {
        "А": "A", "Б": "B", "В": "V", "Г": "G", "Д": "D", "Е": "E", "Ё": "E", "Ж": "ZH", "З": "Z", "И": "I", "Й": "J",
        "К": "K", "Л": "L", "М": "M", "Н": "N", "О": "O", "П": "P", "Р": "R", "С": "S", "Т": "T", "У": "U", "Ф": "F",
        "Х": "H", "Ц": "C", "Ч": "CH", "Ш": "SH", "Щ": "SHH", "Ъ": "", "Ы": "Y", "Ь": "", "Э": "E", "Ю": "JU",
        "Я": "JA",
    }
)  # fmt: skip


def category_macros(categories: Sequence[str]) -> tuple[str, ...]:
    """The part of a constant's name that stands for each category: all different, "ЛС" giving "LS".

    Each is [A-Z0-9]+ in words joined by single "_", as Structured Text wants it. Cyrillic letters are transliterated,
    white space and hyphens become "_", all else is left out. Where nothing is left, or two categories come out alike,
    each of them has its number (from 1, the one that controllers use) appended.
    """
    plain = [_plain(category) for category in categories]
    return tuple(
        name if name and plain.count(name) == 1 and not _looks_numbered(name, plain) else f"{name}_{number}".lstrip("_")
        for number, name in enumerate(plain, start=1)
    )


def comment_text(text: str) -> str:
    """`text` for a comment in C or Structured Text: other characters than [A-Za-z0-9 ._+,()-] as <U+041B>.

    What is left can neither end a comment nor begin one, break a line or continue it.
    """
    return re.sub(r"[^A-Za-z0-9 ._+,()-]", lambda found: f"<U+{ord(found[0]):04X}>", text)


def _plain(category: str) -> str:
    latin = category.upper().translate(_LATIN)
    letters = re.sub(r"[^A-Z0-9_]", "", re.sub(r"[\s-]", "_", latin))
    return re.sub(r"_+", "_", letters).strip("_")[:LONGEST_MACRO].rstrip("_")


def _looks_numbered(name: str, names: Sequence[str]) -> bool:
    """Whether `name` might be what another one becomes with its number appended."""
    stem, _, number = name.rpartition("_")
    return number.isdigit() and stem in names
