"""The study of the reserve: what counts as a price, as worse, and as more cuts outside."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.typing import NDArray

from scripts.studies.estimator.reserve_findings import CaseRows, Excess, Reserves, Row
from scripts.studies.estimator.reserve_study import excess_outside
from scripts.studies.estimator.wrong import braking_otherwise
from synth.retarder.configuration.plant_parameter import nominal_value
from synth.retarder.configuration.plant_values import SLOPES
from synth.simulation.passes import ExitSample
from tests.synth.conftest import pilot_plant

FIRST = Row(
    mean_cv=0.0, rms_m_s=0.02, price=1.0, ratio=0.8, worst_plant="friction × 0.7", worst_ratio=1.2,
    worst_ci95=(1.19, 1.21), outside=(0.001, 0.002), most=Excess("friction × 0.7", (0.01, 0.02), 0.01, 0.001),
)  # fmt: skip
KEPT = replace(
    FIRST, mean_cv=0.1, price=1.02, worst_ratio=0.95, worst_ci95=(0.94, 0.96),
    most=Excess("as it is", (0.001, 0.001), 0.0001, 0.0002),
)  # fmt: skip


def found(row: Row) -> Reserves:
    return Reserves("0" * 64, 1, 400, 0.1, (CaseRows("36 t to 3 m/s", (FIRST, row)),))


def sample(exits: NDArray[np.float64]) -> ExitSample:
    n = len(exits)
    return ExitSample(exits, np.zeros(n, dtype=bool), np.zeros(n, dtype=np.int32), np.ones(n), np.full(n, 0.5))


def test_more_outside_is_counted_pass_by_pass_with_its_weight() -> None:
    """Of 1000 passes 40 more are outside, four in every replicate: no chance is left in it."""
    exits = np.full(1000, 3.0)
    exits[::50] = 3.5
    worse = exits.copy()
    worse[7::25] = 2.0
    more, half_width = excess_outside((sample(exits), sample(worse)), 3.0)
    assert more == pytest.approx(0.04)
    assert half_width == pytest.approx(0.0, abs=1e-12)
    assert excess_outside((sample(worse), sample(exits)), 3.0)[0] == pytest.approx(-0.04)


def test_a_reserve_that_keeps_its_limits_is_no_fault() -> None:
    assert found(KEPT).faults() == ()
    (curve,) = [t for name, t in found(KEPT).tables().items() if name == "curve"]
    assert [row[4] for row in curve.rows] == ["1", "0"]
    assert [row[5] for row in curve.rows] == ["1", "0"]


def test_a_dear_or_thin_reserve_is_a_fault() -> None:
    assert "1.060 times" in found(replace(KEPT, price=1.06)).faults()[0]
    thin = replace(KEPT, worst_ratio=1.05, worst_ci95=(1.04, 1.06))
    assert "friction × 0.7 worse than without estimator, ratio 1.050" in found(thin).faults()[0]
    assert found(replace(thin, worst_ci95=(1.02, 1.08))).faults() == ()


def test_plants_that_brake_otherwise_do_so_by_their_names() -> None:
    plant = pilot_plant(36.0)
    plants = {wrong.name: wrong.plant for wrong in braking_otherwise(plant)}
    assert plants["as it is"] == plant
    for share in (0.7, 0.8, 0.9, 1.1, 1.2, 1.3):
        slopes = [nominal_value(each, SLOPES[0]) for each in (plants[f"friction × {share:g}"], plant)]
        assert slopes[0] == pytest.approx(share * (slopes[1] or 0.0))
    assert plants["friction CV × 1.7"].friction.common_cv == pytest.approx(0.255)
    assert plants["mass + 15 %"].cut.mass_t == pytest.approx(41.4)
