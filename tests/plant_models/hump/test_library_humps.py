"""The humps of the library are sound, sourced and laid out by the rules; one profile gives the grades of all edges."""

from __future__ import annotations

import re
from collections.abc import Iterator

import pytest

from plant_models.hump import HumpGraph
from plant_models.library.hump_entry import hump_names, load_hump
from plant_models.library.library import BUILT_IN, HUMPS, TypeFileError
from plant_models.library.source import CITATION, sources
from plant_models.library.sourced_value import CONFIDENCES, JUDGEMENT
from tests.plant_models.hump.random_humps import SMALL, read


@pytest.mark.parametrize("name", hump_names())
def test_a_hump_of_the_library_is_sound_and_sourced(name: str) -> None:
    hump = load_hump(name)
    names = {source.name for source in sources()}
    for value in hump.provenance:
        assert value.confidence in CONFIDENCES, value.key
        assert value.source.startswith(JUDGEMENT) or CITATION.search(value.source), value.key
        assert set(CITATION.findall(value.source)) <= names, value.key
    for lead in hump.graph.leads:
        for route in hump.graph.routes(lead).values():
            turned = sum(turn_to_the_left(hump.graph, route.lead, route.track))
            assert turned == pytest.approx(0.0, abs=1e-9), route  # the tracks are parallel
            retarders = [e for e in route.elements if 400 < e.number < 600]
            assert all(0.0 < e.from_m < e.to_m for e in retarders)


def turn_to_the_left(graph: HumpGraph, lead: int, track: int) -> Iterator[float]:
    for element in graph.route(lead, track).elements:
        if element.position is not None:
            turn = (element.vertex.left, element.vertex.right)[element.position].turn_deg  # type: ignore[union-attr]  # a switch
            yield turn if element.position == 0 else -turn
        yield from (curve.turn_deg for curve in element.edge.curves)


@pytest.mark.parametrize(
    ("name", "tracks", "leads", "switches", "positions"),
    [("large", 32, 1, 5, 3), ("large-two-leads", 32, 2, 5, 3), ("medium", 16, 1, 4, 3), ("dumper", 8, 1, 3, 1)],
)
def test_the_humps_of_the_library(name: str, tracks: int, leads: int, switches: int, positions: int) -> None:
    graph = load_hump(name).graph
    assert (len(graph.tracks), len(graph.leads)) == (tracks, leads)
    for lead in graph.leads:
        routes = graph.routes(lead)
        assert list(routes) == list(range(1, tracks + 1))
        assert {len(route.positions) for route in routes.values()} == {switches}
        assert {sum(400 < e.number < 600 for e in route.elements) for route in routes.values()} == {positions}
        assert [int(route.code, 2) for route in routes.values()] == list(range(tracks))  # track 1 is the leftmost


def test_the_large_hump_keeps_the_rules_of_layout() -> None:
    """Distances of TB 10062-99 and the profile that the hump was drawn up with."""
    route = load_hump("large").graph.route(201, 1)
    places = {e.number: e.at_m for e in route.elements}
    assert places == {
        201: 0.0,
        1: 42.0,
        401: 68.0,
        2: 112.0,
        411: 150.0,
        4: 184.0,
        8: 214.0,
        16: 246.0,
        421: 316.0,
        601: 338.0,
    }
    assert 30.0 <= route.element(1).from_m <= 40.0  # from the crest to the first joint
    assert places[421] - route.fouling_m(16) >= 42.0
    assert places[421] - route.roll_track.bends[-1].to_m >= 14.0
    assert route.roll_track.profile.starts_m == (0.0, 40.0, 66.0, 98.0, 138.0, 178.0, 338.0, 770.0)
    assert route.roll_track.profile.grades_permille == (45.0, 22.0, 12.0, 10.0, 8.0, 1.5, 0.8, 0.0)


GRADES = re.compile(r"(?:, |\n)?grade_permille = (?:\{[^}]*\}|\[\[.*?\]\]|-?[\d.]+)")
PROFILE = "[[0,45],[40,22],[66,12],[98,10],[138,8],[178,1.5],[338,0.8],[770,0]]"


def with_profile(text: str, profile: str) -> str:
    """A hump file with one profile in place of the grades of its edges."""
    return GRADES.sub("", text).replace("[hump]\n", f"[hump]\nprofile_from_crest = {profile}\n")


@pytest.mark.parametrize("name", ["large", "large-two-leads"])
def test_one_profile_from_the_crest_gives_the_grades_of_all_edges(name: str) -> None:
    hump = read(with_profile(BUILT_IN.file(HUMPS, name).text, PROFILE))
    assert hump.graph == load_hump(name).graph
    (told,) = (value for value in hump.provenance if value.unit == "m, permille")
    assert told.key == "hump.profile_from_crest"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            SMALL.replace("[hump]\n", "[hump]\nprofile_from_crest = [[0, 45]]\n"),
            "line 12: type.turnout: left: grade_permille is given",
        ),
        (with_profile(SMALL, "[[4, 45]]"), "profile_from_crest: the first begins at 4 m; it must begin at 0"),
        (
            with_profile(SMALL, "45"),
            "profile_from_crest is 45; it must be a list of at least one pair of finite numbers",
        ),
        (
            with_profile(SMALL, "[[0, 45]]")
            .replace("leads = [201]", "leads = [201, 202]")
            .replace("signal = [", "signal = [{ number = 202, next = { to = 1, length_m = 44 } }, "),
            "switch 1: it lies 42 m from signal 201 and 44 m from signal 202",
        ),
    ],
)
def test_what_a_profile_may_not_be(text: str, words: str) -> None:
    with pytest.raises(TypeFileError) as caught:
        read(text)
    assert any(words in sentence for sentence in caught.value.sentences)
