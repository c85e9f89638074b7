"""Charts of drifts.

Page's sums: by hand, their rate of false alarms against the bound, and one pass that is far off.
The picture and the sheet of a watch: a limit is drawn where one decides, and nowhere else; no cell is a formula.
"""

from __future__ import annotations

import csv
import io
import math
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.colors import same_color
from matplotlib.lines import Line2D
from scipy.stats import chi2

from synth.frame.exhibits import Chart, Table
from synth.frame.sheet import to_csv
from synth.logs.drift.causes import TIMES, Cause, Remedy
from synth.logs.drift.charts import FEWEST, MOST, WINDOW, charts_of, limit_of, page_sums, running_medians, steps_of
from synth.logs.drift.diagnosis import DriftSize, diagnosed
from synth.logs.drift.evidence import Evidence
from synth.logs.drift.pictures import control_charts
from synth.logs.drift.shown import MARKED, charts, drifted, tiles
from synth.logs.drift.watch import Drift, Watch, cost_of
from synth.logs.fitting_passes import fitting_passes
from synth.retarder.configuration.config_file import load_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from tests.tuning_tables.pass_log.sample_logs import sample_log
from tuning_tables.pass_log.pass_log import PassLog


def normal_evidence(x: np.ndarray) -> Evidence:
    """Exact: observations (m,) of N(0, 1), drifts of the mean to log(size)."""
    sizes = (math.exp(-1.0), 1.0, math.exp(1.0))
    cause = Cause("mean", "mean", ("mean",), TIMES, sizes, (sizes[0], sizes[2]), Remedy.RETUNE, "")
    d = np.log(sizes)
    return Evidence((cause,), (x[:, None] * d - 0.5 * d**2,), np.zeros(len(x)))


def test_sums_by_hand() -> None:
    steps = np.array([[1.0], [-2.0], [3.0], [-1.0], [2.0]])
    assert page_sums(steps)[:, 0].tolist() == [1.0, 0.0, 3.0, 2.0, 4.0]
    assert page_sums(-steps)[:, 0].tolist() == [0.0, 2.0, 0.0, 1.0, 0.0]


def test_the_rate_of_false_alarms_of_an_exact_likelihood_keeps_the_bound() -> None:
    """At a low limit, where there are enough of them: e^-h for each chart."""
    rng = np.random.default_rng(5)
    steps, limit, lanes, length = steps_of(normal_evidence(rng.standard_normal(400_000))), limit_of(2, 100.0), 400, 1000
    lanes_of = steps.reshape(length, lanes, 2)
    sums, alarms = np.zeros((lanes, 2)), 0
    for step in lanes_of:
        sums = np.maximum(sums + step, 0.0)
        over = (sums >= limit).any(axis=1)
        alarms += int(over.sum())
        sums[over] = 0.0
    most = chi2.ppf(0.9999, 2 * alarms + 2) / 2.0 / (lanes * length)
    assert alarms > 100
    assert most <= 0.01, "the bound does not hold"
    assert alarms / (lanes * length) > 0.01 / 50.0, "this test could not fail"


def test_a_pass_far_off_gives_no_alarm_and_a_drift_does() -> None:
    x = np.zeros(60)
    x[30] = 1000.0
    assert charts_of(normal_evidence(x)).alarm is None
    x[30:] = 1.0
    charts = charts_of(normal_evidence(x))
    # 0.5 a pass since the drift; before it the sum stays at 0.
    first = 30 + math.ceil(charts.limit / 0.5) - 1
    assert charts.alarm == (first, 1)
    assert charts.zero_before(first, 1) == 29
    assert limit_of(20) > 3 * MOST


def test_a_running_median_follows_a_shift_and_not_a_few_cuts_out_of_brake() -> None:
    errors = np.concatenate((np.tile([-0.1, 0.1, 0.0, 0.0], 25), np.full(60, 0.2)))
    errors[[20, 21, 40, 60, 80]] = 1.5
    medians = running_medians(errors)
    assert np.isnan(medians[: FEWEST - 1]).all()
    assert np.abs(medians[FEWEST - 1 : 100]).max() <= 0.1
    assert medians[100 + WINDOW :].tolist() == [0.2] * (60 - WINDOW)


PASSES, SHIFT = 120, 60
FULL = (0, 31, 77)
"""Passes that leave far too fast with all the brake there is."""


@pytest.fixture(scope="module")
def config() -> ResolvedConfig:
    return load_config(None)


def log_of() -> PassLog:
    log = sample_log(PASSES, 8)
    stage = log.stage.copy()
    for number in FULL:
        stage[log.rows(number)] = 4
    ids = ["=HYPERLINK(1)", "+1-2", "@a", "-b", "+15", *log.cut_id[5:]]
    return replace(log, stage=stage, cut_id=tuple(ids), target_m_s=np.full(PASSES, 2.0))


def watch_of(config: ResolvedConfig, drifts: bool) -> Watch:
    """By hand: two causes with sums of their own, which a shift after `SHIFT` passes takes over the limit."""
    rng, since = np.random.default_rng(2), np.arange(PASSES) >= SHIFT
    shifts = (1.5, 0.2) if drifts else (0.0, 0.0)
    one, other = (normal_evidence(shift * since + rng.normal(0.0, 0.5, PASSES)) for shift in shifts)
    causes = (one.causes[0], replace(other.causes[0], name="other"))
    evidence = replace(one, causes=causes, ratios=(*one.ratios, *other.ratios))
    charts = charts_of(evidence)
    errors = rng.normal(0.0, 0.03, PASSES)
    errors[list(FULL)] = 1.2
    passes = fitting_passes(log_of(), config.plants(), "test")
    found, drift = diagnosed(evidence, charts), None
    assert (found is not None) == drifts
    if found is not None:
        drift = Drift(found, DriftSize(1.0, 0.9, 1.1), PASSES - 1, cost_of(errors[:SHIFT]), cost_of(errors[SHIFT:]))
    return Watch(passes, np.arange(PASSES), evidence, charts, errors, drift)


def levels(axes: Axes) -> list[float]:
    """Heights of all horizontal lines across a panel, and of the edges of all bands."""
    lines = [np.asarray(line.get_ydata(), dtype=float) for line in axes.lines if line.get_linestyle() != "None"]
    bands = [path.vertices for part in axes.collections for path in part.get_paths()]
    bands += [patch.get_path().vertices for patch in axes.patches]
    level = [float(y[0]) for y in lines if len(set(y.tolist())) == 1]
    return level + [float(y) for band in bands for y in np.asarray(band)[:, 1]]


def highest(axes: Axes, limit: float) -> float:
    """Of what is drawn in a panel, but for the limit itself and vertical lines."""
    drawn = [np.asarray(line.get_ydata(), dtype=float) for line in axes.lines if line.get_label() not in MARKS]
    return max(float(y.max()) for y in drawn if not (y == limit).all())


MARKS = ("beginning of the drift", "alarm")


@pytest.mark.parametrize("drifts", [False, True])
def test_the_limits_drawn_are_those_that_decide(config: ResolvedConfig, drifts: bool) -> None:
    found = watch_of(config, drifts)
    sums, *exits = control_charts(found).axes
    assert levels(sums) == [found.charts.limit]
    assert [level for axes in exits for level in levels(axes)] == []
    assert (highest(sums, found.charts.limit) >= found.charts.limit) == drifts == (found.drift is not None)
    assert sums.get_ylim()[1] > found.charts.limit
    marked = {str(line.get_label()) for line in sums.lines} & set(MARKS)
    assert marked == (set(MARKS) if drifts else set())


def test_cuts_out_of_brake_are_marked_and_move_no_median(config: ResolvedConfig) -> None:
    found = watch_of(config, False)
    panels = control_charts(found).axes[1:]
    assert len(panels) == 3
    triangles: list[Line2D] = [line for axes in panels for line in axes.lines if line.get_marker() == "^"]
    assert sorted(int(x) for line in triangles for x in np.asarray(line.get_xdata())) == [each + 1 for each in FULL]
    hollow = [line for line in triangles if same_color(line.get_markerfacecolor(), "white")]
    assert sum(len(np.asarray(line.get_xdata())) for line in hollow) == len(FULL)
    assert {axes.get_ylim() for axes in panels} == {panels[0].get_ylim()}
    assert panels[0].get_ylim()[1] < 0.3
    for each in found.exits:
        assert np.nanmax(np.abs(each.medians_m_s)) < 0.03


@pytest.mark.parametrize("drifts", [False, True])
def test_marks_and_causes_are_told_where_there_is_a_drift(config: ResolvedConfig, drifts: bool) -> None:
    found = watch_of(config, drifts)
    (chart,) = (each for each in charts(found) if isinstance(each, Chart))
    assert chart.caption.endswith(MARKED) == drifts
    tables = [each for each in drifted(found) if isinstance(each, Table)]
    assert [each.name for each in tables] == ["exits", "causes"] * drifts
    if found.drift is not None:
        first = tables[1].rows[0]
        assert (first["size"], first["drift"]) == (1.0, found.drift.diagnosis.first.cause.told(1.0))  # as above them


def test_a_drift_from_the_first_pass_on_has_no_figure_of_before(config: ResolvedConfig) -> None:
    found = watch_of(config, True)
    assert found.drift is not None
    begun = replace(found, drift=replace(found.drift, before=cost_of(np.empty(0))))
    assert "nan" not in " ".join(f"{each.figure} {each.of}" for each in tiles(begun).tiles)


def test_no_cut_id_is_a_formula_in_the_sheet(config: ResolvedConfig) -> None:
    (sheet,) = (each for each in charts(watch_of(config, False)) if isinstance(each, Table) and each.name == "passes")
    rows = list(csv.reader(io.StringIO(to_csv(sheet).decode(), newline="")))
    assert [row[1] for row in rows[1:7]] == ["'=HYPERLINK(1)", "'+1-2", "'@a", "'-b", "+15", "cut-00005"]
    assert [row[3] for row in rows[1:]] == [str(number in FULL).lower() for number in range(PASSES)]
    assert any(float(row[2]) < 0.0 for row in rows[1:])
