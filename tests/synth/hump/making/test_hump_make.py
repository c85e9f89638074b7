"""`hump make` for humps of the library and for random ones.

Random short hump files: most can be made, some break one rule or another.
`hump make`: the short file of a hump of the library gives that hump; any other is refused in sentences or made.
"""

from __future__ import annotations

import json
import random
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pytest

from plant_models.hump import Retarder, Route
from plant_models.library.hump_entry import load_hump
from synth.cli import main
from synth.frame.faults import InputError
from synth.hump.checked_hump import checked_hump
from synth.hump.hump_file import parse_hump
from synth.hump.making.hump_plan import Fork, Tree, levels_needed, track_tree
from synth.hump.making.make_command import hump_toml
from synth.hump.making.short_file import example_short_toml, read_short_hump
from synth.hump.making.short_hump import EXAMPLE
from synth.hump.rolling.hump_routes import Mark
from synth.hump.trains.train_passages import train_passages
from tests.effort import sized
from tests.synth.hump.trains.made_trials import Day

TYPES = ("knp-5-bunch", "rnz-2m-park", "t-50-bunch", "vzpg-5-bunch", "kv-3-bunch")
SPARE = {
    "throw_s": (0.3, 1.2),
    "section_ahead_m": (0.0, 9.0),
    "section_behind_m": (0.1, 9.0),
    "turn_deg": (0.0, 8.0),
    "fouling_m": (10.0, 60.0),
}


@dataclass
class Drawing:
    """A short file that is drawn from the crest on."""

    rng: random.Random
    at_m: float = 0.0
    switches: list[float] = field(default_factory=list)
    positions: list[str] = field(default_factory=list)

    def switch(self) -> None:
        self.switches.append(round(self.at_m, 2))
        self.at_m += self.rng.uniform(12.0, 45.0)

    def position(self) -> None:
        length = self.rng.uniform(8.0, 30.0)
        end = f"to_m = {self.at_m + length:.1f}\n" if self.rng.random() < 0.5 else ""
        self.positions.append(f'[[position]]\ntype = "{self.rng.choice(TYPES)}"\nfrom_m = {self.at_m:.1f}\n{end}')
        self.at_m += self.rng.uniform(30.0, 60.0)

    def profile(self) -> list[list[float]]:
        """Steep at the crest, flat behind; sometimes of a wrong sign, or not from the crest on."""
        steep = self.rng.choice((30.0, 5.0, -20.0)) if self.rng.random() < 0.2 else 42.0
        begin, pieces = 3.0 if self.rng.random() < 0.05 else 0.0, []
        while begin < self.at_m:
            grade = steep * (1.0 - begin / self.at_m) ** 2 + self.rng.uniform(-1.0, 2.0)
            pieces.append([round(begin, 1), round(grade, 1)])
            begin += self.rng.uniform(5.0, 60.0)
        return [*pieces, [round(begin, 1), self.rng.choice((1.5, 0.8, 0.0, -1.0))]]


def random_short(seed: int) -> str:
    """The text of one."""
    rng = random.Random(seed)
    bunches = [rng.randint(1, 5) for _ in range(rng.randint(1, 3))]
    levels = (len(bunches) - 1).bit_length() + max((bunch - 1).bit_length() for bunch in bunches)
    levels += rng.choice((-1, 1)) if rng.random() < 0.05 else 0
    drawing = Drawing(rng, rng.uniform(20.0, 50.0))
    steps = [drawing.switch] * max(levels, 0) + [drawing.position] * rng.choice((0, 1, 1, 2, 2, 3))
    rng.shuffle(steps)
    for step in steps:
        step()
    lines = [f"tracks = {bunches[0]}" if len(bunches) == 1 else f"bunches = {bunches}"]
    if len(bunches) > 1 and rng.random() < 0.1:
        lines.append(f"tracks = {sum(bunches) + rng.randint(0, 1)}")
    lines += [f"switches_m = {drawing.switches}", f"profile_from_crest = {drawing.profile()}"]
    lines += [f"tracks_from_m = {drawing.at_m + rng.uniform(-5.0, 80.0):.1f}"]
    lines += [f"track_length_m = {rng.choice((20.0, 250.0, 600.0)) + rng.uniform(0.0, 300.0):.1f}"]
    lines += [f"{key} = {rng.uniform(*ends):.2f}" for key, ends in SPARE.items() if rng.random() < 0.2]
    lines += ["parallel_tracks = false"] if rng.random() < 0.2 else []
    return "\n".join((*lines, *drawing.positions)) + "\n"


SHORT = """\
bunches = [5, 6, 5]
profile_from_crest = [[0, 42], [32, 24], [58, 11], [92, 9], [130, 7], [170, 1.5], [290, 1.0]]
switches_m = [44, 100, 176, 206, 240]
throw_s = 0.8
tracks_from_m = 310
track_length_m = 600
[[position]]
type = "knp-5-bunch"
from_m = 60
to_m = 86
[[position]]
type = "knp-5-bunch"
from_m = 136
"""


def turned_deg(route: Route) -> float:
    return sum(bend.turn_deg for bend in route.roll_track.bends)


def test_the_short_file_of_medium_gives_medium() -> None:
    short = read_short_hump(example_short_toml(), "medium.toml")
    assert short == EXAMPLE
    made, known = parse_hump(hump_toml(short, "medium.toml"), "made", "made.toml"), load_hump("medium")
    assert made.graph.tracks == known.graph.tracks
    for track in known.graph.tracks:
        ours, theirs = made.graph.route(201, track), known.graph.route(201, track)
        assert [(e.number, e.at_m, e.position) for e in ours.elements] == [
            (e.number, e.at_m, e.position) for e in theirs.elements
        ]
        assert ours.roll_track.profile == theirs.roll_track.profile
        assert turned_deg(ours) == pytest.approx(turned_deg(theirs))
        assert ours.length_m == theirs.length_m
        assert ours.yard_from_m == pytest.approx(theirs.yard_from_m)
    throw = next(value for value in made.provenance if value.key == "type.turnout.throw_s")
    assert throw.assumed  # the tool's own number, though the short file repeats it


def test_unequal_bunches_part_first_and_no_way_is_longer_than_it_must_be() -> None:
    hump = parse_hump(hump_toml(read_short_hump(SHORT, "s.toml"), "s.toml"), "s", "s.toml")
    routes = hump.graph.routes(201)
    assert {tuple(route.positions)[:1] for route in routes.values()} == {(1,)}
    bunch = {track: route.code[: 2 if track <= 11 else 1] for track, route in routes.items()}
    assert [bunch[track] for track in range(1, 17)] == ["00"] * 5 + ["01"] * 6 + ["1"] * 5
    places = {element.at_m for route in routes.values() for element in route.elements if element.position is not None}
    assert places == {44.0, 100.0, 176.0, 206.0, 240.0}
    of_position = [e.number for e in routes[16].elements if isinstance(e.vertex, Retarder)]
    assert of_position == [402, 413]


def leaves(tree: Tree, level: int) -> Iterator[int]:
    """Tracks from the left; levels must increase."""
    if isinstance(tree, Fork):
        assert tree.level >= level
        yield from leaves(tree.left, tree.level + 1)
        yield from leaves(tree.right, tree.level + 1)
    else:
        yield tree.track


@pytest.mark.parametrize("bunches", [[1], [2], [16], [5, 6, 5], [1, 9], [3] * 7, [199]])
def test_tracks_stand_in_order_behind_as_few_switches_as_may_be(bunches: list[int]) -> None:
    assert list(leaves(track_tree(bunches), 0)) == list(range(1, sum(bunches) + 1))
    assert 2 ** levels_needed([sum(bunches)]) < 2 * max(sum(bunches), 1)


def test_all_faults_of_a_short_file_are_told_at_once() -> None:
    wrong = (
        SHORT.replace("bunches = [5, 6, 5]", "tracks = 17\nbunches = [5, 6, 5]")
        .replace("44, 100, 176, 206, 240", "44, 100, 176, 206")
        .replace("[[0, 42], [32, 24]", "[[4, 42], [32, 84]")
        .replace("throw_s = 0.8", "throw_s = 0,8\nrelay = 0.1\nfouling_m = 400")
        .replace("from_m = 60\nto_m = 86", "from_m = 60\nto_m = 102")
    )
    with pytest.raises(InputError) as caught:
        read_short_hump(wrong, "s.toml")
    for words in (
        "s.toml, line 5: 0,8 is no number of TOML; write 0.8",
        "s.toml: relay = 0.1 is an unknown key; did you mean relay_s?",
        "s.toml: fouling_m is 400; it must be from 0.1 to 300",
        "s.toml: tracks is 17; the bunches have 16 tracks together: correct one of the two",
        "s.toml: switches_m has 4 places; bunches of [5, 6, 5] tracks need 5",
        "s.toml: profile_from_crest: the first begins at 4 m; it must begin at 0",
        "s.toml: profile_from_crest: a grade is 84.0; it must be a finite number from -60 to 60",
        "s.toml: position[0]: its section ends at 103 m, and that of the switch at 100 m begins at 94 m",
    ):
        assert sum(words in sentence for sentence in caught.value.sentences) == 1, words
    assert len(caught.value.sentences) == 8


def test_a_random_short_file_is_refused_in_sentences_or_made_without_fault() -> None:
    told: list[str] = []
    refused, made = 0, 0
    for seed in range(sized(60, 3000)):
        text = random_short(seed)
        try:
            short = read_short_hump(text, "s.toml")
        except InputError as fault:
            told += fault.sentences
            refused += 1
            continue
        hump = parse_hump(hump_toml(short, "s.toml"), "hump", "hump.toml")
        assert hump.graph.tracks == tuple(range(1, sum(short.of_bunches) + 1))
        profile = dict(tomllib.loads(text)["profile_from_crest"])
        assert set(hump.graph.route(201, 1).roll_track.profile.grades_permille) <= set(profile.values())
        made += 1
    assert min(refused, made) > 0.1 * (refused + made)
    assert all(sentence.startswith("s.toml: ") and sentence.isprintable() for sentence in told)


SMALL = """\
tracks = 2
profile_from_crest = [[0, 42], [32, 24], [58, 11], [80, 1.5]]
switches_m = [44]
tracks_from_m = 100
track_length_m = 300
[[position]]
type = "rnz-2m-park"
from_m = 80
[output]
report = false
"""


def test_a_made_hump_is_checked_and_trains_run_over_it(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    short = tmp_path / "my.toml"
    short.write_text(SMALL)
    assert main(["hump", "make", str(short), "-o", str(tmp_path / "out"), "--json"]) == 0
    summary = json.loads(capsys.readouterr().out)
    assert summary["figures"]["tracks"] == 2
    assert {"hump.toml", "plots/plan-and-profile.svg"} <= summary["files"].keys()
    hump = tmp_path / "out" / "hump.toml"
    assert main(["hump", "check", str(hump)]) == 0
    assert "to position 1 2.21 m" in capsys.readouterr().out
    trial = tmp_path / "trial.toml"
    trial.write_text(
        f'hump = "{hump.relative_to(tmp_path)}"\n[trains]\nnumber = 2\ncuts = 8\n[aim]\ndesign_cuts = 200\n'
        "[acceptance]\ncatch_ups = 1\noverspeed = 1\n[output]\nplots = false\nreport = false\n"
    )
    assert main(["hump", "simulate", str(trial), "-o", str(tmp_path / "sim"), "--json"]) == 0


def test_what_a_made_hump_warns_of_is_what_check_warns_of() -> None:
    hump = parse_hump(hump_toml(EXAMPLE, "s.toml"), "hump", "hump.toml")
    assert checked_hump(hump).warnings == ()


FLAT = """\
bunches = [3, 1]
profile_from_crest = [[0, 6.3], [40, 3], [130, 1], [300, -1]]
switches_m = [25, 49, 190]
tracks_from_m = 307
track_length_m = 285
[[position]]
type = "knp-5-bunch"
from_m = 94
"""


def test_a_long_cut_that_goes_astray_while_it_is_pushed_passes_all_joints_of_its_new_way() -> None:
    graph = parse_hump(hump_toml(read_short_hump(FLAT, "s.toml"), "s.toml"), "hump", "hump.toml").graph
    trial = Day(cuts=10, cars_mean=8.0, most_cars=12, constant_m_s=1.3).on(graph)
    trains, _, memory = trial.humped(0, 16)
    lane, cut = np.nonzero(memory.misrouted_at < memory.time_s.shape[2])
    came_s = memory.time_s[lane, cut, memory.misrouted_at[lane, cut], Mark.FIRST_IN]
    assert (came_s < memory.crest_s[lane, cut]).sum() > 10
    for number in range(16):
        for way in train_passages(trial.routes, trains, memory, number).ways:
            came = [passage.in_s[0] for passage in way]
            assert came == sorted(came)
