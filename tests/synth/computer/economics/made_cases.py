"""A yard, prices and hump figures for tests; all numbers are made up."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from synth.computer.economics.economic_case import EconomicCase, evaluated
from synth.computer.economics.investment import Terms
from synth.computer.economics.traffic import Handling, HumpChange, HumpRates, Prices, Traffic
from synth.frame.interval import Interval
from synth.frame.settings.settings_file import with_inputs
from synth.hump.rolling.outcomes import TrainOutcomes

PRICES = Prices(
    currency="EUR",
    per_locomotive_h=200.0,
    per_car_h=0.5,
    per_car=40_000.0,
    per_cargo_t=600.0,
    per_over_speed_to_1_5=2.0,
    per_over_speed_to_2=20.0,
    per_over_speed_above_2=300.0,
    per_catch_up=50.0,
    per_misrouted_cut=30.0,
    per_gap_m=0.01,
)
TRAFFIC = Traffic(
    cars_per_day=4800.0,
    cars_per_train=60.0,
    cars_per_train_std=12.0,
    cars_per_cut=1.8,
    arrival_scv=1.0,
    loaded_share=0.6,
    load_t=50.0,
)
HANDLING = Handling(
    between_trains_h=0.1,
    between_trains_std_h=0.03,
    locomotive_h_per_gap_m=1e-4,
    locomotive_h_per_misrouted_cut=0.25,
    blocked_share=0.3,
)
TODAY = HumpRates(
    cars_per_h=589.0,
    catch_ups=0.001,
    misrouted=0.0006,
    on_track=0.998,
    over_speeds_to_1_5=0.0271,
    over_speeds_to_2=0.0671,
    over_speeds_above_2=0.0185,
    gap_m=79.3,
)
CHANGE = HumpChange(
    cars_per_h=147.0,
    over_speeds_to_1_5=0.0085,
    over_speeds_to_2=-0.0035,
    over_speeds_above_2=-0.0076,
    gap_m=-16.4,
)
TERMS = Terms(
    investment=3e6,
    running_cost_per_year=50_000.0,
    fixed_saving_per_year=100_000.0,
    normative_efficiency_per_year=0.12,
    discount_per_year=0.08,
    years=15,
)
CASE = EconomicCase(prices=PRICES, traffic=TRAFFIC, handling=HANDLING, today=TODAY, change=CHANGE, terms=TERMS)


def made_outcomes(
    train_effect: np.ndarray,
    rates: HumpRates,
    seed: int,
    cuts: int = 40,
) -> TrainOutcomes:
    """Outcomes of trains whose figures have the expectations `rates`; `train_effect` (n,), mean 1, multiplies each
    train's gaps and times, and variants that share it are alike by train."""
    random, trains = np.random.default_rng(seed), len(train_effect)
    base = np.full(trains, cuts)
    cars = 1.8 * base.astype(float)
    judged = random.binomial(cuts, rates.on_track, trains)
    caught = random.binomial(base, rates.catch_ups)
    misrouted = random.binomial(caught, rates.misrouted / rates.catch_ups if rates.catch_ups else 0.0)
    shares = [rates.over_speeds_to_1_5, rates.over_speeds_to_2, rates.over_speeds_above_2]
    over = np.array([random.multinomial(n, [*shares, 1.0 - sum(shares)])[:3] for n in judged])
    none, wide = np.zeros(trains, dtype=np.int64), np.zeros((trains, 1), dtype=np.int64)
    return TrainOutcomes(
        train=np.arange(trains), shift=np.arange(trains), occupied=none.astype(float), pushed_up=none, pulled=none,
        no_room=none, cuts=base, cars=np.rint(cars).astype(np.int64),
        span_s=3600.0 * cars / rates.cars_per_h * train_effect * random.normal(1.0, 0.02, trains),
        span_m=15.0 * cars, span_cars=cars, misrouted=misrouted[:, None], contact=wide, unseparated=wide, foul=wide,
        caught=caught, caught_in_last=none, caught_on_track=none, stopped=none, judged=judged, overspeed=over,
        gap_m=rates.gap_m * judged * train_effect * random.normal(1.0, 0.05, trains),
        speed_bins=wide, gap_bins=wide, passes=wide, strokes=wide, error2_m2_s2=wide.astype(float),
        short=wide, at_lowest=wide, commanded=wide[:, :, None], commands_m_s=wide[:, :, None].astype(float),
        tightest_s=none.astype(float), tightest_at=none, tightest_ahead=none, tightest_behind=none,
    )  # fmt: skip


def case_figures(case: EconomicCase, inputs: Mapping[str, float]) -> dict[str, float]:
    """The figures of `case` with some of its inputs changed."""
    return evaluated(with_inputs(case, inputs)).figures()


def half95(found: Interval) -> float:
    """Half the width of the interval."""
    return 0.5 * (found.high95 - found.low95)
