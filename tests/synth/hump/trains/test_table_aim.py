"""Exported aim tables command the last position: by their own rule, for all that trains bring, and by their reading."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from plant_models.hump import Retarder
from synth.frame.faults import InputError
from synth.frame.results_directory import results_directory
from synth.hump.configuration.trial_file import parse_trial_file
from synth.hump.hump_file import hump_text
from synth.hump.planning.aim_control import ReadOnStretch
from synth.hump.planning.free_stretch import SpeedSensors
from synth.hump.rolling.motion import Moving
from synth.hump.rolling.route_rolling import rolling_on
from synth.hump.rolling.train_memory import Asked, TrainMemory
from synth.hump.trains.shown.positions import aim_rows
from synth.hump.trial.asked_trial import write_inputs
from synth.hump.trial.made_trial import made_trial
from synth.hump.trial.resolved_trial import ResolvedTrial, load_trial, resolve_trial
from synth.simulation.free_roll import rolling_cuts
from tests.synth.hump.trains.exported_aims import (
    CATEGORIES,
    EXIT_M,
    STRETCH_M,
    made_tables,
    medium,
    written,
)
from tests.synth.hump.trains.mixed_cuts import without_padding
from tests.system.conftest import changed
from tuning_tables.aim import ParkPosition, aim_exit_speed
from tuning_tables.programs.aim_speed import exit_speed

SMALL = """\
hump = "medium"
[trains]
number = 4
cuts = 6
most_cars = 3
[aim]
design_cuts = 200
"""


def resolved(tmp_path: Path, text: str) -> ResolvedTrial:
    """The trial with what `text` says of the aim."""
    return resolve_trial(parse_trial_file(SMALL + text, str(tmp_path / "trial.toml")))


def park_retarders() -> list[int]:
    """Number of the last retarder of each route."""
    return [[e.number for e in r.elements if isinstance(e.vertex, Retarder)][-1] for r in medium().routes]


def test_every_command_of_the_last_position_is_an_answer_of_the_tables(tmp_path: Path) -> None:
    tables = made_tables(0.6, measured=False)
    written(tmp_path / "aim", tables)
    trial = made_trial(resolved(tmp_path, 'tables = "aim"\n'))
    trains, _, memory = trial.humped(0, 20)
    own = {table.category.number: table for table in tables}
    compared = 0
    for lane, cut in zip(*np.nonzero(np.isfinite(memory.command_m_s[:, :, -1])), strict=True):
        row = lane * trains.cuts + cut
        if memory.route[lane, :cut].tolist().count(memory.route[lane, cut]):
            continue  # what is seen of the track behind another cut is not in the memory
        table = own[CATEGORIES.members[trains.category[row]].number]
        free = memory.free_m[lane, cut] - EXIT_M - trains.last_axle_m[row]
        answer = aim_exit_speed(table, int(trains.cars[row]), free)
        assert memory.command_m_s[lane, cut, -1] == (0.5 if answer is None else answer)
        compared += 1
    assert compared > 60


def test_groups_of_tracks_have_tables_of_their_own_and_the_rest_is_designed(tmp_path: Path) -> None:
    """Tables named by the hump file, others by the configuration, and none; the folder of inputs repeats the trial."""
    numbers = park_retarders()
    slow, fast = made_tables(0.9, measured=False), made_tables(0.3, measured=False)
    names = [f"near/{file.name}" for file in sorted(written(tmp_path / "near", slow).iterdir())]
    written(tmp_path / "far", fast)
    text = hump_text(Path("medium"))
    for number in numbers[:5]:
        text = text.replace(f"number = {number},", f"number = {number}, aim_tables = {names},", 1)
    (tmp_path / "mine.toml").write_text(text, encoding="utf-8")
    told = f'tables_of = {{ {numbers[4]} = "far", {numbers[7]} = "far" }}\n'
    file = parse_trial_file(changed(SMALL + told, ('"medium"', '"mine.toml"')), str(tmp_path / "trial.toml"))
    config = resolve_trial(file)
    assert [choice.rows for choice in config.aims] == [(0, 1, 2, 3), (4, 7)]
    assert {row["tracks"] for row in aim_rows(config.routes, config.aims[1], {})} == {(5, 8)}
    assert config.designed_rows == (5, 6, *range(8, 16))
    found = made_trial(config)
    rows, of_all = np.arange(16), np.zeros(16, dtype=np.int64)
    speeds = found.aim.command_m_s(rows, of_all, of_all + 1, np.full(16, 150.0))
    answers = [aim_exit_speed(tables[0], 1, 150.0) for tables in (slow, fast)]
    assert speeds[:4].tolist() == [answers[0]] * 4
    assert speeds[[4, 7]].tolist() == [answers[1]] * 2
    designed = made_trial(resolved(tmp_path, "")).aim.command_m_s(rows, of_all, of_all + 1, np.full(16, 150.0))
    assert speeds[8:].tolist() == designed[8:].tolist()
    with results_directory(tmp_path / "out", "hump simulate") as out:
        write_inputs(file, config, out)
    for folder in ("near", "far"):
        shutil.rmtree(tmp_path / folder)
    again = load_trial(tmp_path / "out" / "inputs" / "config.toml")
    assert (again.sha256, again.trains_sha256) == (config.sha256, config.trains_sha256)
    np.testing.assert_array_equal(made_trial(again).batch(0, 3).speed_bins, found.batch(0, 3).speed_bins)
    source = tmp_path / "out" / "inputs" / "config.toml"
    again_file = parse_trial_file(source.read_text(), str(source))
    with results_directory(tmp_path / "out", "hump simulate", [source], inputs="inputs") as out:
        write_inputs(again_file, again, out)
    assert load_trial(tmp_path / "out" / "inputs" / "config.toml").sha256 == config.sha256


def test_other_content_gives_another_hash_and_another_name_does_not(tmp_path: Path) -> None:
    hashes = []
    for name, grade in (("a", 0.6), ("b", 0.6), ("c", 0.7)):
        written(tmp_path / name, made_tables(grade, measured=False))
        hashes.append(resolved(tmp_path, f'tables = "{name}"\n').trains_sha256)
    assert hashes[0] == hashes[1] != hashes[2]
    assert resolved(tmp_path, "").trains_sha256 not in hashes
    keys = {value.key for value in resolved(tmp_path, 'tables = "a"\n').parameters}
    assert not any(key.startswith("aim.") for key in keys)


def test_a_reading_is_what_the_tables_call_one(tmp_path: Path) -> None:
    """Each cut alone on its track, by energies worked out there; sensors with an error of 0.1 mm/s."""
    config = resolved(tmp_path, 'knowledge = "measured"\n')
    trial = made_trial(config)
    trains = trial.source.trains(0, 40)
    rolls = rolling_on(trial.ways, trains.population, trains.drawn, 1)
    stretch = np.tile(STRETCH_M, (16, 1))
    reading = ReadOnStretch(SpeedSensors(trial.routes, trains, 1e-4), rolls, stretch)
    memory, lanes = TrainMemory(40, 6, trial.routes), np.arange(40)
    memory.exit_m_s[:, 3, 1] = np.linspace(3.5, 6.5, 40)
    rows = lanes * 6 + 3
    route, none = trains.route[rows], np.zeros(40)
    found = reading.n_per_kn(Asked(3, 2, lanes, route, Moving(none, none + 3.0, none), none, memory))
    for place, row in enumerate(rows):
        way = trial.routes.routes[route[place]]
        cut = without_padding(trains.drawn, rows[place : place + 1]).on_bends(config.people.law, way.roll_track.bends)
        alone = rolling_cuts(config.people, way.roll_track, way.yard_from_m, cut)
        free = np.array([trial.routes.exit_m[route[place], 1] + trains.last_axle_m[row]])
        first = trains.first_axle_m[row]
        ends = np.maximum(np.array([[STRETCH_M[0] + first, STRETCH_M[1] + first]]), free[0])
        if ends[0, 1] - ends[0, 0] < 10.0:
            assert np.isnan(found[place])
            continue
        speed = alone.roll_on(free, memory.exit_m_s[place : place + 1, 3, 1], ends).speed_m_s[0]
        fall = alone.fall_m(ends[:, 1]) - alone.fall_m(ends[:, 0])
        lost = fall - (speed[1] ** 2 - speed[0] ** 2) / (2.0 * cut.reduced_gravity_m_s2)
        assert found[place] == pytest.approx(float(1e3 * lost[0] / (ends[0, 1] - ends[0, 0])), abs=0.02)
    assert np.isfinite(found).mean() > 0.9


def test_measured_cuts_are_commanded_by_their_reading(tmp_path: Path) -> None:
    """A worse runner is let go faster, and the plan expects the answer for the mean reading."""
    written(tmp_path / "aim", made_tables(0.6))
    half = "[tracks]\nfree_low = 0.5\nfree_high = 0.5\n"
    config = resolved(tmp_path, f'tables = "aim"\nknowledge = "measured"\n{half}')
    assert not config.warnings
    trial = made_trial(config)
    means = [table.mean_n_per_kn for table in trial.aim.tables[0]]
    assert all(1.0 < mean < 6.0 for mean in means)
    assert means == sorted(means, reverse=True)  # from the lightest category to the heaviest
    one = np.zeros(1, dtype=np.int64)
    expected = trial.aim.expected_m_s(one, one, one + 1, np.full(1, 150.0), measured=True)
    table = trial.aim.tables[0][0].measured
    assert table is not None
    assert expected[0] == exit_speed(table, 1, np.float32(150.0), np.float32(means[0]))
    trains, _, memory = trial.humped(0, 200)
    last = memory.command_m_s[:, :, -1]
    ahead, held = trains.drawn.resistance_n_per_kn.reshape(last.shape), np.isfinite(last)
    alike = held & (trains.cars.reshape(last.shape) == 1) & (trains.category.reshape(last.shape) == 0)
    assert np.corrcoef(last[alike], ahead[alike])[0, 1] > 3.5 / np.sqrt(alike.sum())


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('tables = "none"', "aim.tables names {0}/none, and there is no such file or directory"),
        ('tables = "empty"', "aim.tables names {0}/empty, which holds no aim tables (JSON of the kind aim)"),
        ('tables = "trial.csv"', "aim.tables names {0}/trial.csv, which is no aim table"),
        ('tables = "one"', "aim.tables names {0}/one, which has no table by category alone for the weight category ЛС"),
        (
            'tables = "category"\nknowledge = "measured"',
            "aim.tables names {0}/category, which has no table by measured",
        ),
        ('tables = "twice"', "aim.tables names {0}/twice, which cannot be used together: aim-1-category and twice-aim"),
        (
            'tables = "other"',
            "aim.tables names {0}/other, whose table aim-1-category is for the position ours, but ret",
        ),
        ('tables_of = { 7 = "all" }', "aim.tables_of names '7'; retarders that aim at the standing cars: "),
    ],
)
def test_each_fault_is_one_sentence(text: str, said: str, tmp_path: Path) -> None:
    tables = made_tables(0.6)
    plain = [each for each in tables if not each.is_measured]
    written(tmp_path / "all", tables)
    written(tmp_path / "category", plain)
    written(tmp_path / "one", plain[:1])
    written(tmp_path / "twice", [*plain, replace(plain[0], id="twice-aim")])
    written(tmp_path / "other", [replace(each, position=ParkPosition("ours", EXIT_M)) for each in plain])
    (tmp_path / "empty").mkdir()
    (tmp_path / "trial.csv").write_text("cut\n")
    with pytest.raises(InputError) as caught:
        resolved(tmp_path, text + "\n")
    (sentence,) = caught.value.sentences
    assert sentence.startswith(f"{tmp_path}/trial.toml: {said.format(tmp_path)}")


def test_tables_must_list_the_longest_cut_and_be_measured_ahead_of_the_position(tmp_path: Path) -> None:
    written(tmp_path / "aim", made_tables(0.6))
    long = changed(SMALL, ("most_cars = 3", "most_cars = 9"))
    with pytest.raises(
        InputError, match=r"table aim-1-category is for cuts of 1 to 8 cars; trains can have cuts of 1 to 9"
    ):
        resolve_trial(parse_trial_file(f'{long}tables = "aim"\n', str(tmp_path / "trial.toml")))
    moved = [replace(each, position=ParkPosition("rnz-2m-park", EXIT_M - 20.0)) for each in made_tables(0.6)]
    written(tmp_path / "moved", moved)
    with pytest.raises(InputError, match=r"measured up to 300 m from the crest on the way to track 1, where .* 284 m"):
        resolved(tmp_path, 'tables = "moved"\nknowledge = "measured"\n')


def test_what_tables_are_not_made_for_is_a_warning(tmp_path: Path) -> None:
    written(tmp_path / "aim", [replace(each, position=ParkPosition("rnz-2m-park", 305.0)) for each in made_tables(0.6)])
    noisy = "[sensors]\nspeed_std_m_s = 0.05\n"
    said = resolved(tmp_path, f'tables = "aim"\nknowledge = "measured"\n{noisy}').warnings
    assert sum("was made for speeds measured to 0.1 m/s" in each for each in said) == len(CATEGORIES.members)
    assert (
        sum("made for a position that ends 305 m from the crest; in this hump it ends at 295" in e for e in said) == 1
    )
