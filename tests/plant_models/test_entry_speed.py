"""Entry speeds: each law against its distribution function, its limits, and what it refuses."""

import math
from collections.abc import Callable

import numpy as np
import pytest

from plant_models import EntryLaw, EntrySpeed, HistogramEntrySpeed, NormalEntrySpeed, PlantError

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
