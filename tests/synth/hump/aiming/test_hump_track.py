"""The track of a hump file is what an aim rolls its cuts on."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from plant_models.library import load_hump
from plant_models.library.hump_entry import hump_names
from synth.aim.configuration.aim_file import AimFile, parse_aim_file
from synth.frame.command import Asked
from synth.frame.faults import InputError
from synth.hump.aiming import hump_track, resolve
from synth.hump.options import AimOptions
from synth.hump.trial.table_aim import last_retarder


def asked(text: str, **options: Any) -> Asked[AimFile, AimOptions]:
    """What is typed, with a configuration."""
    return Asked(parse_aim_file(text, "aim.toml"), AimOptions(**options), "aim.toml", Path(), text)


@pytest.mark.parametrize("name", sorted(hump_names()))
def test_every_track_of_the_library_is_taken_over_as_it_is(name: str) -> None:
    hump = load_hump(name)
    for lead in hump.graph.leads:
        for route in hump.graph.routes(lead).values():
            found, last = hump_track(hump, route), last_retarder(route)
            assert found.track == route.roll_track
            assert (found.position, found.exit_m) == (last.position, route.yard_from_m)
            assert found.exit_m - found.entrance_m == pytest.approx(last.exit_m)
            assert 0.0 < found.stretch_m[0] < found.stretch_m[1] < found.entrance_m
            assert all(value.assumed for value in found.provenance if value.key != "stretch.speed_std_m_s")


def test_the_hump_tells_the_track_and_how_exactly_its_position_works() -> None:
    """The configuration still says the rest; free distances end where the track does, unless it gives them."""
    config = resolve(asked("", hump=Path("dumper"), track=3))
    assert (config.exit_std_m_s, config.position_name) == (0.15, "rnz-2m-park")
    (number,) = (value for value in config.parameters if value.key == "aim.exit_std_m_s")
    assert number.source == "hump dumper: the last position of track 3"
    assert config.aim.free_distances_m == (20.0, 50.0, 100.0)
    own = resolve(asked("[aim]\nexit_std_m_s = 0.05\n[stretch]\nspeed_mean_m_s = 4.0\n", hump=Path("medium"), track=1))
    assert (own.exit_std_m_s, own.scene.stretch.speed_mean_m_s) == (0.05, 4.0)
    assert own.aim.free_distances_m[-1] == 400.0


@pytest.mark.parametrize(
    ("text", "options", "words"),
    [
        ("", {"track": 3}, "--track is that of a hump; name the hump by --hump FILE"),
        ("", {"hump": Path("medium")}, "--track is missing; the hump medium has the tracks 1 to 16"),
        ("", {"hump": Path("medium"), "track": 17}, "--track is 17; the hump has the tracks 1 to 16"),
        (
            '[track]\nname = "large-hump"\n',
            {"hump": Path("medium"), "track": 1},
            "has [track], and --hump medium tells",
        ),
        ("[position]\nexit_m = 300.0\n", {"hump": Path("medium"), "track": 1}, "aim.toml has [position], and --hump"),
    ],
)
def test_what_is_not_told_or_told_twice_is_refused(text: str, options: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError) as caught:
        resolve(asked(text, **options))
    assert words in caught.value.sentences[0]
