"""A weight category has one colour."""

from __future__ import annotations

from itertools import pairwise

from matplotlib.colors import to_rgb

from plant_models.library.weight_category import OWN_NUMBERS, YARD_NUMBERS
from synth.frame.picture.house_style import graded
from synth.frame.picture.picture import OWN, YARD, category_colour


def test_the_categories_of_the_yard_are_dark_to_pale_in_grey_too() -> None:
    colours = [category_colour(number) for number in sorted(YARD_NUMBERS.values())]
    assert colours == list(YARD)
    grey = [0.299 * red + 0.587 * green + 0.114 * blue for red, green, blue in map(to_rgb, colours)]
    assert all(pale - dark > 0.08 for dark, pale in pairwise(grey))


def test_other_orders_have_other_colours() -> None:
    assert not {*YARD, *OWN} & {colour for count in range(1, 12) for colour in graded(count)}


def test_a_users_own_has_none_of_them() -> None:
    found = {category_colour(number) for number in OWN_NUMBERS}
    assert found == set(OWN)
    assert not found & set(YARD)
