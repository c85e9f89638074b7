"""Mistakes in hump files: refused, or warned of.

Mistakes that people make in hump files: all of one file are told at once, each once, with its line and a remedy.
What `hump check` tells besides faults: what is likely a mistake, and where everything stands.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest

from plant_models.errors import PlantError
from plant_models.library.hump_entry import HumpEntry, load_hump
from plant_models.library.library import BUILT_IN, HUMPS
from synth.frame.faults import InputError
from synth.hump.checked_hump import checked_hump
from synth.hump.configuration.trial_file import trial_text
from synth.hump.design_runners import places_of, rolled_routes
from synth.hump.hump_file import hump_text, parse_hump, read_hump
from synth.hump.making.short_file import read_short_hump
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


GRADE = re.compile(r"(grade_permille = )(\{ value = )?(\[\[[^\]]*\](?:, \[[^\]]*\])*\]|-?[\d.]+)")
PAIR = re.compile(r"(\[[-\d.]+, )(-?[\d.]+)\]")


def scaled(factor: float) -> Callable[[str], str]:
    """A file with all its grades times `factor`."""

    def grades(found: re.Match[str]) -> str:
        value = found[3]
        if value.startswith("["):
            value = PAIR.sub(lambda pair: f"{pair[1]}{float(pair[2]) * factor}]", value)
        else:
            value = str(float(value) * factor)
        return f"{found[1]}{found[2] or ''}{value}"

    return lambda text: GRADE.sub(grades, text)


def swapped(old: str, new: str) -> Callable[[str], str]:
    """A file with `new` in place of `old`."""
    return lambda text: text.replace(old, new)


FIRST = "length_m = 42.0\ngrade_permille = [[0.0, 45.0], [40.0, 22.0]]"
TRACK = "length_m = 632.0, grade_permille = [[0.0, 0.8], [432.0, 0.0]]"
RNZ = 'position = "rnz-2m-park"'
WARNED: list[tuple[Callable[[str], str], str, str]] = [
    (swapped(FIRST, "length_m = 42.0\ngrade_permille = 10"), "first-fall", "to switch 1 the track falls 0.42 m"),
    (swapped(FIRST, "length_m = 30.0\ngrade_permille = 45"), "first-switch", "switch 1 begins 24 m behind the"),
    (swapped("[26.0, 8.0]]", "[26.0, -40.0]]"), "rise", "rises by 0.48 m from 138 m to 150 m, ahead of its last"),
    (scaled(0.4), "height", "the bad runner (22 t, 4 N/kN, head wind 2 m/s), let go at 1.7 m/s and not braked, stands"),
    (scaled(0.1), "grades", "is 4.5 permille; if the file has its grades in per cent, multiply them by 10"),
    (swapped("= [[0.0, 8.0], [28", "= [[0.0, 3.0], [28"), "position-grade", "under retarders 411 to 414 is 3 permille"),
    (swapped(RNZ, 'position = "mine"\nzones_m = [[0, 9]]'), "position", "the position 'mine' of retarders 421 to"),
    (swapped(RNZ, f"{RNZ}\nzones_m = [[0, 9]]"), "zones", "retarders 421 to 436 are 9 m long; hump simulate brakes"),
    (swapped(TRACK, "length_m = 6.0, grade_permille = 0.8"), "short-track",
     "on tracks 1 to 16 6 m are free; a cut of 8 cars, the most of a usual train, has 111 m"),
    (lambda text: re.sub(r'track = (\d+) \}', r"track = \1, standing_m = 5 }", text), "no-effect",
     "type.track.standing_m has no effect: every row that names the type has its own"),
]  # fmt: skip
"""How the library's hump `medium` is changed, of what that warns, and words of the sentence."""


def medium(change: Callable[[str], str]) -> HumpEntry:
    text = BUILT_IN.file(HUMPS, "medium").text
    changed = change(text)
    assert changed != text
    return parse_hump(changed, "my", "my.toml")


@pytest.mark.parametrize(("change", "about", "words"), WARNED)
def test_a_likely_mistake_is_told_and_nothing_else(change: Callable[[str], str], about: str, words: str) -> None:
    found = [warning for warning in checked_hump(medium(change)).warnings if warning.about == about]
    assert len(found) == 1
    assert words in found[0].sentence


@pytest.mark.parametrize(
    ("factor", "words"),
    [
        (1e-3, "cuts stand before switch 4: .* if the file has its grades in fractions, multiply them by 1000"),
        (-1.0, "cuts stand before switch 1: .* 5 m behind the crest .* a grade is positive where the track falls"),
    ],
)
def test_a_hump_over_which_no_car_rolls_is_refused_with_the_remedy(factor: float, words: str) -> None:
    with pytest.raises(PlantError, match=words):
        checked_hump(medium(scaled(factor)))


def test_the_humps_of_the_library_are_warned_of_nothing_but_a_near_switch() -> None:
    for name, about in (("large", []), ("large-two-leads", []), ("medium", []), ("dumper", ["first-switch"])):
        assert [warning.about for warning in checked_hump(load_hump(name)).warnings] == about


def test_places_are_those_of_the_routes() -> None:
    graph = load_hump("medium").graph
    places = places_of(rolled_routes(graph))
    assert [(place.kind, place.numbers, place.at_m) for place in places] == [
        ("switch", (1,), 42.0),
        ("retarder", (401, 402), 68.0),
        ("switch", (2, 3), 112.0),
        ("retarder", tuple(range(411, 415)), 150.0),
        ("switch", tuple(range(4, 8)), 184.0),
        ("switch", tuple(range(8, 16)), 214.0),
        ("retarder", tuple(range(421, 437)), 284.0),
        ("track", tuple(range(1, 17)), 306.0),
    ]
    route = graph.route(201, 1)
    for place, element in zip(places, route.elements[1:], strict=True):
        assert (place.at_m, place.from_m, place.to_m) == pytest.approx((element.at_m, element.from_m, element.to_m))
        assert place.fall_m == pytest.approx(float(route.roll_track.fall_m(element.at_m)))  # type: ignore[arg-type]  # one place
        assert place.good_m_s is not None
        assert place.bad_m_s is not None
        free_m_s = (1.7**2 + 2.0 * 9.81 * place.fall_m) ** 0.5  # without any resistance
        assert place.bad_m_s < place.good_m_s < free_m_s


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[trains]\nnumber = 5\n", "this is a hump trial, not a hump file; use 'retarder-synth hump simulate"),
        ('hump = "large"\n', "this is a hump trial, not a hump file"),
        (
            "tracks = 4\nswitches_m = [40, 80]\n",
            "this is a short hump file, not a hump file; use 'retarder-synth hump make",
        ),
        ("a = 1\n", 'key format is missing; a hump file has format = "hump"'),
    ],
)
def test_a_file_of_another_kind_is_called_by_its_name(tmp_path: Path, text: str, words: str) -> None:
    file = tmp_path / "x.toml"
    file.write_text(text)
    with pytest.raises(InputError, match=re.escape(words)) as caught:
        read_hump(file)
    assert len(caught.value.sentences) == 1
    with pytest.raises(InputError, match="this is a hump file, not a short hump file; use 'retarder-synth hump check"):
        read_short_hump(hump_text(Path("medium")), "x.toml")


def test_a_trial_that_is_a_short_hump_file_is_told_which_command_reads_it(tmp_path: Path) -> None:
    (tmp_path / "short.toml").write_text("tracks = 2\nswitches_m = [40]\n", encoding="utf-8")
    with pytest.raises(InputError, match="this is a short hump file, not a hump trial; use 'retarder-synth hump make"):
        trial_text(tmp_path / "short.toml")
