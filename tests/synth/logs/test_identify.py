"""The command, and whether its tests of the model cry wolf."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import synth
from plant_models.pressure_gauge import USUAL_NOISE_KPA
from scripts.studies.identification.truths import Yard, text_of_classes
from synth.cli import main
from synth.logs.estimate import Estimate
from synth.logs.fitting_passes import FittingPasses
from synth.logs.identifiability import Finding, findings_of
from synth.logs.identify import Identified, fit
from synth.logs.identify_shown import bias_sentences
from synth.logs.residual_tests import MOTION, ResidualTest, residual_tests, wrong
from synth.logs.unknowns import BIAS, GAUGE_NOISE, RANGES, slope_of, unknowns_of
from synth.retarder.validation.options import ValidateOptions
from tuning_tables.pass_log.log_files import write_log


def test_the_model_holds_for_its_own_passes(passes: FittingPasses, found: Estimate) -> None:
    tests = residual_tests(passes, found, 2)
    assert len(tests) == 5
    assert wrong(tests) == ()
    assert all(abs(test.z) < 4.0 for test in tests)


def test_figures_and_frame_are_those_of_the_command(yard: Yard, passes: FittingPasses, found: Estimate) -> None:
    numbers = fit(passes, found.values, slope_of(unknowns_of(passes, yard.config.parameters)))
    result = Identified(yard.config, passes, found, findings_of(found), (), (), numbers, numbers)
    assert list(synth.figures(result)) == ["identify-numbers", "identify-pressures", "identify-friction"]
    frame = synth.to_pandas(result).set_index("key")
    for finding in result.findings:
        ends = frame.loc[finding.key, ["value_low95", "value_high95"]]
        assert tuple(ends) == finding.interval


def test_holm_stops_at_the_first_that_may_be_chance() -> None:
    ps = (0.0001, 0.004, 0.02, 0.5)
    tests = tuple(ResidualTest(MOTION, 0.0, (0.0, 0.0), 0.0, p) for p in reversed(ps))
    assert [test.p for test in wrong(tests)] == [0.0001]
    assert [test.p for test in wrong(tests[1:])] == [0.0001, 0.004]


def test_a_log_becomes_a_configuration(
    passes: FittingPasses, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "my.toml").write_text(text_of_classes() + "[output]\nplots = true\n", encoding="utf-8")
    write_log(passes.log, tmp_path / "day.csv")
    assert main(words(tmp_path)) == 0
    summary = json.loads((tmp_path / "out" / "summary.json").read_text(encoding="utf-8"))
    assert summary["figures"]["passes"] == len(passes)
    assert {"config.toml", "report.html", "plots/identify-numbers.svg"} <= summary["files"].keys()
    numbers = {each["key"]: each["value"] for each in summary["tables"]["numbers"]}
    assert numbers["sensor.noise_m_s"]["low95"] < 0.05 < numbers["sensor.noise_m_s"]["high95"]
    assert {each["n"] for each in numbers.values()} == {len(passes)}
    assert "identified from 80 passes" in (tmp_path / "out" / "config.toml").read_text(encoding="utf-8")
    report, printed = (tmp_path / "out" / "report.html").read_text(encoding="utf-8"), capsys.readouterr().out
    tests = summary["tables"]["tests"]
    assert [test["matters_from"] for test in tests] == [2.0, 5.0, 10.0, 0.01, 3.0]
    for test in tests:
        assert test["verdict"] in ("holds", "not decided")
        size = test["size"]
        told = f"{size['value']:+.2g} [{size['low95']:+.2g}, {size['high95']:+.2g}]"
        assert f'title="{told}"' in report
        (line,) = (line for line in printed.splitlines() if line.startswith(test["looks_for"]))
        half = max(size["high95"] - size["value"], size["value"] - size["low95"])
        assert f"{size['value']:+.2g} ±{half:.2g}" in line
        assert line.endswith(test["verdict"])
    assert "accepted: none of 5 tests says that the model does not hold" in printed


def test_a_rehearsal_and_its_identification_begin_with_one_gauge() -> None:
    default = ValidateOptions(source=Path("book.h5")).gauge_std_kpa
    assert default == RANGES[GAUGE_NOISE][0] == USUAL_NOISE_KPA


def words(folder: Path) -> list[str]:
    """What is typed where the log and the configuration are in `folder`."""
    return ["identify", str(folder / "day.csv"), "--config", str(folder / "my.toml"), "-o", str(folder / "out")]


def test_too_few_passes_are_refused(passes: FittingPasses, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "my.toml").write_text(text_of_classes(), encoding="utf-8")
    write_log(passes.log.taken(np.arange(12)), tmp_path / "day.csv")
    assert main(words(tmp_path)) == 2
    assert "the log has 12 sound passes; 40 are needed at least" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(("bias_m_s", "told"), [(0.002, False), (0.03, True), (-0.03, True)])
def test_a_sensor_is_to_be_adjusted_only_where_it_matters(bias_m_s: float, told: bool) -> None:
    finding = Finding(BIAS, "m/s", bias_m_s, (bias_m_s - 0.0005, bias_m_s + 0.0005), 0.0, 0.1, ())
    assert bool(list(bias_sentences([finding]))) == told
