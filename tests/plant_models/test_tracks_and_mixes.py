"""Tracks and car mixes of the library: they load, say where each number is from, and refuse faults."""

from __future__ import annotations

import re

import numpy as np
import pytest

from plant_models import PlantError
from plant_models.library import BUILT_IN, CAR_MIXES, TRACKS, Kind, TypeFile, load_car, load_position, load_track
from plant_models.library.car_entry import car_mix_from, load_car_mix
from plant_models.library.track_entry import track_from

TRACK = BUILT_IN.file(TRACKS, "large-hump").text
MIX = BUILT_IN.file(CAR_MIXES, "usual").text


def bad(kind: Kind, text: str) -> TypeFile:
    """A file of the library with this text."""
    return TypeFile(kind, "bad", text, f"{kind.folder}/bad.toml")


@pytest.mark.parametrize("name", BUILT_IN.names(TRACKS))
def test_every_number_of_a_track_has_an_origin_and_its_position_is_there(name: str) -> None:
    entry = load_track(name)
    assert all(v.source and v.confidence and v.range is not None and v.in_range for v in entry.provenance)
    assert any(v.assumed for v in entry.provenance)
    zone = load_position(entry.position).position.zones_m
    assert zone[-1][1] <= entry.exit_m - entry.entrance_m  # the retarders fit between entrance and exit
    assert entry.stretch_m[0] < entry.stretch_m[1] <= entry.entrance_m < entry.exit_m < entry.track.end_m


def test_the_large_hump_keeps_the_rules_that_it_was_made_by() -> None:
    track = load_track("large-hump").track
    assert sum(bend.switches for bend in track.bends) == 5
    first = track.bends[0].from_m
    assert first >= 30.0  # from the crest to the first dividing switch at least 30 m
    # 3.7 m of fall to the park position: elements times grades, by hand
    by_hand = (40 * 45 + 26 * 22 + 32 * 12 + 40 * 10 + 40 * 8 + 138 * 1.5) / 1000
    assert track.fall_m(np.array([316.0]))[0] == pytest.approx(by_hand, abs=1e-12)
    assert by_hand == pytest.approx(3.68, abs=0.01)
    # head of all switches and curves at 5 m/s by 0.56 a switch and 0.23 a degree
    turned = sum(bend.turn_deg for bend in track.bends)
    assert (0.56 * 5 + 0.23 * turned) * 25e-3 == pytest.approx(0.28, abs=0.01)


def test_every_number_of_a_mix_has_an_origin_those_of_its_cars_too() -> None:
    entry = load_car_mix("usual")
    assert all(v.source and v.confidence and v.range is not None and v.in_range for v in entry.provenance)
    keys = {v.key for v in entry.provenance}
    assert {"cars.gondola-4.share", "cars.gondola-4.length_m", "cars.tank-4.gross_t", "following_share"} <= keys
    assert sum(car.share for car in entry.mix.cars) == pytest.approx(1.0)
    gondola = next(car for car in entry.mix.cars if car.car.name == "gondola-4")
    assert gondola.drag_area_m2 == pytest.approx(8.5 * 1.36)
    assert gondola.car == load_car("gondola-4").car


def test_values_of_the_user_replace_those_of_a_track_and_keep_the_origin_of_the_others() -> None:
    entry = load_track("large-hump")
    changed = entry.with_values({"position.exit_m": 340.0, "stretch.speed_mean_m_s": 4.5})
    origins = {v.key: v.source for v in changed.provenance}
    assert changed.exit_m == 340.0
    assert origins["position.exit_m"] == "configuration"
    same = {v.key: v.source for v in entry.provenance}
    assert {key for key in origins if origins[key] != same[key]} == {"position.exit_m"}
    assert entry.without_bends().track.bends == ()
    assert not any(v.key.startswith("bends") for v in entry.without_bends().provenance)


FAULTS = {
    "gap in a list": (TRACKS, TRACK, r"switches = { value = \[1, 1, 1, 1, 1, 0\]", "switches = { value = [1, 1]",
                      "bends.zones_m has 6 entries, bends.switches 2 and bends.turn_deg 6"),
    "half a switch": (TRACKS, TRACK, r"value = \[1, 1, 1, 1, 1, 0\]", "value = [0.5, 1, 1, 1, 1, 0]",
                      "bends.switches holds 0.5; it must be whole numbers"),
    "absurd grade": (TRACKS, TRACK, r"\[0.0, 45.0\]", "[0.0, 450.0]", "outside its own range"),
    "not from the crest": (TRACKS, TRACK, r"\[\[0.0, 45.0\]", "[[5.0, 45.0]",
                           "track.grade_permille: starts_m is .* must begin with 0"),
    "end too near": (TRACKS, TRACK, r"end_m = { value = 970.0", "end_m = { value = 700.0",
                     "the last element begins at 770 m; it must begin before the end, 700 m"),
    "no position": (TRACKS, TRACK, r"park_position = .*", "", "key park_position is missing"),
    "unknown key": (TRACKS, TRACK, r"\nexit_m", "\nexit", "unknown key position.exit; did you mean position.exit_m"),
    "no cars": (CAR_MIXES, MIX, r"(?s)\[cars.gondola-4\].*", "", "cars is None; it must be a table with one table"),
    "unknown car": (CAR_MIXES, MIX, r"gondola-4", "gondola-5", "cars.gondola-5: car 'gondola-5' is not in the library"),
    "no share": (CAR_MIXES, MIX, r"share = { value = 0.45.*", "", "key cars.gondola-4.share is missing"),
    "share of the lee": (CAR_MIXES, MIX, r"following_share = { value = 0.25, range = \[0.15, 0.4\]",
                         "following_share = { value = 2.0, range = [0, 3]", "following_share is 2.0; it must be"),
}  # fmt: skip


@pytest.mark.parametrize("name", FAULTS)
def test_a_faulty_file_is_told_in_one_sentence_with_file_and_key(name: str) -> None:
    kind, text, old, new, said = FAULTS[name]
    faulty = re.sub(old, new, text, count=1)
    assert faulty != text
    with pytest.raises(PlantError) as caught:
        track_from(bad(kind, faulty)) if kind == TRACKS else car_mix_from(bad(kind, faulty), BUILT_IN)
    assert re.match(rf"{kind.folder}/bad.toml(, line \d+)?: ", str(caught.value))
    assert re.search(said, str(caught.value)), caught.value
