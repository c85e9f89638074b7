"""Configurations of a control computer: the template, and every fault in one sentence."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from synth.computer.computer_results import computer_results
from synth.computer.economics.traffic import RATES
from synth.computer.resolved_computer import ResolvedComputer, resolve_computer
from synth.computer.settings import ComputerSettings, default_computer_toml
from synth.frame.faults import InputError
from synth.frame.settings.settings_file import parse_settings
from synth.retarder.configuration.plant_fault import in_file

ROOT = Path(__file__).parents[3]

FEW = "[uncertainty]\ndraws = 200\nsobol_points = 16\n"
SHARES = "".join(f"{name} = 0.1\n" for name in RATES[1:-1])
TASK = '[[task]]\nname = "a"\nrate_per_s = 1.0\noperations = 100.0\n'


def resolved(text: str) -> ResolvedComputer:
    """What `text` asks for."""
    return resolve_computer(parse_settings(ComputerSettings, text, "c.toml"), Path(), "c.toml")


def test_the_template_is_the_built_in_configuration_to_the_last_origin() -> None:
    told, built_in = resolved(default_computer_toml()), resolved("")
    assert told.settings == built_in.settings
    assert told.head == built_in.head
    assert not built_in.head.warnings


def test_the_figures_of_the_hump_are_those_of_the_kept_study() -> None:
    """Today and our tables in their closed loop, to the four digits of the defaults."""
    kept = json.loads((ROOT / "docs" / "studies" / "control-computer.json").read_text(encoding="utf-8"))
    benefit, built_in = kept["findings"]["benefit"], resolved("")
    change = benefit["beside_today"]["tables"]["change"]
    measured = {each.input: each for each in built_in.settings.range if each.law == "measured"}
    for name in RATES:
        assert getattr(built_in.case.today, name) == pytest.approx(
            benefit["variants"]["today"]["rates"][name]["value"], rel=1e-3
        )
        told = change[name]
        assert getattr(built_in.case.change, name) == pytest.approx(told["value"], rel=1e-3)
        each = measured[f"change.{name}"]
        assert (each.low, each.high) == pytest.approx((told["low95"], told["high95"]), rel=1e-3)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (
            "[service]\nsimulated_requests = 10000000\n",
            "service.simulated_requests is 10000000; that takes about 1 min",
        ),
        (
            "[uncertainty]\ndraws = 1000000\n",
            "uncertainty.draws is 1000000; that takes about 3 min; a number up to 300000",
        ),
        (
            "[uncertainty]\nsobol_points = 65536\n",
            "uncertainty.sobol_points is 65536; that takes about 4 min; a number",
        ),
    ],
)
def test_work_without_end_is_told_before_it_begins(text: str, words: str) -> None:
    (told,) = (each for each in resolved(text).head.warnings if "takes about" in each)
    assert told.startswith(words)


def test_amounts_that_are_not_given_in_a_currency_of_ones_own_are_told() -> None:
    """Those alone: none where the currency is the usual one, or where all of them are given."""
    assert not resolved('[prices]\ncurrency = "EUR"\nper_car = 1.0\n').head.warnings
    (told,) = resolved('[prices]\ncurrency = "GEL"\nper_car = 40000.0\n').head.warnings
    assert "prices.per_car_h" in told
    assert ", prices.per_car," not in told
    assert "reliability.unnoticed_per_h" in told
    assert "[[range]] of reliability.unnoticed_per_h" in told
    amounts = [each.key for each in resolved("").head.parameters if each.unit.startswith("currency")]
    own = [key.split(".") for key in amounts if not key.startswith("range.")]
    sections = {section: [key for at, key in own if at == section] for section, _ in own}
    lines = [f"[{section}]\n" + "".join(f"{key} = 9.0\n" for key in keys) for section, keys in sections.items()]
    given = "range = []\n" + "".join(lines).replace("[prices]\n", '[prices]\ncurrency = "GEL"\n')
    assert not [each for each in resolved(given).head.warnings if "currency" in each]


def test_a_number_that_is_given_without_a_range_is_certain() -> None:
    """So no draw is of the usual investment where there is another one."""
    assert "terms.investment" in resolved("").ranges
    assert "terms.investment" not in resolved("[terms]\ninvestment = 1e8\n").ranges
    ranged = '[terms]\ninvestment = 1e8\n[[range]]\ninput = "terms.investment"\nlow = 9e7\nhigh = 2e8\n'
    assert list(resolved(ranged).ranges) == ["terms.investment"]


def test_what_is_only_shown_changes_no_hash_and_numbers_do() -> None:
    built_in = resolved("").head
    assert resolved('title = "x"\n[output]\nplots = false\n').head.sha256 == built_in.sha256
    for text in ("[traffic]\ncars_per_day = 2999.0\n", TASK, '[reliability]\nstructure = "single"\n'):
        assert resolved(text).head.sha256 != built_in.sha256, text


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[service]\nspeed = 3.0\n", ("service.speed", "speed_op_s")),
        (TASK.replace("1.0", "-1.0"), ("task[0].rate_per_s is -1.0", "from 1e-09 to")),
        (TASK.replace("1.0", "0.0"), ("task[0].rate_per_s is 0.0", "from 1e-09 to")),
        (TASK + 'law = "erlang"\n', ("task a", "stages")),
        (TASK + TASK, ("task mix", "a is given twice")),
        ("[reliability]\ncommon_share = 1.5\n", ("reliability.common_share", "1")),
        ("[reliability]\ncheck_h = 3.0\n", ("reliability.check_interval_h is 2.5 h", "shorter than the check")),
        ("[rates.today]\ncars_per_h = 500.0\n" + SHARES, ("rates.today.gap_m is missing",)),
        ("[prices]\nper_car = -1.0\n", ("prices.per_car",)),
        ('[[range]]\ninput = "prices.car"\nlow = 1.0\nhigh = 2.0\n', ("'prices.car'", "per_car_h")),
        ('[[range]]\ninput = "prices.currency"\nlow = 1.0\nhigh = 2.0\n', ("'prices.currency'", "per_car")),
        ('[[range]]\ninput = "price.per_car"\nlow = 1.0\nhigh = 2.0\n', ("'price.per_car'", "prices.")),
        ('[[range]]\ninput = "prices.per_car"\nlow = 2.0\nhigh = 1.0\n', ("lognormal", "2.0")),
        (
            '[[range]]\ninput = "prices.per_car"\nlaw = "triangular"\nlow = 1.0\nhigh = 2.0\n',
            ("prices.per_car", "mode"),
        ),
        ("[uncertainty]\nsobol_points = 100\n", ("uncertainty.sobol_points is 100", "power of 2")),
        ('[rates]\ntoday_trial = "x"\n', ("today_trial and new_trial",)),
        ('[rates]\ntoday_trial = "x"\nnew_trial = "y"\n', ("rates.today_trial", "inputs/config.toml")),
        ('hump = "larg"\n', ("hump", "larg")),
    ],
)
def test_a_fault_is_one_sentence_with_its_key(text: str, words: tuple[str, ...]) -> None:
    with pytest.raises(InputError) as caught:
        resolved(text)
    (said,) = caught.value.sentences
    assert said.startswith("c.toml")
    for word in words:
        assert word in said, said


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[service]\nspeed_op_s = 6000.0\n", ("the computer is overloaded", "10 % more")),
        ("[traffic]\ncars_per_day = 30000.0\n", ("overloaded",)),
    ],
)
def test_an_overload_says_by_how_much(text: str, words: tuple[str, ...]) -> None:
    config = resolved(FEW + text)
    with pytest.raises(InputError) as caught, in_file(config.place, lambda sentence: sentence):
        computer_results(config)
    (said,) = caught.value.sentences
    for word in words:
        assert word in said, said
