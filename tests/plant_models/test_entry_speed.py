"""Entry speeds and rolling resistance against their laws; values with arrays cannot be written to."""

from __future__ import annotations

import copy
import math
import pickle
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats

from plant_models import EntryLaw, EntrySpeed, HistogramEntrySpeed, NormalEntrySpeed, PlantError, RollingResistance
from plant_models.frozen_arrays import frozen_arrays

U = (np.arange(200_000) + 0.5) / 200_000
NORMAL = NormalEntrySpeed(4.0, 6.5, 5.5, 0.6)
BINS = HistogramEntrySpeed((4.0, 4.5, 5.0, 6.0, 6.5), (0.0, 10.0, 30.0, 0.0))


def phi(x: float) -> float:
    """Distribution function of the standard normal law."""
    return 0.5 * math.erfc(-x / math.sqrt(2.0))


def test_uniform_is_linear_to_the_bit() -> None:
    law = EntrySpeed(5.0, 6.5)
    assert np.array_equal(law.speed_m_s(U), 5.0 + (6.5 - 5.0) * U)


@pytest.mark.parametrize("v", [4.2, 5.0, 5.5, 6.4])
def test_normal_has_its_truncated_distribution_function(v: float) -> None:
    below, above = phi((4.0 - 5.5) / 0.6), phi((6.5 - 5.5) / 0.6)
    expected = (phi((v - 5.5) / 0.6) - below) / (above - below)
    assert float(np.mean(NORMAL.speed_m_s(U) <= v)) == pytest.approx(expected, abs=1e-5)


def test_normal_has_the_moments_of_the_truncated_law() -> None:
    a, b = (4.0 - 5.5) / 0.6, (6.5 - 5.5) / 0.6
    density = [math.exp(-0.5 * x * x) / math.sqrt(2.0 * math.pi) for x in (a, b)]
    mean = 5.5 + 0.6 * (density[0] - density[1]) / (phi(b) - phi(a))
    assert float(NORMAL.speed_m_s(U).mean()) == pytest.approx(mean, abs=1e-5)


@pytest.mark.parametrize(("v", "share"), [(4.5, 0.0), (4.75, 0.125), (5.0, 0.25), (5.5, 0.625), (6.0, 1.0)])
def test_histogram_has_its_distribution_function_and_leaves_empty_bins_out(v: float, share: float) -> None:
    assert float(np.mean(BINS.speed_m_s(U) <= v)) == pytest.approx(share, abs=1e-5)
    assert (BINS.low_m_s, BINS.high_m_s) == (4.5, 6.0)


@pytest.mark.parametrize("law", [EntrySpeed(5.0, 6.5), NORMAL, BINS])
def test_every_law_rises_stays_within_its_limits_and_stretches(law: EntryLaw) -> None:
    u = np.array([0.0, 1e-12, 0.3, 0.5, 1.0 - 2.0**-53])
    speed = law.speed_m_s(u)
    assert np.all(np.diff(speed) >= 0.0)
    assert law.low_m_s - 1e-12 <= speed[0]
    assert speed[-1] <= law.high_m_s + 1e-12
    wider = law.stretched(2.0, 8.0)
    scale = 6.0 / (law.high_m_s - law.low_m_s)
    np.testing.assert_allclose(wider.speed_m_s(u), 2.0 + (speed - law.low_m_s) * scale, atol=1e-9)
    assert law.stretched(3.0, 3.0) == EntrySpeed(3.0, 3.0)


def test_one_bin_is_the_uniform_law() -> None:
    np.testing.assert_allclose(
        HistogramEntrySpeed((5.0, 6.5), (3.0,)).speed_m_s(U), EntrySpeed(5.0, 6.5).speed_m_s(U), rtol=1e-15
    )


@pytest.mark.parametrize(
    ("build", "said"),
    [
        (lambda: EntrySpeed(6.0, 5.0), "entry: high_m_s is 5.0; it must be from low_m_s = 6 to 20"),
        (lambda: NormalEntrySpeed(5.0, 5.0, 5.0, 0.5), "entry: high_m_s is 5.0; with mean_m_s it must be above"),
        (lambda: NormalEntrySpeed(4.0, 5.0, 9.0, 0.5), "entry: mean_m_s is 9; with std_m_s = 0.5 only"),
        (lambda: NormalEntrySpeed(4.0, 5.0, 4.5, 0.0), "entry: std_m_s is 0.0; it must be a finite number from 0.001"),
        (lambda: HistogramEntrySpeed((4.0, 4.0), (1.0,)), "entry: edges_m_s is .*each above the one before"),
        (lambda: HistogramEntrySpeed((4.0, 5.0), (1.0, 2.0)), "entry: shares has 2 numbers; .* it must have 1"),
        (lambda: HistogramEntrySpeed((4.0, 5.0), (0.0,)), "entry: shares are all 0"),
        (lambda: HistogramEntrySpeed((4.0, 25.0), (1.0,)), "entry: edges_m_s is 25.0; .*from 0.3 to 20"),
    ],
)
def test_impossible_laws_are_refused(build: Callable[[], object], said: str) -> None:
    with pytest.raises(PlantError, match=said):
        build()


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


@frozen_arrays
@dataclass(frozen=True, eq=False)
class Curve:
    """Two arrays, a tuple of arrays, one made by itself, and a number."""

    x: NDArray[np.float64]
    y: NDArray[np.float64]
    parts: tuple[NDArray[np.float64], ...] = ()
    scale: float = 1.0
    sums: NDArray[np.float64] = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "sums", self.x + self.y)


def arrays(curve: Curve) -> list[NDArray[np.float64]]:
    return [curve.x, curve.y, curve.sums, *curve.parts]


def made() -> Curve:
    return Curve(np.arange(3.0), y=np.ones(3), parts=(np.zeros(2), np.zeros(1)))


@pytest.mark.parametrize(
    "way",
    [
        lambda curve: curve,
        lambda curve: pickle.loads(pickle.dumps(curve)),
        copy.copy,
        copy.deepcopy,
        lambda curve: replace(curve, y=np.zeros(3)),
    ],
    ids=["made", "unpickled", "copied", "deeply copied", "replaced"],
)
def test_no_array_can_be_written_to(way: Callable[[Curve], Curve]) -> None:
    curve = way(made())
    assert len(arrays(curve)) == 5
    for array in arrays(curve):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 7.0


def test_the_values_are_those_given() -> None:
    curve = pickle.loads(pickle.dumps(made()))
    assert curve.sums.tolist() == [1.0, 2.0, 3.0]
    assert (curve.scale, [part.size for part in curve.parts]) == (1.0, [2, 1])


def test_equality_and_hash_do_not_raise() -> None:
    one, other = made(), made()
    assert one == one
    assert one != other
    assert len({one, other, one}) == 2


def test_repr_tells_the_shape_of_an_array_and_not_its_numbers() -> None:
    shown = repr(replace(made(), parts=(), x=np.zeros(10_000), y=np.ones(10_000)))
    assert shown == "Curve(x=float64 (10000,), y=float64 (10000,), parts=(), scale=1.0, sums=float64 (10000,))"


def test_without_it_an_unpickled_array_can_be_written_to() -> None:
    """Why `__setstate__` is needed: numpy forgets the flag."""
    array = np.zeros(2)
    array.setflags(write=False)
    assert pickle.loads(pickle.dumps(array)).flags.writeable
