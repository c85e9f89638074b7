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
    ("version = 1", "version = 2", "version is 2; this program reads hump files of version 1"),
    ("notes = [", "note = [", "unknown key note; did you mean notes?"),
    ('confidence = "L"\n\n# What', 'confidence = "low"\n\n# What', "confidence is 'low'; it must be one of H, M-H"),
    ("[type.speed]", "[type.spare]\nthrow_s = 0.6\n[type.speed]", "no element names the type spare; take it out"),
    (
        "relay_s = { value = 0.2,",
        "relay_s = { value = 0,2,",
        "0,2 is no number of TOML; write 0.2, with a decimal point",
    ),
    ('number = 421, type = "park", next', 'number = 421, type = "park" next', "a comma is missing before 'next = { to"),
    ('position = "rnz-2m-park"', "position = rnz-2m-park", 'words need quotes: write "rnz-2m-park"'),
    ("entry_joint_m = 2.0", "entry_joint_m = 2.", "nothing stands behind the decimal point; write .0"),
    ("leads = [201]", "leads = [201, 203]", "leads: there is no signal 203; add it, or take it from the list"),
    (f"number = 15, {SWITCH}", f"number = 215, {SWITCH}", "switch 215: the number is not in its group; give a switch"),
    ("left = { to = 421", "left = { to = 521", "switch 8: an edge leads to 521, but there is no such element; add it"),
    (
        f"right = {{ to = 424, {LAST} }}",
        f"right = {{ to = 423, {LAST} }}",
        "switch 9: both branches lead to retarder 423",
    ),
    (
        "next = { to = 4 }",
        "next = { to = 4, length_m = 30 }",
        "retarder 411: its insulated section ends 27.5 m behind it "
        "and that of switch 4 begins 6 m ahead of that one, but only 30 m lie between them; sections must not overlap",
    ),
    (
        f"number = 5, {SWITCH}",
        f"number = 5, {SWITCH}, throw_s = 600",
        "throw_s is 600.0; it must be a finite number from",
    ),
    (
        f"number = 6, {SWITCH}",
        'number = 6, type = "symetric"',
        "'symetric', which is no type of this file; did you mean",
    ),
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
    (f"number = 422, {PARK}", f"number = 422, {PARK}, exit_std_m_s = 1.5", "exit_std_m_s is 1.5; it must be a finite"),
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
        f"number = 430, {PARK}",
        f"number = 430, {PARK}, book = 'b.h5', exit_std_m_s = 0.2",
        "are both given; give the one that",
    ),
    (
        f"number = 432, {PARK}",
        f"number = 432, {PARK}, axle_counters = 'yes'",
        "axle_counters is 'yes'; it must be true",
    ),
    (
        f"{LAST}, curves = [[24, 54, -9.46]] }}, right = {{ to = 426",
        f"{LAST}, curves = [[24, 54]] }}, right = {{ to = 426",
        "switch 10: left: curves is [[24, 54]]; it must be a list of [from_m, to_m, turn_deg]",
    ),
    (
        f"left = {{ to = 427, {LAST}",
        f"left = {{ to = 427, {LAST}, fouling_m = 400",
        "fouling_m is 400.0; it must be a finite",
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
        f"left = {{ to = 433, {LAST}",
        f"left = {{ to = 433, {LAST}, turn_deg = 40",
        "turn_deg is 40.0; it must be a finite",
    ),
    (
        "number = 601, type",
        'number = 601, name = "The track of the East by the pond", type',
        "section 601: name is 'The track of the East by the pond'; it must be a non-empty string of at most 24",
    ),
    (
        'type = "track", track = 3 }',
        'type = "track" }',
        "section 603: track is missing; the last section of a track must",
    ),
    ("track = 5 }", "track = 5, standing_m = 700 }", "section 605: standing_m is 700; it must be at most the length"),
    ("track = 6 }", "track = 0 }", "section 606: track is 0; it must be a finite number from 1 to 199"),
    ("number = 608", "number = 607", "section[6] has the number 607, too; numbers must be unique"),
    ("track = 9 }", "track = 10 }", "track 10 ends here and in section 609; a track must end once"),
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
    assert any(part in line for part in new.splitlines()) or "track 10" in words or "comes back" in words
