"""Aim configurations: the template, what a file may change, and every fault in one sentence."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from plant_models.library import CAR_MIXES, TRACKS, Kind
from plant_models.rolling.random_cuts import MOST_CARS
from plant_models.rolling.resistance_law import LARGEST_ERLANG_ORDER, HumpNormLaw, Tb10062Law
from synth.aim.configuration.aim_file import default_aim_toml, parse_aim_file
from synth.aim.configuration.settings import CutsSettings, ResistanceSettings
from synth.aim.resolved_aim import ResolvedAim, resolve_aim
from synth.cli.type_template import type_toml
from synth.frame.faults import InputError
from synth.frame.settings.section import setting_limits


def resolved(text: str, place: str = "aim.toml") -> ResolvedAim:
    """The aim that `text` asks for."""
    return resolve_aim(parse_aim_file(text, place))


def built_in_aim() -> ResolvedAim:
    """What is asked for where no file is given."""
    return resolve_aim(parse_aim_file("", "built-in"))


def sentence(text: str, place: str = "aim.toml") -> str:
    """What is said of the faulty configuration `text`."""
    with pytest.raises(InputError) as caught:
        resolved(text, place)
    (said,) = caught.value.sentences
    assert said.startswith(f"{place}: ")
    return said.removeprefix(f"{place}: ")


def test_the_template_is_the_built_in_configuration_to_the_last_origin() -> None:
    text = default_aim_toml()
    told, built_in = resolved(text), built_in_aim()
    assert told.parameters == built_in.parameters
    assert told.sha256 == built_in.sha256
    assert told.scene == built_in.scene
    assert not built_in.warnings


def test_elements_and_bends_of_the_template_are_those_of_its_track() -> None:
    lists = re.sub(r"^# (elements|bends|    \{|\])", r"\1", default_aim_toml(), flags=re.MULTILINE)
    assert "\nelements = [" in lists
    assert "\nbends = [" in lists
    assert resolved(lists).parameters == built_in_aim().parameters


def test_every_assumed_number_is_marked_and_the_chosen_ones_claim_nothing() -> None:
    parameters = {value.key: value for value in built_in_aim().parameters}
    for key in ("weather.head_wind_std_m_s", "resistance.erlang_order", "cuts.cars.tank-4.share", "track.end_m"):
        assert parameters[key].assumed, key
    for key in ("L.rolling_resistance.mean_n_per_kn", "aim.coupling_speed_m_s", "simulation.seed", "cuts.cars"):
        assert not parameters[key].assumed, key
    changed = {v.key: v for v in resolved("[weather]\nhead_wind_std_m_s = 2.0\n").parameters}
    assert changed["weather.head_wind_std_m_s"].source == "configuration"
    assert not changed["weather.head_wind_std_m_s"].assumed


def test_what_changes_no_table_changes_no_hash() -> None:
    same = resolved('title = "x"\n[simulation]\nthreads = 3\n[output]\nplots = false\nreport = false\n')
    assert same.sha256 == built_in_aim().sha256
    for other in ("[simulation]\nseed = 1\n", '[resistance]\nlaw = "tb-10062"\n', "[position]\nexit_m = 337.0\n",
                  '[cuts]\ncategories = ["L"]\n', "[aim]\nspeed_std_m_s = 0.1\n"):  # fmt: skip
        assert resolved(other).sha256 != same.sha256, other


def test_the_laws_and_values_of_a_file_reach_the_scene() -> None:
    aim = resolved(
        '[resistance]\nlaw = "tb-10062"\n[weather]\ntemperature_c = -20.0\n[cuts]\ncategories = ["ST", "Л"]\n'
        "[position]\nexit_m = 338.0\n[stretch]\nspeed_std_m_s = 0.3\n[track]\nbends = []\n"
        "[aim]\ncoupling_speed_m_s = 1.5\n"
    )
    assert isinstance(aim.scene.population.law, Tb10062Law)
    assert aim.scene.population.weather.temperature_c == -20.0
    assert [member.latin for member in aim.members] == ["ST", "L"]
    assert (aim.scene.exit_m, aim.scene.stretch.speed_std_m_s, aim.scene.coupling_speed_m_s) == (338.0, 0.3, 1.5)
    assert aim.scene.track.bends == ()
    keys = {value.key for value in aim.parameters}
    assert not any(key.startswith("bends") or "erlang" in key or "rolling_resistance" in key for key in keys)
    norm = resolved("[resistance]\nerlang_order = 5\n").scene.population.law
    assert isinstance(norm, HumpNormLaw)
    assert norm.erlang_order == 5


def test_limits_are_those_of_law_and_cuts() -> None:
    assert setting_limits(CutsSettings.model_fields["cars"]) == (1, MOST_CARS)
    assert setting_limits(ResistanceSettings.model_fields["erlang_order"]) == (1, LARGEST_ERLANG_ORDER)


@pytest.mark.parametrize(
    ("kind", "text"), [(TRACKS, '[track]\nname = "{0}"\n'), (CAR_MIXES, '[cuts]\nmix = "{0}"\n')], ids=["track", "mix"]
)
def test_own_types_by_name_and_by_path(kind: Kind, text: str, tmp_path: Path) -> None:
    usual = {TRACKS: "large-hump", CAR_MIXES: "usual"}[kind]
    file = tmp_path / "my" / kind.folder / "mine.toml"
    file.parent.mkdir(parents=True)
    file.write_text(type_toml(kind, usual), encoding="utf-8")
    place = str(tmp_path / "aim.toml")
    by_name = resolved('library = ["my/"]\n' + text.format("mine"), place)
    by_path = resolved(text.format(f"my/{kind.folder}/mine.toml"), place)
    assert by_name.parameters == by_path.parameters
    assert by_name.scene == built_in_aim().scene
    traced = [v.key for v in by_name.parameters if v.source.endswith(f"(my/{kind.folder}/mine.toml)")]
    assert len(traced) > 5
    file.write_text(file.read_text(encoding="utf-8").replace("value = ", "valve = ", 1), encoding="utf-8")
    with pytest.raises(InputError, match=r"mine\.toml, line \d+: unknown key"):
        resolved(text.format(f"my/{kind.folder}/mine.toml"), place)


def element(*pieces: tuple[float, float, float]) -> str:
    """A [track] of these elements."""
    rows = ", ".join(f"{{ from_m = {a}, to_m = {b}, grade_permille = {g} }}" for a, b, g in pieces)
    return f"[track]\nelements = [{rows}]\n"


FAULTS = {
    "gap": (element((0, 400, 2), (401, 1200, 1)),
            "track.elements[1].from_m is 401, but the element before ends at 400 m; elements must follow one another "
            "without gap and overlap: set it to 400"),
    "overlap": (element((0, 400, 2), (390, 1200, 1)), "track.elements[1].from_m is 390, but the element before ends a"),
    "negative length": (element((0, 400, 2), (400, 300, 1)), "track.elements[1].to_m is 300; it must be more than"),
    "not from the crest": (element((10, 1200, 2)), "track.elements[0].from_m is 10; the track begins at the crest"),
    "absurd grade": (element((0, 1200, 200)), "track.elements[0].grade_permille is 200; it must be from -60 to 60"),
    "too short": (element((0, 340, 2)), "aim.free_distances_m[7] is 400; between a cut of 15 cars"),
    "no element": ("[track]\nelements = []\n", "track.elements is []; it must be a list of 1 to 200 tables"),
    "bend without length": ("[track]\nbends = [{from_m = 9, to_m = 9, switches = 1}]\n", "track.bends[0] is from 9 to"),
    "bends overlap": ("[track]\nbends = [{from_m = 1, to_m = 9, switches = 1}, {from_m = 8, to_m = 9, switches = 1}]\n",
                      "track.bends[1].from_m is 8, but the bend before ends at 9 m"),
    "bend without bend": ("[track]\nbends = [{from_m = 1, to_m = 9}]\n", "switches and turn_deg are both 0 at 1 m"),
    "track": ('[track]\nname = "large-hum"\n', "track.name is 'large-hum', which the library does not hold; did you m"),
    "mix": ('[cuts]\nmix = "usul"\n', "cuts.mix is 'usul', which the library does not hold; did you mean usual?"),
    "category": ('[cuts]\ncategories = ["ST", "STT"]\n', "cuts.categories[1]: weight category 'STT' is not in the"),
    "category twice": ('[cuts]\ncategories = ["T", "Т"]\n', "cuts.categories[1] is 'Т', which is there before"),
    "position": ('[position]\nname = "rnz-2m"\n', "position.name is 'rnz-2m', which the library does not hold; did yo"),
    "exit before entrance": ("[position]\nexit_m = 300.0\n", "position.exit_m is 300; it must be more than entrance_m"),
    "stretch in the position": ("[stretch]\nto_m = 320.0\n", "stretch.to_m is 320; it must not be beyond the entrance"),
    "too fast": ("[stretch]\nspeed_mean_m_s = 30.0\n", "stretch.speed_mean_m_s is 30.0; it must be a finite number fr"),
    "distance 0": ("[aim]\nfree_distances_m = [0.0, 50.0]\n", "aim.free_distances_m[0] is 0; it must be more than 0"),
    "distance before the position": ("[aim]\nfree_distances_m = [-5.0]\n", "aim.free_distances_m[0] is -5; it must be"),
    "distances fall": ("[aim]\nfree_distances_m = [50.0, 20.0]\n", "aim.free_distances_m[1] is 20 after 50; give them"),
    "beyond the end": ("[aim]\nfree_distances_m = [50.0, 800.0]\n[cuts]\ncars = [1]\n",
                       "aim.free_distances_m[1] is 800; between a cut of 1 cars"),
    "knowledge": ('[aim]\nknowledge = ["weight"]\n', "aim.knowledge[0] is 'weight'; it must be 'category' or 'measure"),
    "cars fall": ("[cuts]\ncars = [3, 2]\n", "cuts.cars[1] is 2 after 3; give the numbers of cars in increasing order"),
    "no cars": ("[cuts]\ncars = [0]\n", "cuts.cars[0] is 0; it must be from 1 to 60"),
    "both": ('[aim]\nexit_std_m_s = 0.1\ntables = "b.h5"\n', "aim.exit_std_m_s is 0.1 and aim.tables is 'b.h5'; both"),
    "no book": ('[aim]\ntables = "b.h5"\n', "aim.tables names the book 'b.h5', which does not exist"),
    "config of no book": ('[aim]\ntables_config = "c.toml"\n', "aim.tables_config is 'c.toml', but aim.tables names n"),
    "law": ('[resistance]\nlaw = "hump"\n', "resistance.law is 'hump'; it must be 'hump-norm' or 'tb-10062'"),
    "lee": ("[cuts]\nfollowing_share = 3.0\n", "cuts.following_share is 3.0; it must be a finite number from 0 to 1"),
    "key of another section": ("[aim]\npasses = 5\n", "aim.passes = 5 is an unknown key; did you mean simulation.pas"),
    "section": ("[wind]\nmean = 1\n", "wind = {'mean': 1} is an unknown key; known: acceptance, aim, cuts"),
}  # fmt: skip


@pytest.mark.parametrize("name", FAULTS)
def test_a_fault_is_told_in_one_sentence_with_key_and_value(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    text, said = FAULTS[name]
    assert said in sentence(text)
