"""Identification: the command, its estimates, and its configuration.

The command, and whether its tests of the model cry wolf.
Estimates of a known plant, their derivatives, and what is done where the likelihood has an edge.
An identified configuration reads back with its numbers and their origins; what was not told stays assumed.
"""

from __future__ import annotations

import json
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import synth
from plant_models.library import POSITIONS
from plant_models.pressure_regulator import USUAL_NOISE_KPA
from scripts.studies.identification import TRUTHS, Yard, text_of_classes
from synth.cli import main
from synth.cli.type_template import type_toml
from synth.frame.faults import InputError
from synth.logs import unknowns as asked
from synth.logs.estimate import SIDE, Estimate, Side, estimate, posterior
from synth.logs.fitting_passes import FittingPasses
from synth.logs.identified_config import identified
from synth.logs.identify import Finding, Identified, findings_of, fit
from synth.logs.identify_shown import bias_sentences
from synth.logs.residual_tests import MOTION, ResidualTest, residual_tests, wrong
from synth.logs.unknowns import BIAS, GAUGE_NOISE, RANGES, slope_of, unknowns_of
from synth.retarder.configuration.config_file import ConfigSource, config_source, load_config, parse_config
from synth.retarder.validation.options import ValidateOptions
from synth.simulation.controllers import TableController
from tuning_tables import ControllerTable
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
    log = passes.log.taken(np.arange(len(passes) // 2))
    (tmp_path / "my.toml").write_text(text_of_classes() + "[output]\nplots = true\n", encoding="utf-8")
    write_log(log, tmp_path / "day.csv")
    assert main(words(tmp_path)) == 0
    summary = json.loads((tmp_path / "out" / "summary.json").read_text(encoding="utf-8"))
    assert summary["figures"]["passes"] == len(log)
    assert {"config.toml", "report.html", "plots/identify-numbers.svg"} <= summary["files"].keys()
    numbers = {each["key"]: each["value"] for each in summary["tables"]["numbers"]}
    assert numbers["sensor.noise_m_s"]["low95"] < 0.05 < numbers["sensor.noise_m_s"]["high95"]
    assert {each["n"] for each in numbers.values()} == {len(log)}
    assert "identified from 40 passes" in (tmp_path / "out" / "config.toml").read_text(encoding="utf-8")
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


def test_intervals_hold_the_truth_of_most_numbers(found: Estimate) -> None:
    truth = TRUTHS[0].values(tuple(unknown.key for unknown in found.unknowns))
    z = [
        (u - unknown.standing(truth[unknown.key])) / std
        for unknown, u, std in zip(found.unknowns, found.u, found.std, strict=True)
    ]
    assert np.sum(np.abs(z) < 1.96) >= len(z) - 3
    assert np.max(np.abs(z)) < 3.5


def test_scores_are_the_slope_of_the_likelihood(passes: FittingPasses, found: Estimate) -> None:
    target = posterior(passes, found.unknowns, 1)
    rng = np.random.default_rng(0)
    u = found.u + 0.3 * found.std * rng.standard_normal(len(found.u))
    gradient = target.gradient(u)
    for j in (0, 8, 11, 12):  # of the motion alone: those of the valves have edges
        step = np.zeros(len(u))
        step[j] = 1e-4
        slope = (target.value(u + step) - target.value(u - step)) / 2e-4
        assert abs(gradient[j] - slope) < 1e-3 * max(1.0, abs(slope))


def test_threads_change_nothing(passes: FittingPasses, found: Estimate, monkeypatch: pytest.MonkeyPatch) -> None:
    """An estimate is made of these alone. Four parts of the log, so that threads have something to do."""
    monkeypatch.setattr("synth.logs.estimate.CHUNK", 20)
    one, two = (posterior(passes, found.unknowns, threads) for threads in (1, 2))
    assert len(one.parts) == 4
    for u in (found.u, 0.5 * found.u):
        assert one.value(u) == two.value(u)
        by_one, by_two = (target.linearised_by(u, {asked.FILL: Side(*SIDE)}) for target in (one, two))
        assert by_one.log_likelihood == by_two.log_likelihood
        assert by_one.scores.tobytes() == by_two.scores.tobytes()
        assert by_one.information.tobytes() == by_two.information.tobytes()


def up_to_stage_1(controller: TableController) -> TableController:
    """A regulator whose commands go one stage."""
    table = controller.table
    assert isinstance(table, ControllerTable)
    stages = (each if each.k == 0 else replace(each, upper=None) for each in table.stages)
    return TableController(replace(table, stages=tuple(stages)))


@pytest.mark.long
def test_a_summit_on_an_edge_is_no_sharp_number(yard: Yard, found: Estimate) -> None:
    """Of a change to stage 1 the pressure rests before the next reading whatever the touch delay is, nearly.

    On the way to a higher stage a gauge is read that tells it.
    """
    low_yard = replace(yard, controllers={label: up_to_stage_1(each) for label, each in yard.controllers.items()})
    passes = low_yard.passes(TRUTHS[0], 80, 7)
    lowly = estimate(passes, unknowns_of(passes, yard.config.parameters), 2)
    widths = []
    for each in (lowly, found):
        (number,) = (i for i, unknown in enumerate(each.unknowns) if unknown.key == asked.TOUCH_DELAY)
        low, high = each.interval(number)
        widths.append(high - low)
    assert widths[0] > 0.01 > widths[1]


def test_without_gauge_and_with_path_from_speed_less_is_told(
    yard: Yard, passes: FittingPasses, found: Estimate
) -> None:
    blind = replace(passes.log, pressure_kpa=np.full(len(passes.log.time_s), np.nan), path_is_independent=False)
    some = replace(passes, log=blind)
    unknowns = unknowns_of(some, yard.config.parameters)
    keys = {unknown.key for unknown in unknowns}
    assert not keys & {asked.BIAS, asked.GAUGE_NOISE}
    left = {finding.key: finding.left for finding in findings_of(found)}
    blindly = {finding.key: finding for finding in findings_of(estimate(some, unknowns, 2))}
    for key in (asked.FILL, asked.EXHAUST, asked.BRAKE_DELAY, asked.RELEASE_DELAY):
        assert blindly[key].left > 5.0 * left[key]
    for key in (asked.COMMON_CV, asked.NOISE):
        assert blindly[key].identified
        assert blindly[key].left < 1.1 * left[key]


OWN = """library = ["types/"]
[position]
name = "our-site"
[[cut]]
label = "light"
car = "gondola-4"
mass_t = 22.0
targets_m_s = [3.0]
"""


def written(source: ConfigSource, folder: Path) -> Path:
    """The configuration as files."""
    for name, content in source.files("config.toml").items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(content)
    return folder / "config.toml"


def test_numbers_come_back_with_their_origin(passes: FittingPasses, found: Estimate, tmp_path: Path) -> None:
    (tmp_path / "asked.toml").write_text(text_of_classes(), encoding="utf-8")
    source = config_source(tmp_path / "asked.toml")
    new = identified(source, found, "80 passes")
    again = load_config(written(new, tmp_path / "out"))
    known = {value.key: value for value in again.parameters}
    assert again.sha256 == new.resolved().sha256
    for finding in findings_of(found):
        if finding.key in known and finding.identified:
            value = known[finding.key]
            assert value.value == pytest.approx(finding.value, rel=1e-5)
            assert value.source.startswith("identified from 80 passes, 95 % interval ")
            assert not value.assumed
        elif finding.key in known:
            assert known[finding.key].assumed
    means = {cut.cut.category: cut.resistance.mean_n_per_kn for cut in again.cuts}
    for category, mean in means.items():
        assert mean == pytest.approx(found.values[asked.RESISTANCE + category], rel=1e-5)


def test_own_types_go_with_the_configuration(passes: FittingPasses, found: Estimate, tmp_path: Path) -> None:
    (tmp_path / "types" / "positions").mkdir(parents=True)
    (tmp_path / "types" / "positions" / "our-site.toml").write_text(type_toml(POSITIONS, None), encoding="utf-8")
    (tmp_path / "own.toml").write_text(OWN, encoding="utf-8")
    source = config_source(tmp_path / "own.toml")
    path = written(identified(source, found, "80 passes"), tmp_path / "elsewhere")
    assert load_config(path).retarder.name == "our-site"
    assert tomllib.loads(path.read_text(encoding="utf-8"))["library"] == ["types/"]


def test_a_source_of_a_number_that_the_file_does_not_set_is_refused() -> None:
    text = '[friction]\ncommon_cv = 0.2\n[sources]\n"friction.path_std" = "measured"\n'
    with pytest.raises(InputError, match=r"sources has 'friction.path_std', which this file sets to no value"):
        parse_config(text, "my.toml")


def test_a_source_takes_the_place_of_the_assumption() -> None:
    text = '[friction]\ncommon_cv = 0.2\n[sources]\n"friction.common_cv" = "our log of May"\n'
    (value,) = (v for v in parse_config(text, "my.toml").parameters if v.key == "friction.common_cv")
    assert (value.source, value.assumed) == ("our log of May", False)
