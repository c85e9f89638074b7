"""The colour of a weight category: one in every picture and on every page."""

from __future__ import annotations

from typing import Final

YARD: Final = ("#440154", "#3e4a89", "#25848e", "#38b977", "#bddf26")
"""Of the five categories of the yard, whose numbers are 1 to 5: from dark to pale, so that their order is one in grey,
too."""

OWN: Final = ("#d55e00", "#cc79a7", "#e69f00", "#56b4e9", "#7a4b00", "#767676")
"""Of a user's own, by their numbers; they come again where there are more."""


def category_colour(number: int) -> str:
    """The colour of the category with this `number`, which stands for it in tables and controllers for good."""
    return YARD[number - 1] if 1 <= number <= len(YARD) else OWN[number % len(OWN)]
