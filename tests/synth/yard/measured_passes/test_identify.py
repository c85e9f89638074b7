"""The command, and whether its tests of the model cry wolf."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from synth.cli.identify import identify_command
from synth.faults.input_error import InputError
from synth.studies.identification.truths import text_of_classes
from synth.yard.measured_passes.estimate import Estimate
from synth.yard.measured_passes.fitting_passes import FittingPasses
from synth.yard.measured_passes.residual_tests import MOTION, ResidualTest, residual_tests, wrong
from tuning_tables.pass_log.log_files import write_log


def test_the_model_holds_for_its_own_passes(passes: FittingPasses, found: Estimate) -> None:
    tests = residual_tests(passes, found, 2)
    assert len(tests) == 5
    assert wrong(tests) == ()
    assert all(abs(test.z) < 4.0 for test in tests)


def test_holm_stops_at_the_first_that_may_be_chance() -> None:
    ps = (0.0001, 0.004, 0.02, 0.5)
    tests = tuple(ResidualTest(MOTION, 0.0, (0.0, 0.0), 0.0, p) for p in reversed(ps))
    assert [test.p for test in wrong(tests)] == [0.0001]
    assert [test.p for test in wrong(tests[1:])] == [0.0001, 0.004]


def test_a_log_becomes_a_configuration(passes: FittingPasses, tmp_path: Path) -> None:
    (tmp_path / "my.toml").write_text(text_of_classes() + "[output]\nplots = true\n", encoding="utf-8")
    write_log(passes.log, tmp_path / "day.csv")
    code = identify_command([tmp_path / "day.csv"], None, tmp_path / "my.toml", tmp_path / "out", as_json=False)
    assert code == 0
    summary = json.loads((tmp_path / "out" / "summary.json").read_text(encoding="utf-8"))
    assert summary["passes"] == len(passes)
    assert {"config.toml", "report.html", "plots/identify-numbers.png"} <= summary["files"].keys()
    numbers = {each["key"]: each for each in summary["numbers"]}
    low, high = numbers["sensor.noise_m_s"]["ci95"]
    assert low < 0.05 < high
    assert "identified from 80 passes" in (tmp_path / "out" / "config.toml").read_text(encoding="utf-8")


def test_too_few_passes_are_refused(passes: FittingPasses, tmp_path: Path) -> None:
    (tmp_path / "my.toml").write_text(text_of_classes(), encoding="utf-8")
    write_log(passes.log.taken(np.arange(12)), tmp_path / "day.csv")
    with pytest.raises(InputError, match="the log has 12 sound passes; 40 are needed at least"):
        identify_command([tmp_path / "day.csv"], None, tmp_path / "my.toml", tmp_path / "out", as_json=False)
