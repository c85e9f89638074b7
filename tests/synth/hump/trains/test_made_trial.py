"""From a configuration to the trial: models, limits and sources are what the file says; and mistakes of users, each one
sentence with file, key, value and remedy, all of a file at once.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pytest

from plant_models.library.hump_entry import load_hump
from synth.frame import sheet
from synth.frame.exhibits import Table
from synth.frame.faults import InputError
from synth.frame.results_directory import results_directory
from synth.hump.configuration.trial_file import parse_trial_file
from synth.hump.hump_file import hump_text
from synth.hump.hump_forms import to_csv, to_xlsx
from synth.hump.planning.speed_rules import pair_by_pair
from synth.hump.rolling.hump_position import Arrivals
from synth.hump.trains.speed_program import program_exhibits, speed_program
from synth.hump.trial.asked_trial import write_inputs
from synth.hump.trial.made_trial import made_trial
from synth.hump.trial.position_choice import HeldTables
from synth.hump.trial.resolved_trial import load_trial, resolve_trial
from synth.hump.trial.trial import HumpTrial
from tests.synth.hump.trains.coarse_book import PARK, coarse_tables
from tests.system.conftest import changed
from tuning_tables import write_book

ONE = "[[position]]\nnumber = 1\n"
TRIALS = {
    'hump = "larg"': "hump: larg: there is no such file, and no such hump in the library; did you mean large?",
    'hump = "my-hump.toml"': "hump: my-hump.toml: there is no such file",
    'hunp = "large"': "hunp = 'large' is an unknown key; did you mean hump?",
    "[train]\nnumber = 5": "train = {'number': 5} is an unknown key; did you mean trains?",
    "[trains]\ncategory_shares = { L = 30, Q = 70 }": "weight category 'Q' is not in the library; known: L",
    "[trains]\ncategory_shares = { L = -1 }": "trains.category_shares.L is -1; it must be from 0 to 1e+06",
    "[trains]\ncategory_shares = { L = 0 }": "category_shares has no share above 0; one at least must be positive",
    "[trains]\nclosed_tracks = [99]": "trains.closed_tracks names 99; signal 201 leads to tracks 1 to 32",
    "[trains]\nclosed_tracks = 3": "trains.closed_tracks is 3; it must be a list",
    "[trains]\ntrack_shares = { 99 = 1 }": "trains.track_shares names '99'; signal 201 leads to tracks 1 to 32: give",
    '[trains]\nlist = "none.csv"': "none.csv: there is no such file; give the path of a sorting list",
    "[hump_speed]\nlowest_m_s = 3.0\nhighest_m_s = 2.0": "lowest_m_s is 3; it must not be above highest_m_s, 2,",
    "[exit_speeds]\nexit_m_s = 4.8": "exit_speeds.exit_m_s = 4.8 is an unknown key; did you mean position.exit_m_s?",
    "exit_speed_m_s = 4.8": "exit_speed_m_s = 4.8 is an unknown key; did you mean position.exit_m_s?",
    f"{ONE}exit_speed_m_s = 4.8": "position[0].exit_speed_m_s = 4.8 is an unknown key; did you mean exit_m_s?",
    "[[position]]\nnumber = 9": "position[0].number is 9; the hump has the positions 1 to 3, 1 being the first behind",
    '[[position]]\nrole = "aim"': "position[0].number is missing; add it to position[0]",
    f'{ONE}role = "park"': "position[0].role is 'park'; it must be 'spacing', 'aim' or 'fixed'",
    f'{ONE}role = "aim"': "role is 'aim', but on every route there is another position behind it",
    f"{ONE}exit_m_s = {{ L = 5.0 }}": "position 1: exit_m_s has no speed for LS, S, ST, T; add LS, or all for all",
    f"{ONE}exit_m_s = 48": "position[0].exit_m_s.all is 48; it must be from 0.3 to 12",
    f"{ONE}lowest_m_s = 5\nhighest_m_s = 4": "position[0].lowest_m_s is 5.0; it must not be above highest_m_s, 4.0",
    f'{ONE}tables = "no.h5"': "position 1: there is no file 'no.h5'; 'retarder-synth init --for' prints the",
    f"{ONE}exit_std_m_s = 0,35": "line 3: 0,35 is no number of TOML; write 0.35, with a decimal point",
    "[position]\nnumber = 1": "it must be a list of tables: write [[position]], not [position]",
    f"{ONE}{ONE}": "position[1].number is 1, which is there before; put the two together",
    "lead = 7": "lead is 7; the signals at the crests of the hump are 201",
    '[resistance]\nlaw = "norm"': "resistance.law is 'norm'; it must be 'hump-norm' or 'tb-10062'",
    "[aim]\ncoupling_speed_m_s = 1.5": "aim.coupling_speed_m_s = 1.5 is an unknown key; did you mean couplings.allowed",
    "[aim]\np_overspeed = 10": "aim.p_overspeed is 10; it must be from 0.005 to 0.9; this is a share: 0.1 for 10 %",
    "[couplings]\nallowed_m_s = 5": "couplings.allowed_m_s is 5; it must be less than rough_m_s, 1.5",
    '[tracks]\nstanding = "empty"': "tracks.standing is 'empty'; it must be 'drawn' or 'file'",
    '[cars]\nmix = "coal"': "cars.mix is 'coal', which the library does not hold; known: usual",
    "[trains]\nmost_cars = 30": "trains.most_cars is 30: such a cut is 441.9 m long; let go with its middle over",
    "[trains]\ntrack_shares = { 1 = 0.0 }": "trains.track_shares leaves no track to which cuts go: tracks that",
    '[trains]\ncategory_shares = { L = 1.0, "Л" = 2.0 }': "trains.category_shares: Л is there twice; leave one out",
    "[trains]\ncategory_shares = {}": "trains.category_shares is {}; it must be a table of 1 to 31 shares",
    "[tracks]\nfree_low = 0.95": "tracks.free_low is 0.95; it must not be above free_high, 0.9",
    "[hump_speed]\nuncoupling_m_s = 0.9": "hump_speed.lowest_m_s is 1; it must not be above highest_m_s, 3.4, nor",
    "[hump_speed]\nslow_down_s = 0.0\n[exit_speeds]\nfeedback = false": "hump_speed.slow_down_s is 0, but exit",
    "[aim]\nhighest_m_s = 0.5\nlowest_m_s = 0.6": "aim.lowest_m_s is 0.6; it must not be above highest_m_s, 0.5",
    f'{ONE}role = "fixed"': "position[0].role is 'fixed'; the speed is missing: add exit_m_s",
    f'{ONE}role = "aim"\nexit_m_s = 4.0': "position[0].exit_m_s fixes the exit speed, but role",
    f"{ONE}exit_m_s = 4.0\nlowest_m_s = 3.0": "position[0].lowest_m_s is 3.0; it is for a",
    f"{ONE}exit_m_s = {{ L = 4.0, Q = 4.0 }}": "position 1: exit_m_s: weight category 'Q' is not",
    f'{ONE}exit_m_s = {{ L = 1, "Л" = 2 }}': "position 1: exit_m_s: Л is there twice; leave one",
    "[[position]]\nnumber = 3\nlowest_m_s = 1.0": "position 3: lowest_m_s is 1.0, but the position aims on every",
    f'{ONE}exit_m_s = "4"': "position[0].exit_m_s is '4'; it must be a speed, or a table of",
    f'{ONE}exit_std_m_s = 0.2\ntables = "b.h5"': "position[0].exit_std_m_s is 0.2 and",
    f'{ONE}tables_config = "b.toml"': "position[0].tables_config is 'b.toml', but no book",
    "[output]\nplots = yes": "line 2: yes must be written true",
}


def told_of_trial(text: str) -> Sequence[str]:
    """What a trial with this text is refused with."""
    with pytest.raises(InputError) as caught:
        resolve_trial(parse_trial_file(text, "my.toml"))
    return caught.value.sentences


def test_every_mistake_in_a_trial_is_one_sentence() -> None:
    for text, words in TRIALS.items():
        (sentence,) = told_of_trial(text)
        assert words in sentence, text
        assert sentence.startswith(("my.toml", "none.csv")), text


def test_all_mistakes_of_a_trial_are_told_at_once() -> None:
    told = told_of_trial("[trains]\nnumber = 0\ncuts = 1.5\n[weather]\ntemperature_c = -250\n[aim]\np = 1\n")
    keys = {sentence.split(" ")[1] for sentence in told}
    assert keys == {"trains.number", "trains.cuts", "weather.temperature_c", "aim.p"}


SMALL = """\
hump = "medium"
[trains]
number = 4
cuts = 5
most_cars = 3
[aim]
design_cuts = 200
"""


def made(text: str = "") -> HumpTrial:
    """A small trial with what `text` says besides."""
    return made_trial(resolve_trial(parse_trial_file(SMALL + text, "trial.toml")))


def test_steps_end_where_signal_or_uncoupling_ends() -> None:
    for text, last in (("highest_m_s = 2.0", 2.0), ("uncoupling_m_s = 2.55", 2.5), ("", 3.4)):
        steps = made(f"[hump_speed]\nlowest_m_s = 1.0\n{text}\n").planner.limits.steps_m_s
        np.testing.assert_allclose(steps, np.arange(1.0, last + 0.05, 0.1), atol=1e-9)
    trial = made('[hump_speed]\nmethod = "pair-by-pair"\nworst_pair = true\nleast_s = 0.8\nacceleration_m_s2 = 0.1\n')
    assert trial.planner.method is pair_by_pair
    assert (trial.planner.worst_pair, trial.planner.least_s) == (True, 0.8)
    assert trial.planner.limits.acceleration_m_s2 == 0.1


def test_a_position_out_of_service_brakes_nothing(arrivals: Callable[..., Arrivals]) -> None:
    """The free roll from the position before it is all that is left; in service the command is kept."""
    coming = arrivals(50)
    serving, idle = made().positions[1], made("[[position]]\nnumber = 2\nout_of_service = true\n")
    np.testing.assert_array_equal(idle.positions[1].passed(coming).exit_m_s, coming.unbraked_exit_m_s)
    assert abs(serving.passed(coming).exit_m_s - coming.commanded_m_s).max() < 1.0
    left_open = idle.planner.roles.exits[1].choices(np.array([0]))
    assert left_open.speeds(np.array([5.5])).tolist() == [[5.5]]
    trains, _, memory = idle.humped(0, 2)
    assert len(trains) == 10
    rolls = np.isfinite(memory.exit_m_s[:, :, 1])
    assert rolls.sum() >= 8
    assert (memory.exit_m_s[:, :, 1][rolls] > memory.entry_m_s[:, :, 1][rolls]).all()  # 8 permille fall


def test_supply_is_a_share_of_the_work_of_the_brake(arrivals: Callable[..., Arrivals]) -> None:
    """A heavy cut under full brake loses half of the energy by half of the supply."""
    coming = arrivals(8, mass_t=80.0, commanded_m_s=0.0, category=4)
    ends = []
    for share in (0.3, 0.15):
        text = f"[[position]]\nnumber = 2\nexit_std_m_s = 0.0\nsupply_share = {share}\n"
        ends.append(made(text).positions[1].passed(coming).exit_m_s)
    more, half = (coming.unbraked_exit_m_s**2 - exits**2 for exits in ends)
    assert (ends[0] > 0.35).all()
    np.testing.assert_allclose(half, 0.5 * more, rtol=1e-12)


def test_the_program_is_that_of_an_even_push() -> None:
    """Between two cuts the train is pushed at an even rate: t = 2·apart/(v1 + v2), summed up anew here."""
    program = speed_program(made(), 3)
    time, place = 0.0, 0.0
    for before, row in zip(program.rows, program.rows[1:], strict=False):
        apart = 0.5 * (before.length_m + row.length_m)
        time, place = time + 2.0 * apart / (before.hump_speed_m_s + row.hump_speed_m_s), place + apart
        assert row.time_s == pytest.approx(time)
        assert row.pushed_m == pytest.approx(place)
    (table,) = (each for each in program_exhibits(program, brief=True) if isinstance(each, Table))
    head, *lines = (line.split(",") for line in sheet.to_csv(table).decode("utf-8-sig").splitlines())
    assert head[-3:] == ["exit_1_m_s", "exit_2_m_s", "exit_3_m_s"]
    rows = [dict(zip(head, cells, strict=True)) for cells in lines]
    assert [int(row["track"]) for row in rows] == [row.track for row in program.rows]
    last = {key: float(rows[-1][key]) for key in ("time_s", "pushed_m", "hump_speed_m_s")}
    assert last == {"time_s": time, "pushed_m": place, "hump_speed_m_s": program.rows[-1].hump_speed_m_s}


def test_the_program_is_the_one_that_is_humped() -> None:
    trial = made()
    program, (_, plan, memory) = speed_program(trial, 2), trial.humped(0, 4)
    np.testing.assert_array_equal([row.hump_speed_m_s for row in program.rows], memory.hump_speed_m_s[2])
    np.testing.assert_array_equal([row.exit_m_s for row in program.rows], plan.exit_m_s[2])
    np.testing.assert_allclose([row.time_s for row in program.rows], memory.crest_s[2] - memory.crest_s[2, 0])


def test_a_constant_speed_is_kept() -> None:
    program = speed_program(made("[hump_speed]\nconstant_m_s = 1.7\n"), 0)
    assert {row.hump_speed_m_s for row in program.rows} == {1.7}
    assert program.mean_m_s == pytest.approx(1.7)


BOOKED = """\
category_shares = { L = 1.0 }
[[position]]
number = 3
tables = "park.h5"
tables_config = "park.toml"
"""


def test_a_position_with_a_book_runs_its_tables(tmp_path: Path) -> None:
    """Its errors are those of tables, and the folder of inputs gives the same trains without the files."""
    write_book(coarse_tables(), tmp_path / "park.h5")
    (tmp_path / "park.toml").write_text(PARK, encoding="utf-8")
    text = changed(SMALL, ("most_cars = 3\n", "most_cars = 2\n"), ("[aim]\ndesign_cuts = 200\n", ""))
    file = parse_trial_file(text + BOOKED, str(tmp_path / "trial.toml"))
    config = resolve_trial(file)
    assert config.positions[2].held == HeldTables(frozenset({("Л", 4), ("Л", 8)}), 1.5, 3.0)
    assert config.positions[2].exit_std_m_s is None
    assert any("position 3 aims with 1.5 to 3 m/s, for which" in warning for warning in config.warnings)
    trial = made_trial(config)
    assert trial.aim.expected_m_s(*(np.array([0]),) * 3, np.array([5.0]), False) == 1.5  # not 0.5, which it cannot keep
    found = trial.batch(0, 4)
    assert (found.strokes[:, :2] == 0).all()
    assert (found.strokes[:, 2] > 0).all()
    with results_directory(tmp_path / "out", "hump simulate") as out:
        write_inputs(file, config, out)
    for name in ("park.h5", "park.toml"):
        (tmp_path / name).unlink()
    again = load_trial(tmp_path / "out" / "inputs" / "config.toml")
    assert (again.sha256, again.trains_sha256) == (config.sha256, config.trains_sha256)
    np.testing.assert_array_equal(made_trial(again).batch(0, 4).strokes, found.strokes)


@pytest.mark.parametrize("form", ["csv", "xlsx"])
def test_a_hump_in_a_spreadsheet_can_be_repeated_from_the_inputs(tmp_path: Path, form: str) -> None:
    hump, table = load_hump("dumper"), tmp_path / f"my.{form}"
    table.write_bytes(to_xlsx(hump) if form == "xlsx" else to_csv(hump).encode())
    file = parse_trial_file(f'hump = "{table.name}"', str(tmp_path / "trial.toml"))
    config = resolve_trial(file)
    with results_directory(tmp_path / "out", "hump simulate") as out:
        write_inputs(file, config, out)
    table.unlink()
    assert load_trial(tmp_path / "out" / "inputs" / "config.toml").trains_sha256 == config.trains_sha256


def test_books_that_lack_a_class_or_targets_are_refused(tmp_path: Path) -> None:
    write_book(coarse_tables(), tmp_path / "park.h5")
    (tmp_path / "park.toml").write_text(PARK, encoding="utf-8")
    place = str(tmp_path / "trial.toml")
    heavy = changed(SMALL, ("[aim]\ndesign_cuts = 200\n", "")) + changed(BOOKED, ("L = 1.0", "T = 1.0"))
    make_one = f"make one that fits by 'retarder-synth init --for {place} --position-number"
    with pytest.raises(InputError) as caught:
        resolve_trial(parse_trial_file(heavy, place))
    (sentence,) = caught.value.sentences
    assert "park.h5 has no class for cuts of category Т (T) with 4, 8, 12 axles; a class stands" in sentence
    assert f"there are Л (L) with 4, 8 axles: {make_one} 3 > tables.toml', or leave T out of" in sentence
    ahead = "[[position]]\nnumber = 2\ntables = 'park.h5'\n"
    for keys, words in (
        ("", "ends at 3 m/s, but it keeps cuts apart with 4 to 7 m/s, which are usual where"),
        ("highest_m_s = 2.5\nlowest_m_s = 1.0\n", "begins at 1.5 m/s, but it keeps cuts apart with 1 to 2.5 m/s, by"),
        ("exit_m_s = { T = 1.0, all = 3.5 }\n", "has tables from 1.5 to 3 m/s alone, but exit_m_s of the position"),
    ):
        with pytest.raises(InputError) as caught:
            resolve_trial(parse_trial_file(f"{SMALL}{ahead}{keys}", place))
        lacks_classes, lacks_targets = caught.value.sentences
        assert "has no class for cuts of category ЛС" in lacks_classes
        assert "or set trains.most_cars" not in lacks_classes
        assert f"position 2: its book {tmp_path / 'park.h5'} {words}" in lacks_targets
        assert f"{make_one} 2" in lacks_targets


def test_a_position_that_no_library_has_is_refused(tmp_path: Path) -> None:
    text = hump_text(Path("dumper")).replace(
        'position = "rnz-2m-park"', 'position = "ours"\nzones_m = [[0.0, 12.0]]', 1
    )
    (tmp_path / "ours.toml").write_text(text, encoding="utf-8")
    config = resolve_trial(parse_trial_file('hump = "ours.toml"\n', str(tmp_path / "trial.toml")))
    with pytest.raises(InputError, match=r"position 1: .*'ours' is not in the library.*from a folder of library"):
        made_trial(config)
