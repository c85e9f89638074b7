"""What a drift costs: only its retarder lets cuts go otherwise, and intervals hold the truth, few passes or many."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from plant_models.frozen_arrays import Floats
from synth.hump.configuration.trial_file import parse_trial_file
from synth.hump.trial.made_trial import brake_of, made_trial
from synth.hump.trial.resolved_trial import ResolvedTrial, resolve_trial
from synth.hump.watching.drift_cost import (
    Difference,
    MeasuredRetarder,
    Retarder,
    difference,
    drift_cost,
)
from synth.hump.watching.settings import CostSettings
from tests.synth.hump.trains.conftest import arriving
from tests.system.test_hump_trials import SMALL

PARK = 421


@pytest.fixture(scope="module")
def config() -> ResolvedTrial:
    return resolve_trial(parse_trial_file(SMALL, "the test"))


def test_its_retarder_alone_lets_cuts_go_otherwise(config: ResolvedTrial) -> None:
    others, brake = made_trial(config).positions[2], brake_of(config.positions[2], config)
    coming = arriving(40, commanded_m_s=6.0)
    errors = np.tile([0.2, 0.3], (40, 1))
    own = MeasuredRetarder(others, 401, errors, brake).passed(coming)
    assert set(np.round(own.exit_m_s - coming.commanded_m_s, 9)) == {0.2, 0.3}
    another = MeasuredRetarder(others, PARK, errors, brake).passed(coming)
    for name, values in vars(others.passed(coming)).items():
        np.testing.assert_array_equal(getattr(another, name), values)


def test_faster_exits_cost_over_speeds_and_slower_ones_gaps(config: ResolvedTrial) -> None:
    retarder = Retarder(made_trial(config), PARK, 2, brake_of(config.positions[2], config))
    calm, trains = np.linspace(-0.05, 0.05, 40), 60
    found = {shift: drift_cost(retarder, calm, calm + shift, trains) for shift in (-0.8, 0.0, 0.8)}
    fast, slow, none = found[0.8], found[-0.8], found[0.0]
    assert fast is not None
    assert slow is not None
    assert none is not None
    assert fast.overspeeds_per_hour.told.low95 > 0.0
    assert slow.gap_m_per_hour.told.low95 > 0.0
    for each in vars(none).values():
        assert each.told.low95 < 0.0 < each.told.high95
    weights = CostSettings(cars_per_overspeed=1.0, cars_per_gap_m=0.0)
    assert fast.weight_per_hour(weights).above(slow.weight_per_hour(weights))
    assert not none.weight_per_hour(weights).above(slow.weight_per_hour(weights))
    assert drift_cost(retarder, calm[:9], calm, trains) is None


@dataclass(frozen=True)
class Hours:
    """Trains of an hour each, of which nothing else is asked."""

    count: int
    cost: Floats

    @property
    def span_s(self) -> Floats:
        """Of each train."""
        return np.full(self.count, 3600.0)

    @property
    def shift(self) -> Any:
        """Each is one of its own."""
        return np.arange(self.count)

    def __len__(self) -> int:
        return self.count


@pytest.mark.parametrize("passes", [12, 200])
def test_an_interval_holds_the_cost_as_often_as_it_says(passes: int) -> None:
    """The cost of a train is 3 times its mean error, and noise: nothing but that mean is known badly."""
    rng, trains, held = np.random.default_rng(8), 100, 0
    for _ in range(400):
        measured = rng.normal(0.2, 0.3, passes)
        drawn = measured[rng.integers(0, passes, (trains, passes))]
        law = np.stack((drawn.mean(axis=1), drawn.std(axis=1)), axis=1)
        cost = 3.0 * law[:, 0] + rng.normal(0.0, 0.2, trains)
        sides: Any = [Hours(trains, np.zeros(trains)), Hours(trains, cost)]
        told: Difference = difference(sides, lambda each: each.cost, law, 0.0)  # type: ignore[attr-defined]
        held += told.told.low95 <= 0.6 <= told.told.high95
    assert 0.91 < held / 400 < 0.985
