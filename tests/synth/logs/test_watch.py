"""The watch names what was changed, on seeded logs of a table in the closed loop; a day's log through the command."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from scripts.studies.cases import tuned_table
from scripts.studies.watch.night import CHANGES, GAUGE, IN_ORDER, LIGHT, Change, simulated
from synth.cli import main
from synth.logs import unknowns as asked
from synth.logs.drift.causes import causes_of
from synth.logs.drift.diagnosis import drift_size
from synth.logs.drift.evidence import configured, evidence_of
from synth.logs.drift.watch import Watch, watch
from synth.logs.fitting_passes import FittingPasses, fitting_passes
from synth.logs.likelihood import likelihood_of
from synth.retarder.configuration.config_file import load_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from tuning_tables import ControllerTable
from tuning_tables.pass_log.log_files import write_log
from tuning_tables.pass_log.pass_log import PassLog, join_logs, one_after_the_other

CALM = 60
SLOW_EXHAUST, BIASED = CHANGES[2:4]


@pytest.fixture(scope="module")
def config() -> ResolvedConfig:
    return load_config(None)


@pytest.fixture(scope="module")
def table(config: ResolvedConfig) -> ControllerTable:
    label, plant = config.plants()[0]
    return tuned_table(config, plant, config.targets_of(label)[0])


def day(config: ResolvedConfig, table: ControllerTable, change: Change, changed: int) -> PassLog:
    """Passes in order, then changed ones."""
    tables = [(config.plants()[0][1], table)]
    logs = [simulated(tables, IN_ORDER, CALM, 3, GAUGE), simulated(tables, change, changed, 4, GAUGE)]
    log = one_after_the_other(join_logs(logs), 30.0)
    return replace(log, cut_id=tuple(f"cut-{number}" for number in range(len(log))))


def watched(config: ResolvedConfig, log: PassLog) -> Watch:
    passes = fitting_passes(log, config.plants(), "the test")
    values, slope_key = configured(passes, config.parameters)
    return watch(passes, values, slope_key)


@pytest.mark.long
@pytest.mark.parametrize(("change", "size"), [(0, 0.7), (2, 1.5), (3, 0.1)])
def test_what_was_changed_is_named_with_its_size(
    config: ResolvedConfig, table: ControllerTable, change: int, size: float
) -> None:
    found = watched(config, day(config, table, CHANGES[change], 80)).drift
    assert found is not None
    diagnosis = found.diagnosis
    assert diagnosis.decided
    assert diagnosis.first.cause.name == CHANGES[change].cause
    assert CALM <= diagnosis.alarm <= CALM + 40
    assert diagnosis.begins95[0] <= CALM <= diagnosis.begins95[1]
    # Twice the half width: a test for a blunder, not for the coverage.
    middle, half = 0.5 * (found.size.low95 + found.size.high95), 0.5 * (found.size.high95 - found.size.low95)
    assert abs(middle - size) < max(2.0 * half, 0.01 * size)
    assert found.before.passes == diagnosis.first.begin
    assert found.after.rms_m_s > found.before.rms_m_s


def test_passes_in_order_and_one_outlier_give_no_alarm(config: ResolvedConfig, table: ControllerTable) -> None:
    log = day(config, table, IN_ORDER, 60)
    speed, pressure = log.speed_m_s.copy(), log.pressure_kpa.copy()
    speed[log.rows(70)] += 0.5
    pressure[log.rows(80)] += 40.0
    found = watched(config, replace(log, speed_m_s=speed, pressure_kpa=pressure))
    assert found.drift is None
    assert max(row.max() for row in found.evidence.ratios) > 100.0, "there is no outlier"


def test_passes_stopped_by_hand_are_left_out(config: ResolvedConfig, table: ControllerTable) -> None:
    log = day(config, table, IN_ORDER, 10)
    by_hand = np.arange(len(log)) % 7 == 0
    found = watched(config, replace(log, stopped_by_hand=by_hand))
    assert found.number_of.tolist() == np.flatnonzero(~by_hand).tolist()


def some(config: ResolvedConfig, table: ControllerTable) -> tuple[FittingPasses, dict[str, float], str]:
    passes = fitting_passes(day(config, table, IN_ORDER, 2).taken(np.arange(5)), config.plants(), "the test")
    return passes, *configured(passes, config.parameters)


def test_every_cause_of_the_study_is_watched(config: ResolvedConfig, table: ControllerTable) -> None:
    """But for the friction of one category: all passes here are of one."""
    passes, values, slope_key = some(config, table)
    causes = causes_of(passes, values, slope_key)
    assert {change.cause for change in CHANGES} - {f"friction of {LIGHT}"} <= {cause.name for cause in causes}
    for cause, ratios in zip(causes, evidence_of(passes, values, causes, slope_key).ratios, strict=True):
        assert np.abs(ratios[:, [0, -1]]).min() > 0.0, cause.name


def test_ratios_are_those_of_the_likelihood(config: ResolvedConfig, table: ControllerTable) -> None:
    passes, values, slope_key = some(config, table)
    causes = causes_of(passes, values, slope_key)
    evidence = evidence_of(passes, values, causes, slope_key)
    like = likelihood_of(passes, slope_key)
    (fill,) = (i for i, cause in enumerate(causes) if cause.keys == (asked.FILL,))
    slower = values | {asked.FILL: values[asked.FILL] * causes[fill].sizes[-1]}
    wanted = like.at(slower).log_likelihood(5) - like.at(values).log_likelihood(5)
    assert evidence.ratios[fill][:, -1] == pytest.approx(wanted, rel=1e-9)
    # A gauge that shows 6 kPa less gains by a supposed offset of 6 what the log lost by it.
    (gauge,) = (i for i, cause in enumerate(causes) if cause.name == "gauge offset")
    log = passes.log
    off = likelihood_of(replace(passes, log=replace(log, pressure_kpa=log.pressure_kpa - 6.0)), slope_key)
    size = causes[gauge].sizes.index(6.0)
    wanted = off.at(values).log_likelihood(5) - like.at(values).log_likelihood(5)
    assert evidence.ratios[gauge][:, size] == pytest.approx(wanted, rel=1e-9)


def test_a_size_lies_where_the_likelihood_is_highest(config: ResolvedConfig, table: ControllerTable) -> None:
    passes, values, slope_key = some(config, table)
    (cause,) = (each for each in causes_of(passes, values, slope_key) if each.name == "friction")
    found = drift_size(passes, values, cause, slope_key, 1.0)
    like = likelihood_of(passes, slope_key)

    def total(size: float) -> float:
        return float(like.at(cause.moved(values, size)).log_likelihood(5).sum())

    grid = np.linspace(found.low95, found.high95, 41)
    assert total(found.size) >= max(map(total, grid.tolist())) - 1e-6
    for end in (found.low95, found.high95):
        assert total(found.size) - total(end) == pytest.approx(1.9207, abs=0.01)


def drift_in(folder: Path) -> dict[str, Any]:
    """The drift that a watch has told."""
    found: dict[str, Any] = json.loads((folder / "summary.json").read_text(encoding="utf-8"))["figures"]["drift"]
    return found


def test_the_command_tells_a_day(config: ResolvedConfig, table: ControllerTable, tmp_path: Path) -> None:
    log = tmp_path / "day.csv"
    write_log(day(config, table, SLOW_EXHAUST, 30), log)
    assert main(["watch", str(log), "-o", str(tmp_path / "out")]) == 1
    told = drift_in(tmp_path / "out")
    assert (told["cause"], told["remedy"]) == ("exhaust constant", "repair")
    assert told["begin"]["value"] == CALM + 1
    assert told["begin_cut"] == f"cut-{CALM}"
    assert told["size"]["n"] == 30
    assert "REPAIR" in (tmp_path / "out" / "report.html").read_text(encoding="utf-8")
    rows = (tmp_path / "out" / "sheets" / "passes.csv").read_text(encoding="utf-8").splitlines()
    assert len(rows) == CALM + 30 + 1
    assert math.isfinite(float(rows[-1].split(",")[2]))
    write_log(day(config, table, IN_ORDER, 30), log)
    assert main(["watch", str(log), "-o", str(tmp_path / "calm")]) == 0
    assert main(["watch", str(tmp_path / "none.csv"), "-o", str(tmp_path / "calm")]) == 2


@pytest.mark.long
def test_drifts_are_counted_from_the_reference(
    config: ResolvedConfig,
    table: ControllerTable,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The sensor always showed 0.1 m/s too much: that is no drift. From pass 31 on it shows the truth: that is one."""
    monkeypatch.setattr("synth.logs.drift.evidence.LEAST_REFERENCE", 60)  # these tell a bias well enough, and sooner
    tables = [(config.plants()[0][1], table)]
    reference, biased = (simulated(tables, BIASED, n, seed, None) for n, seed in ((60, 5), (30, 6)))
    log = one_after_the_other(join_logs([biased, simulated(tables, IN_ORDER, 30, 7, None)]), 30.0)
    write_log(replace(log, cut_id=tuple(f"cut-{number}" for number in range(len(log)))), tmp_path / "day.csv")
    write_log(reference, tmp_path / "reference.csv")

    def told(out: str, *words: str) -> dict[str, Any]:
        assert main(["watch", str(tmp_path / "day.csv"), *words, "-o", str(tmp_path / out)]) == 1
        drift = drift_in(tmp_path / out)
        assert drift["cause"] == "sensor bias"
        return drift

    against_reference = told("by-reference", "--reference", str(tmp_path / "reference.csv"))
    assert against_reference["begin"]["value"] == 31
    assert against_reference["size"]["value"] == pytest.approx(-0.1, abs=0.005)
    against_configuration = told("by-configuration")
    assert against_configuration["begin"]["value"] == 1
    assert against_configuration["size"]["value"] > 0.02

    write_log(reference.taken(np.arange(59)), tmp_path / "reference.csv")
    words = ["--reference", str(tmp_path / "reference.csv"), "-o", str(tmp_path / "short")]
    assert main(["watch", str(tmp_path / "day.csv"), *words]) == 2
    assert "the reference has 59 passes; give 60 or more" in capsys.readouterr().err
