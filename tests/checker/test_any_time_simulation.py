"""Tables of a tune for commands at any time: the drive, the coarse passes, and claims that are false."""

from __future__ import annotations

import dataclasses
import json
import math
from collections.abc import Callable
from pathlib import Path
from random import Random

import pytest

from plant_models.valve_drive import ValveDrive, drive_on, wait_after_command
from synth.checker.brake_drive import BrakeDrive
from synth.checker.claims import PredictionRatio, simulated_faults
from synth.checker.coarse_simulation import NotModelledError, decision, simulate
from synth.checker.finding import Kind
from synth.checker.float32 import decide, rises
from synth.checker.plant import Drive, Plant, config_sha256
from synth.checker.statistics import figures_of
from synth.checker.summary import Summary, read_summary
from synth.checker.table_reading import Table, read_table
from tests.checker.any_time_tables import approached, sloped, sound_table
from tests.checker.planted_fault import Document, alone, claim_in_summary, found, judged, look, rewrite
from tuning_tables import to_json

PREDICTION_RATIO = PredictionRatio(0.9, 1.35)
VALVES = ValveDrive(700.0, 0.0, 0.1, 0.2, 0.13, 0.3, 0.25, 15.0, 50.0)
DRIVE = Drive(700.0, 0.0, 0.1, 0.2, 0.13, 0.3, 0.25, 15.0, 0.0, 50.0)
STAGES_KPA = (0.0, 150.0, 300.0, 450.0, 600.0)


def table_of(out: Path) -> Table:
    return read_table(min((out / "tables").glob("*.json")).read_bytes())


@pytest.fixture(scope="module")
def summary(gauged_once: Path) -> Summary:
    return read_summary(gauged_once / "summary.json")


@pytest.fixture(scope="module")
def table(gauged_once: Path) -> Table:
    return table_of(gauged_once)


@pytest.fixture(scope="module")
def plant(summary: Summary, table: Table) -> Plant:
    return summary.plant(table)


@pytest.mark.parametrize("computing_s", [0.0, 0.02, 0.09])
def test_the_relay_commanded_at_any_time_is_the_documented_drive(computing_s: float) -> None:
    """Up and down at random, most samples in a transient: pressure at every sample, and the integral between."""
    chance, period, commands, in_transient = Random(3), 0.1, 0, 0
    relay, kpa, wait, stage = BrakeDrive(DRIVE, 15.0), 15.0, 0.0, 0
    for _ in range(2500):
        step = chance.choice([0, 0, 0, 1, -1]) if chance.random() < 0.5 else 0
        before, stage = stage, min(max(stage + step, 0), len(STAGES_KPA) - 1)
        if stage != before:
            commands += 1
            in_transient += not relay.resting
            relay.command(STAGES_KPA[stage], computing_s)
        coarse = math.fsum(relay.overpressure(period / 40) for _ in range(40)) / 40
        kpa, wait, first = drive_on(kpa, wait, STAGES_KPA[before], computing_s, VALVES)
        wait = wait_after_command(kpa, wait, STAGES_KPA[before], STAGES_KPA[stage], VALVES)
        kpa, wait, second = drive_on(kpa, wait, STAGES_KPA[stage], period - computing_s, VALVES)
        assert relay.pressure_kpa == pytest.approx(kpa, abs=1e-6)
        assert coarse == pytest.approx((first + second) / period, abs=0.15)
    assert commands > 200
    assert in_transient > 100


def test_a_command_back_before_the_valve_opens_leaves_the_pressure_as_it_is() -> None:
    relay = BrakeDrive(DRIVE, 135.0)
    relay.command(300.0, 0.02)
    relay.overpressure(0.1)
    before = relay.resting
    relay.command(150.0, 0.02)
    relay.overpressure(0.1)
    assert (before, relay.resting, relay.pressure_kpa) == (False, True, 135.0)


def test_the_rule_in_double_precision_is_the_rule() -> None:
    """Beside the surfaces by more than any rounding, at pressures within the range, outside, and without one."""
    made, chance = read_table(to_json(approached(sloped(sound_table("asked"))))), Random(5)
    answers = set()
    for _ in range(3000):
        stage, s, kpa = (
            chance.randrange(3),
            chance.uniform(-5.0, 22.0),
            chance.choice([chance.uniform(-50, 400), math.nan]),
        )
        v = chance.uniform(3.0, 5.5)
        added = rises(made.slopes, made.pressures_kpa, made.top_stage, stage, kpa)
        answer = decide(made.lines, made.path_m, made.entrance_stage, made.farthest, stage, s, v, added)
        assert decision(made, stage, s, v, kpa) == answer
        answers.add((stage, answer))
    assert len(answers) == 7


def test_agrees_with_the_production_simulator(any_time_once: Path) -> None:
    """Within four standard errors and two percent of coarseness, so does the number of switchings within 3 %."""
    each = table_of(any_time_once)
    assert each.validated_rms_m_s is not None
    assert each.validated_ci95_m_s is not None
    coarse = simulate(read_summary(any_time_once / "summary.json").plant(each), each, 2000, 9)
    figures = figures_of(coarse, each.target_m_s)
    own = figures.square_std / figures.mean_square / 2.0 / math.sqrt(figures.passes)
    stated = math.log(each.validated_ci95_m_s[1] / each.validated_ci95_m_s[0]) / 2.0 / 1.96
    assert own < 0.05
    apart = math.log(figures.rms_m_s / each.validated_rms_m_s)
    assert abs(apart) < 4.0 * math.hypot(own, stated) + 0.02
    assert figures.switchings == pytest.approx(each.switchings, rel=0.03)
    assert figures.bias_m_s == pytest.approx(each.bias_m_s, abs=0.1 * each.validated_rms_m_s + 0.002)


def at_rest(table: Table) -> Table:
    return dataclasses.replace(table, at_any_time=False)


def without_gauge(table: Table) -> Table:
    return dataclasses.replace(table, slopes=((None, None),) * len(table.slopes))


@pytest.mark.parametrize("otherwise", [at_rest, without_gauge])
def test_a_table_that_is_asked_otherwise_would_be_doubted(
    plant: Plant, table: Table, otherwise: Callable[[Table], Table]
) -> None:
    figures = figures_of(simulate(plant, otherwise(table), 300, 1), table.target_m_s)
    assert figures.rms_m_s > 1.3 * table.predicted_rms_m_s
    assert any("more than" in sentence for sentence in simulated_faults(table, figures, PREDICTION_RATIO))


def claimed(out: Path, change: Callable[[Document], None]) -> Path:
    """The table with `change` done to it, and the figures in the summary changed alike."""
    file = alone(out)
    rewrite(file, change)
    claim_in_summary(out, json.loads(file.read_text(encoding="utf-8")))
    return file


def better_prediction(document: Document) -> None:
    for name in ("rms_m_s", "bias_m_s"):
        document["predicted"][name] *= 0.7


def test_a_prediction_at_seven_tenths_contradicts_the_validation(gauged: Path) -> None:
    assert found(judged(claimed(gauged, better_prediction)), Kind.CLAIM, "does not agree with the validated one")


def plain(document: Document) -> None:
    """At rest."""
    no_gauge(document)
    document["decisions"] = "at_rest"


def no_gauge(document: Document) -> None:
    for stage in document["stages"]:
        stage["lower_slope_m_s_per_kpa"] = stage["upper_slope_m_s_per_kpa"] = None


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (plain, "asks for commands 'any_time', but it is for commands 'at_rest'"),
        (no_gauge, "says of the pressure 'gauge', but it says 'none'"),
    ],
)
def test_a_table_for_another_regulator_is_found(gauged: Path, change: Callable[[Document], None], words: str) -> None:
    file = alone(gauged)
    rewrite(file, change)
    assert found(look(file), Kind.DISAGREES, words)


def test_a_table_at_any_time_of_a_tune_at_rest_is_found(tuned: Path) -> None:
    """Configurations of tunes at rest say nothing of commands."""
    file = alone(tuned)
    rewrite(file, lambda document: document.update(decisions="at_any_time"))
    assert found(look(file), Kind.DISAGREES, "asks for commands 'at_rest', but it is for commands 'any_time'")


@pytest.mark.parametrize(
    ("section", "key", "value"), [("pneumatics", "closing_delay_s", 0.02), ("sensor", "computing_delay_s", 0.1)]
)
def test_what_is_not_modelled_is_said_and_not_passed(gauged: Path, section: str, key: str, value: float) -> None:
    file = alone(gauged)
    summary = json.loads((gauged / "summary.json").read_text(encoding="utf-8"))
    config = summary["config"]
    (config["retarder"]["pneumatics"] if section == "pneumatics" else config[section])[key] = value
    sha256 = summary["generator"]["config_sha256"] = config_sha256(config)
    (gauged / "summary.json").write_text(json.dumps(summary, ensure_ascii=False), encoding="utf-8")
    rewrite(file, lambda document: document["generator"].update(config_sha256=sha256))
    if section == "sensor":
        assert found(judged(file), Kind.DISAGREES, r"other computing delay: 0\.1, not 0\.02")
        rewrite(file, lambda document: document["clock"].update({key: value}))
    verdict = judged(file)
    assert found(
        verdict, Kind.CLAIM, "cannot be confirmed: commands at any time are modelled only for valves that close"
    )
    (each,) = verdict.tables
    assert each.figures is None
    assert str(each.skipped).startswith("commands at any time are modelled only")


def test_at_rest_late_valves_are_modelled(plant: Plant, table: Table) -> None:
    late = dataclasses.replace(plant, drive=dataclasses.replace(plant.drive, closing_delay_s=0.02))
    with pytest.raises(NotModelledError):
        simulate(late, table, 3, 1)
    assert len(simulate(late, at_rest(table), 3, 1).exit_m_s) == 3
