"""Mistakes of users in hump trials: each is one sentence with file, key, value and remedy, all of a file at once."""

from __future__ import annotations

from collections.abc import Sequence

import pytest

from synth.frame.input_error import InputError
from synth.hump.configuration.trial_file import parse_trial_file
from synth.hump.trains.resolved_trial import resolve_trial

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
