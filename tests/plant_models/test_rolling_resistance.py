"""Rolling resistance: the gamma law, its samples and its quadrature."""

import numpy as np
import pytest
from scipy import stats

from plant_models import PlantError, RollingResistance

LIGHT = RollingResistance(1.75, 0.67)


def test_shape_and_scale_of_the_facts() -> None:
    assert LIGHT.shape == pytest.approx(6.82, abs=0.005)
    assert LIGHT.scale_n_per_kn == pytest.approx(0.2565, abs=5e-5)


def test_samples_follow_the_gamma_law() -> None:
    draws = LIGHT.sample(np.random.default_rng(1), 20_000)
    law = stats.gamma(LIGHT.shape, scale=LIGHT.scale_n_per_kn)
    assert stats.kstest(draws, law.cdf).pvalue > 0.01


@pytest.mark.parametrize("count", [2, 3, 5])
def test_nodes_integrate_polynomials_exactly(count: int) -> None:
    values, probabilities = LIGHT.nodes(count)
    law = stats.gamma(LIGHT.shape, scale=LIGHT.scale_n_per_kn)
    assert values.shape == probabilities.shape == (count,)
    for power in range(2 * count):
        assert (probabilities * values**power).sum() == pytest.approx(law.moment(power) if power else 1.0, rel=1e-9)


def test_a_known_resistance_has_one_node_and_no_spread() -> None:
    known = RollingResistance(1.4, 0.0)
    assert known.sample(np.random.default_rng(0), 3).tolist() == [1.4, 1.4, 1.4]
    values, probabilities = known.nodes(5)
    assert (values.tolist(), probabilities.tolist()) == ([1.4], [1.0])
    assert LIGHT.nodes(1)[0].tolist() == [1.75]


@pytest.mark.parametrize(("mean", "std"), [(0.0, 0.1), (-1.0, 0.1), (1.0, -0.1), (float("nan"), 0.1)])
def test_impossible_values_are_refused(mean: float, std: float) -> None:
    with pytest.raises(PlantError, match="rolling resistance: "):
        RollingResistance(mean, std)
