"""Names that fit into controller code."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tuning_tables.category_names import category_macros, comment_text


def test_the_categories_of_the_field():
    assert category_macros(["Л", "ЛС", "С", "СТ", "Т"]) == ("L", "LS", "S", "ST", "T")


@pytest.mark.parametrize(
    ("categories", "names"),
    [
        (["light", "Heavy 2"], ("LIGHT", "HEAVY_2")),
        (["Т", "T"], ("T_1", "T_2")),
        (["??", "x", "!"], ("1", "X", "3")),
        (["a", "A", "a_1"], ("A_1", "A_2", "A_1_3")),
        (["", "1"], ("1", "1_2")),
        (["__a -- b__"], ("A_B",)),
        (["Щит"], ("SHHIT",)),
        (["x" * 40], ("X" * 16,)),
    ],
)
def test_names_differ_and_are_plain(categories, names):
    assert category_macros(categories) == names


@given(st.lists(st.text(st.sampled_from("aAАтТ1_2 -?"), max_size=5), unique=True, max_size=12))
def test_names_always_differ(categories):
    names = category_macros(categories)
    assert len(set(names)) == len(categories)
    assert all(re.fullmatch(r"[A-Z0-9]+(_[A-Z0-9]+)*", name) for name in names)


def test_comments_show_what_they_cannot_hold():
    assert comment_text("gondola-4 22 t, (a+b).c_d") == "gondola-4 22 t, (a+b).c_d"
    assert comment_text("Л*/\n😀") == "<U+041B><U+002A><U+002F><U+000A><U+1F600>"


@given(st.text())
def test_no_comment_ends_early(text):
    shown = comment_text(text)
    assert shown.isascii()
    assert not set("*/\\?\n\r{}'\"$") & set(shown)
