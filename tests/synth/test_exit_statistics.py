"""Figures of cases: of a sample, against a reference, by price, by entry speed, and forecast.

Figures of quality against their definitions; exact limits of a probability.
Regret is told against a reference that nothing beats which is not told the friction.
What less time costs, from figures that are made up: which price is nearly free, and where it is told.
Entry speeds that a position can serve.
Commands that the noise of a radar makes, forecast without sampling, against passes with and without the noise.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import asdict, replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats

from plant_models import EntrySpeed, Plant
from synth.frame.exhibits import Chart, Sentence, Table
from synth.retarder.case_result import PRICES_M2_S3, ParetoFront, ParetoPoint, nearly_free, told
from synth.retarder.comparison.served_entry import ENTRY_PASSES, ENTRY_POINTS, entry_sweep, feasibility_of, served
from synth.retarder.loops.control_loop import command_forecast
from synth.retarder.pictures.accuracy import pareto_fronts
from synth.retarder.shown.pictures import fronts
from synth.retarder.shown.results import NO_REGRET, overall, remarks
from synth.simulation.closed_loop import TableController, close_loop
from synth.simulation.common_passes import CommonPasses, common_passes
from synth.simulation.exit_statistics import brake_power, clopper_pearson, exit_statistics, rms_ratio, unavoidable_error
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import random_passes
from synth.simulation.stratified_passes import stratified_passes
from tests.synth.case_factory import make_case, make_sample
from tests.synth.test_control_system import table_for
from tests.synth.test_report import found_book
from tuning_tables import ControllerTable


def sample_of(speed: NDArray[np.float64], weight: NDArray[np.float64] | None = None) -> ExitSample:
    n = len(speed)
    switchings = np.full(n, 3, dtype=np.int32)
    return ExitSample(speed, speed == 0.0, switchings, np.full(n, 9.0), np.ones(n) if weight is None else weight)


def test_figures_of_a_sample() -> None:
    speed = np.tile([4.0, 4.4, 3.8, 0.0], 100)
    figures = exit_statistics(sample_of(speed), 4.0)
    assert figures.passes == 400
    assert figures.rms_m_s == pytest.approx(math.sqrt((0.16 + 0.04 + 16.0) / 4))
    assert figures.bias_m_s == pytest.approx(-0.95)
    assert (figures.overspeed, figures.stalled, figures.switchings) == (0.25, 0.25, 3.0)
    assert figures.rms_m_s**2 == pytest.approx(figures.bias_m_s**2 + figures.std_m_s**2)
    assert figures.switchings_ci95 == (3.0, 3.0)


def test_quantiles_and_zero_error() -> None:
    figures = exit_statistics(sample_of(3.0 + np.arange(1001) / 10_000), 3.0)
    assert (figures.p95_m_s, figures.p99_m_s) == pytest.approx((0.095, 0.099))
    least = exit_statistics(sample_of(3.0 + np.arange(200) / 1024), 3.0)  # that so many of them do not exceed
    assert (least.p95_m_s, least.p99_m_s) == pytest.approx((189 / 1024, 197 / 1024))
    exact = exit_statistics(sample_of(np.full(200, 3.0)), 3.0)
    assert exact.rms_ci95_m_s == (0.0, 0.0)


def test_every_interval_holds_its_figure_and_that_of_a_mean_is_students() -> None:
    rng = np.random.default_rng(8)
    sample = replace(sample_of(3.0 + 0.2 * rng.standard_normal(500)), switchings=rng.integers(1, 9, 500, np.int32))
    sample = replace(sample, stalled=rng.random(500) < 0.1, transit_time_s=rng.normal(9.0, 1.0, 500))
    figures = asdict(exit_statistics(sample, 3.0))
    intervals = {name.replace("_ci95", ""): ends for name, ends in figures.items() if "_ci95" in name}
    assert len(intervals) == 8
    for name, (low, high) in intervals.items():
        assert low < figures[name] < high, name
    means: dict[str, NDArray[Any]] = {"switchings": sample.switchings, "time_s": sample.transit_time_s}
    for name, values in {"bias_m_s": sample.exit_speed_m_s - 3.0, **means}.items():
        groups = values.reshape(5, 100).mean(axis=1)
        student = stats.t.interval(0.95, 4, groups.mean(), stats.sem(groups))
        assert intervals[name] == pytest.approx(student), name


def test_a_weight_counts_as_so_many_passes() -> None:
    """Passes of weight 2 against the same passes written out twice."""
    rng = np.random.default_rng(4)
    error = rng.normal(0.01, 0.05, 5000)
    twice = rng.random(5000) < 0.3
    weighted = exit_statistics(sample_of(3.0 + error, np.where(twice, 2.0, 1.0)), 3.0)
    written = exit_statistics(sample_of(3.0 + np.concatenate([error, error[twice]])), 3.0)
    for name in ("rms_m_s", "bias_m_s", "overspeed", "p95_m_s", "p99_m_s", "switchings"):
        assert getattr(weighted, name) == pytest.approx(getattr(written, name), abs=1e-9), name


def test_brake_power_parts_what_no_table_can_hold() -> None:
    speed = np.full(1000, 3.02)
    speed[::10] = 4.0
    full = np.where(speed > 3.9, 3.9, 2.0)
    power = brake_power(sample_of(speed), sample_of(full), 3.0)
    assert power.brake_saturated == pytest.approx(0.1)
    assert power.rms_within_m_s == pytest.approx(0.02)
    none = brake_power(sample_of(speed), sample_of(np.full(1000, 5.0)), 3.0)
    assert (none.brake_saturated, none.rms_within_m_s, none.rms_within_ci95_m_s) == (1.0, None, None)


def test_the_ratio_of_paired_samples() -> None:
    """A controller whose every error is twice another's has ratio 2 without any doubt."""
    rng = np.random.default_rng(6)
    one = sample_of(3.0 + 0.1 * rng.standard_normal(2000))
    other = replace(one, exit_speed_m_s=3.0 + 0.5 * (one.exit_speed_m_s - 3.0))
    ratio, (low, high) = rms_ratio(one, other, 3.0)
    assert ratio == pytest.approx(2.0)
    assert high - low == pytest.approx(0.0, abs=1e-9)


def test_the_interval_of_the_ratio_covers() -> None:
    hits = 0
    for seed in range(200):
        rng = np.random.default_rng(seed)
        wide, narrow = (sample_of(3.0 + std * rng.standard_normal(2000)) for std in (0.06, 0.05))
        low, high = rms_ratio(wide, narrow, 3.0)[1]
        hits += low < 1.2 < high
    assert 180 <= hits <= 199  # 95 % of 200, and four standard deviations


@pytest.mark.parametrize(("hits", "n"), [(0, 3000), (1, 20), (7, 100), (20, 20)])
def test_clopper_pearson_is_the_exact_interval(hits: int, n: int) -> None:
    exact = stats.binomtest(hits, n).proportion_ci(0.95, method="exact")
    assert clopper_pearson(hits, n) == pytest.approx((exact.low, exact.high), abs=1e-12)


def test_one_replicate_has_no_statistics() -> None:
    with pytest.raises(ValueError, match="at least 101"):
        exit_statistics(sample_of(np.full(100, 3.0)), 3.0)


@pytest.mark.parametrize(
    ("to_baseline", "to_table", "told"),
    [
        ((0.4, 0.6), (1.05, 1.10), True),
        ((0.98, 1.02), (0.99, 1.01), True),  # chance alone
        ((math.nan, math.nan), (1.05, 1.10), True),
        ((1.01, 1.05), (1.05, 1.10), False),  # a tuned law is better
        ((0.4, 0.6), (0.95, 0.99), False),  # the table is
    ],
)
def test_a_regulator_that_is_beaten_is_no_reference(
    to_baseline: tuple[float, float], to_table: tuple[float, float], told: bool
) -> None:
    found = make_case().comparison
    known = replace(found.friction_known, table_ratio_ci95=to_table)
    compared = replace(found, friction_known=known, baseline_ratio_ci95=to_baseline)
    assert compared.has_reference is told
    if told:
        assert (compared.regret, compared.regret_ci95) == (known.table_ratio, to_table)
    else:
        assert math.isnan(compared.regret)
        assert all(map(math.isnan, compared.regret_ci95))


def test_the_median_of_the_summary_is_over_cases_with_a_reference() -> None:
    case = make_case()
    beaten = replace(case, comparison=replace(case.comparison, baseline_ratio_ci95=(1.1, 1.2)))
    assert overall(found_book((case, beaten)))["median_regret"] == case.comparison.regret
    assert overall(found_book((beaten,)))["median_regret"] is None


def test_a_regret_that_is_left_out_is_explained() -> None:
    case = make_case()
    beaten = replace(case, comparison=replace(case.comparison, baseline_ratio_ci95=(1.1, 1.2)))
    assert NO_REGRET not in remarks(found_book((case,)))
    assert NO_REGRET in remarks(found_book((case, beaten)))


def made_front(label: str, ratios: tuple[float, ...], saved_s: tuple[float, ...]) -> ParetoFront:
    """A front of the first prices."""
    found = exit_statistics(make_sample(3.0, 0.03, 0), 3.0)
    points = tuple(
        ParetoPoint(
            price, replace(found, time_s=12.0 - saved, time_ci95_s=(11.9 - saved, 12.1 - saved)), 0.03, ratio,
            (ratio - 0.01, ratio + 0.01),
        )
        for price, ratio, saved in zip(PRICES_M2_S3, ratios, saved_s, strict=False)
    )  # fmt: skip
    return ParetoFront(label, 3.0, points)


FIRST = made_front("gondola-22t", (1.0, 0.99, 1.015, 1.03), (0.0, 0.1, 0.4, 0.9))
SECOND = made_front("gondola-85t", (1.0, 1.0, 1.01, 1.0), (0.0, 0.0, 0.02, 0.2))


def test_the_highest_price_that_is_nearly_free_in_all_cases_is_told() -> None:
    assert nearly_free([FIRST, SECOND]) == 3e-5
    assert told([FIRST, SECOND]) == (
        "A price of 3e-05 m2/s3 on a second makes no rms more than 1% larger beyond its 95 % interval, and changes "
        "the mean time in the position by -0.40 to -0.02 s (criterion.time_price_m2_s3)."
    )
    assert nearly_free([SECOND]) == 1e-4


def test_a_price_without_a_table_ends_it() -> None:
    points = tuple(each for each in FIRST.points if each.time_price_m2_s3 != 1e-5)
    assert nearly_free([replace(FIRST, points=points)]) == 0.0
    assert told([replace(FIRST, points=points)]).startswith("Already a price of 1e-05 m2/s3 on a second makes some rms")


def test_report_and_pictures_tell_it_where_it_was_asked_for() -> None:
    table, chart = (each for each in fronts([FIRST, SECOND]) if not isinstance(each, Sentence))
    assert isinstance(table, Table)
    assert [(row["label"], row["time_price_m2_s3"]) for row in table.rows] == [
        (front.label, price) for front in (FIRST, SECOND) for price in PRICES_M2_S3[:4]
    ]
    assert isinstance(chart, Chart)
    assert len(chart.draw().axes) == len(pareto_fronts([FIRST, SECOND]).axes)
    assert len(pareto_fronts([FIRST] * 4).axes) == 6


TARGET_M_S = 2.0


@pytest.fixture(scope="module")
def passes(plant_of: Callable[[float], Plant]) -> CommonPasses:
    return common_passes(plant_of(66.0), stratified_passes(3, 0, 2000))


def test_served_speeds_end_where_the_limit_is_met() -> None:
    entry = np.array([2.0, 3.0, 4.0, 5.0])
    assert served(entry, np.array([0.2, 0.05, 0.06, 0.16]), 0.1) == pytest.approx((2.0 + 2.0 / 3.0, 4.4))
    assert served(entry, np.array([0.02, 0.05, 0.06, 0.07]), 0.1) == (2.0, 5.0)
    assert served(entry, np.array([0.2, 0.3, 0.4, 0.5]), 0.1) is None


def test_the_error_at_an_entry_speed_is_that_of_cuts_that_all_enter_with_it(passes: CommonPasses) -> None:
    found = feasibility_of(entry_sweep(passes), TARGET_M_S, 0.05)
    assert len(found.entry_m_s) == ENTRY_POINTS
    for place in (ENTRY_POINTS // 2, ENTRY_POINTS - 1):
        speed = float(found.entry_m_s[place])
        plant = replace(passes.plant, entry=EntrySpeed(speed, speed))
        alone = common_passes(plant, passes.passes.part(0, ENTRY_PASSES)).exit_range
        exact = unavoidable_error(alone.slowest, alone.fastest, TARGET_M_S).rms_m_s
        assert exact > 0.0
        assert found.entry_rms_m_s[place] == pytest.approx(exact, rel=1e-9)


PASSES = 4000


def narrowed(table: ControllerTable, gap_m_s: float) -> ControllerTable:
    """The table with its raising lines `gap_m_s` above the lowering ones of the same stage, where it has both."""
    stages = []
    for each in table.stages:
        down, up = each.lower, each.upper
        if down is not None and up is not None:
            up = (down[0] + gap_m_s, *down[1:])
        stages.append(replace(each, upper=up))
    return replace(table, stages=tuple(stages))


@pytest.mark.parametrize("noise_m_s", [0.03, 0.12])
def test_the_forecast_is_what_passes_find(plant_52t: Plant, noise_m_s: float) -> None:
    """Within 3.5 standard errors and 3 % for the grid; the noise makes the more commands the larger it is."""
    plant = replace(plant_52t, sensor=replace(plant_52t.sensor, noise_m_s=noise_m_s))
    table = narrowed(table_for(plant), 0.25)
    forecast = command_forecast(table, plant)
    assert forecast is not None
    for sensor, expected in (
        (plant.sensor, forecast.commands),
        (replace(plant.sensor, noise_m_s=0.0), forecast.without_noise),
    ):
        loop = close_loop(replace(plant, sensor=sensor), len(table.stages))
        commands = loop.run(TableController(table), loop.draws(random_passes(5, 0, PASSES))).switchings
        error = float(commands.std()) / math.sqrt(PASSES)
        print(f"noise {sensor.noise_m_s}: forecast {expected:.3f} simulated {commands.mean():.3f} ± {error:.3f}")
        assert expected == pytest.approx(float(commands.mean()), abs=3.5 * error + 0.03 * float(commands.mean()))
    assert forecast.by_noise > (1.0 if noise_m_s > 0.1 else -0.1)
