"""Names that fit into controller code."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tuning_tables.category_names import category_macros, comment_text
from tuning_tables.category_number import KNOWN_NUMBERS


def test_the_categories_of_the_field() -> None:
    assert category_macros(KNOWN_NUMBERS) == ("L", "LS", "S", "ST", "T")


@pytest.mark.parametrize(
    ("categories", "names"),
    [
        ({"light": 16, "Heavy 2": 17}, ("LIGHT", "HEAVY_2")),
        ({"Т": 5, "T": 16}, ("T", "T_16")),
        ({"T": 16, "Т": 5}, ("T_16", "T")),
        ({"??": 16, "x": 17, "!": 18}, ("16", "X", "18")),
        ({"a": 16, "A": 17, "a_16": 18}, ("A_16", "A_17", "A_16_18")),
        ({"": 16, "16": 17}, ("16", "16_17")),
        ({"__a -- b__": 16}, ("A_B",)),
        ({"Щит": 16}, ("SHHIT",)),
        ({"x" * 40: 16}, ("X" * 8,)),
    ],
)
def test_names_differ_and_are_plain(categories: dict[str, int], names: tuple[str, ...]) -> None:
    assert category_macros(categories) == names


@given(st.lists(st.text(st.sampled_from("aAАтТ126_ -?"), max_size=5), unique=True, max_size=12))
def test_names_always_differ(categories: list[str]) -> None:
    names = category_macros({**KNOWN_NUMBERS, **{name: 16 + place for place, name in enumerate(categories)}})
    assert len(set(names)) == len({*KNOWN_NUMBERS, *categories})
    assert names[:5] == ("L", "LS", "S", "ST", "T")
    assert all(re.fullmatch(r"[A-Z0-9]+(_[A-Z0-9]+)*", name) for name in names)


def test_comments_show_what_they_cannot_hold() -> None:
    assert comment_text("gondola-4 22 t, (a+b).c_d") == "gondola-4 22 t, (a+b).c_d"
    assert comment_text("Л*/\n😀") == "<U+041B><U+002A><U+002F><U+000A><U+1F600>"
    assert comment_text("RETARDER_LOAD retarder_ _") == "RETARDER<U+005F>LOAD retarder<U+005F> _"


@given(st.text())
def test_no_comment_ends_early(text: str) -> None:
    shown = comment_text(text)
    assert shown.isascii()
    assert not set("*/\\?\n\r{}'\"$") & set(shown)
