"""Numbers of weight categories: fixed for good, so that a controller and its host may hold them as literals.

1 to 5 are the five categories of the yard, whatever book they are in; a user's own have 16 to 255. No number follows
from the order of a file.
"""

from __future__ import annotations

from collections.abc import Mapping
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
