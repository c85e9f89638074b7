"""Mistakes that people make in hump files: all of one file are told at once, each once, with its line and a remedy."""

from __future__ import annotations

import pytest

from plant_models.library.library import BUILT_IN
from plant_models.library.type_file import HUMPS
from synth.frame.input_error import InputError
from synth.hump.hump_file import parse_hump
from tests.effort import every

SWITCH, PARK, LAST, LADDER = 'type = "symmetric"', 'type = "park"', 'type = "last"', 'type = "ladder-1"'

MISTAKES = [
    ("notes = [", "note = [", "unknown key note; did you mean notes?"),
    (
        "relay_s = { value = 0.2,",
        "relay_s = { value = 0,2,",
        "0,2 is no number of TOML; write 0.2, with a decimal point",
    ),
    ('number = 421, type = "park", next', 'number = 421, type = "park" next', "a comma is missing before 'next = { to"),
    ('position = "rnz-2m-park"', "position = rnz-2m-park", 'words need quotes: write "rnz-2m-park"'),
    ("entry_joint_m = 2.0", "entry_joint_m = 2.", "nothing stands behind the decimal point; write .0"),
    (
        f"left = {{ to = 14, {LADDER}",
        f"left = {{ to = 14, {LADDER}, grade_permille = 80",
        "switch 7: left: grade_permille: a grade is 80.0; it must be a finite number from -60 to 60",
    ),
    (
        "next = { to = 5 }",
        "next = { to = 5, grade_permille = [[4, 8]] }",
        "the first begins at 4 m; it must begin at 0",
    ),
    (
        "next = { to = 6 }",
        "next = { to = 6, grade_permille = [[0, 8], [20, 5], [9, 3]] }",
        "the one from 20 m ends at 9 m",
    ),
    (
        "next = { to = 7 }",
        "next = { to = 7, length_m = -34 }",
        "length_m is -34.0; it must be a finite number from 0.1",
    ),
    (
        f"number = 425, {PARK}",
        f"number = 425, {PARK}, exit_speed_m_s = 4.8",
        "unknown key exit_speed_m_s; a hump file holds no exit speeds; the configuration of a trial does",
    ),
    (f"number = 426, {PARK}, next", f"number = 426, {PARK}, nxt", "retarder 426: unknown key nxt; did you mean next?"),
    (
        f"number = 427, {PARK}",
        f"number = 427, {PARK}, position = 'mein-retarder'",
        "'mein-retarder' is not in the library",
    ),
    (
        f"number = 428, {PARK}",
        f"number = 428, {PARK}, position = 'knp-5-bunch', exit_joint_m = 25",
        "position knp-5-bunch is 26.95 m long; give 26.95 or more, or the zones_m of a position of your own",
    ),
    (
        f"number = 432, {PARK}",
        f"number = 432, {PARK}, axle_counters = 'yes'",
        "axle_counters is 'yes'; it must be true",
    ),
    (
        f"{LAST}, curves = [[24, 54, -9.46]] }}, right = {{ to = 430",
        f"{LAST}, curves = [[2, 54, -9.46]] }}, right = {{ to = 430",
        "switch 12: a curve begins 2 m behind the points; it must begin behind the exit joint, 5 m",
    ),
    (
        f"left = {{ to = 431, {LAST}",
        f"left = {{ to = 431, {LAST}, radars_m = [[70, 20]]",
        "radars_m: to_m is 20; it must be",
    ),
    (
        "number = 601, type",
        'number = 601, name = "The track of the East by the pond", type',
        "section 601: name is 'The track of the East by the pond'; it must be a non-empty string of at most 24",
    ),
    ("track = 6 }", "track = 0 }", "section 606: track is 0; it must be a finite number from 1 to 199"),
    (
        "track = 11 }",
        "track = 11, standing_m = '20' }",
        "section 611: standing_m is '20'; it must be a number in m, or in quotes",
    ),
    (
        "track = 14 }",
        "track = 14, length_m = 600, next = { to = 1 } }",
        "the way from it comes back to it (1 → 402 → 3",
    ),
]
"""What is changed into what in the library's hump `medium`, and words of the sentence that tells it."""


def told(text: str) -> tuple[str, ...]:
    """The sentences that refuse a hump file."""
    with pytest.raises(InputError) as caught:
        parse_hump(text, "my", "my.toml")
    return caught.value.sentences


def test_all_mistakes_of_a_file_are_told_at_once_each_once_with_its_line() -> None:
    text = BUILT_IN.file(HUMPS, "medium").text
    for old, new, _ in MISTAKES:
        assert text.count(old) == 1, old
        text = text.replace(old, new)
    sentences = told(text)
    for _, _, words in MISTAKES:
        assert sum(words in sentence for sentence in sentences) == 1, words
    assert len(sentences) == len(MISTAKES)
    assert all(sentence.startswith("my.toml, line ") for sentence in sentences)


@pytest.mark.parametrize(("old", "new", "words"), every(4, MISTAKES))
def test_a_mistake_alone_is_told_where_it_stands(old: str, new: str, words: str) -> None:
    text = BUILT_IN.file(HUMPS, "medium").text.replace(old, new)
    (sentence,) = told(text)
    assert words in sentence
    line = text.splitlines()[int(sentence.split("line ")[1].split(":")[0]) - 1]
    assert any(part in line for part in new.splitlines()) or "comes back" in words
