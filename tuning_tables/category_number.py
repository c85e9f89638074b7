"""Weight categories in controller code: numbers fixed for good, which controller and host may hold as literals,
and names as ASCII macros and comments.

1 to 5 are the five categories of the yard, whatever book they are in; a user's own have 16 to 255. No number follows
from the order of a file.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

from tuning_tables.errors import InvalidTable

KNOWN_NUMBERS: Final[Mapping[str, int]] = MappingProxyType({"Л": 1, "ЛС": 2, "С": 3, "СТ": 4, "Т": 5})
"""The categories of the yard by their names in tables."""

LEAST_OWN, LARGEST_OWN = 16, 255
"""Of a user's own category; 6 to 15 are kept free, and 0 stands for none."""


def require_category_number(category: str, number: object, key: str = "cut.category_number") -> None:
    """`number`, which stands at `key`, may stand for `category`; raises `InvalidTable`."""
    if category in KNOWN_NUMBERS:
        allowed = KNOWN_NUMBERS[category] == number and not isinstance(number, bool)
        wanted = f"{KNOWN_NUMBERS[category]}, its number in every table"
    else:
        whole = isinstance(number, int) and not isinstance(number, bool)
        allowed = whole and LEAST_OWN <= number <= LARGEST_OWN  # type: ignore[operator]  # `whole`: an int
        wanted = f"a whole number in [{LEAST_OWN}, {LARGEST_OWN}], as it is a category of your own"
    if not allowed:
        raise InvalidTable(f"{key} of the category {category} is {number!r:.60}, but it must be {wanted}.")


LONGEST_MACRO: Final = 8
"""Characters kept of a name; with a prefix, CATEGORY and a number it stays within limits of 32 and more."""

_LATIN: Final = str.maketrans(
    {
        "А": "A", "Б": "B", "В": "V", "Г": "G", "Д": "D", "Е": "E", "Ё": "E", "Ж": "ZH", "З": "Z", "И": "I", "Й": "J",
        "К": "K", "Л": "L", "М": "M", "Н": "N", "О": "O", "П": "P", "Р": "R", "С": "S", "Т": "T", "У": "U", "Ф": "F",
        "Х": "H", "Ц": "C", "Ч": "CH", "Ш": "SH", "Щ": "SHH", "Ъ": "", "Ы": "Y", "Ь": "", "Э": "E", "Ю": "JU",
        "Я": "JA",
    }
)  # fmt: skip


@dataclass(frozen=True)
class CategoryName:
    """A weight category as controller code calls it: "RETARDER_CATEGORY_" and `macro`, and its number."""

    macro: str
    category: str
    number: int


def category_names(exported: Mapping[str, int]) -> tuple[CategoryName, ...]:
    """The categories of the yard, exported or not, and the numbers of those that are `exported`, by number.

    So a name stands for one number in every export, and what was written for one compiles with the next.
    """
    numbers = {**KNOWN_NUMBERS, **exported}
    named = zip(category_macros(numbers), numbers.items(), strict=True)
    return tuple(sorted((CategoryName(name, *each) for name, each in named), key=lambda each: each.number))


def category_macros(numbers: Mapping[str, int]) -> tuple[str, ...]:
    """The part of a constant's name that stands for each category of `numbers`: all different, "ЛС" giving "LS".

    Each is [A-Z0-9]+ in words joined by single "_", as Structured Text wants it. Cyrillic letters are transliterated,
    white space and hyphens become "_", all else is left out. Where nothing is left, or two categories come out alike,
    each of them has its number appended; but the categories of the yard, whose names are always the same.
    """
    plain = [_plain(category) for category in numbers]
    return tuple(
        name
        if category in KNOWN_NUMBERS or (name and plain.count(name) == 1 and not _looks_numbered(name, plain))
        else f"{name}_{number}".lstrip("_")
        for name, (category, number) in zip(plain, numbers.items(), strict=True)
    )


def comment_text(text: str) -> str:
    """`text` for a comment in C or Structured Text: other characters than [A-Za-z0-9 ._+,()-] as <U+041B>.

    What is left can neither end a comment nor begin one, break a line or continue it; and none of it looks like a name
    of the code, because the "_" of RETARDER_ is shown so, too.
    """
    special = r"[^A-Za-z0-9 ._+,()-]|(?<=RETARDER)_|(?<=retarder)_"
    return re.sub(special, lambda found: f"<U+{ord(found[0]):04X}>", text)


def _plain(category: str) -> str:
    latin = category.upper().translate(_LATIN)
    letters = re.sub(r"[^A-Z0-9_]", "", re.sub(r"[\s-]", "_", latin))
    return re.sub(r"_+", "_", letters).strip("_")[:LONGEST_MACRO].rstrip("_")


def _looks_numbered(name: str, names: Sequence[str]) -> bool:
    """Whether `name` might be what another one becomes with its number appended."""
    stem, _, number = name.rpartition("_")
    return number.isdigit() and stem in names
