"""Laws of rolling resistance against scipy.stats and TB 10062; random numbers are uniform and the same for a cut
anywhere.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from plant_models import PlantError, RollingResistance
from plant_models.frozen_arrays import Floats
from plant_models.rolling.random_numbers import (
    BLOCK,
    GOLDEN,
    Purpose,
    keyed_uniform,
    keyed_words,
    mixed,
    uniform_numbers,
)
from plant_models.rolling.resistance_law import HumpNormLaw, ResistanceLaw, Tb10062Law
from plant_models.rolling.roll_track import Bend
from tests.plant_models.rolling.populations import CATEGORIES

U = (np.arange(20_000) + 0.5) / 20_000
"""Evenly spread probabilities: quantiles at them have the moments of the law, but for the last tail."""

PUBLISHED = {"Л": (1.75, 0.67), "ЛС": (1.54, 0.59), "С": (1.40, 0.50), "СТ": (1.25, 0.38), "Т": (1.23, 0.35)}
QUANTILES = {
    "Л": (0.68, 0.81, 1.67, 2.98, 3.33),
    "ЛС": (0.60, 0.71, 1.47, 2.62, 2.93),
    "С": (0.59, 0.69, 1.34, 2.31, 2.57),
    "СТ": (0.61, 0.70, 1.21, 1.93, 2.12),
    "Т": (0.63, 0.72, 1.20, 1.86, 2.02),
}
"""At −2 σ of a normal law, 5, 50 and 95 %, and +2 σ of a normal law; N/kN, worked out apart from this program."""


def heads_m(law: ResistanceLaw, bend: Bend, u: Floats) -> tuple[Floats, Floats]:
    """What `bend` takes for each row of `u`: per (m/s)², whatever the speed."""
    draws, (v2, head) = law.bend_draws(u), law.bend_scale_m(bend)
    return draws * v2, draws * head


@pytest.mark.parametrize("name", PUBLISHED)
def test_basic_resistance_has_the_gamma_law_of_its_category(name: str) -> None:
    resistance = CATEGORIES.named(name).resistance
    mean, std = PUBLISHED[name]
    drawn = HumpNormLaw().basic_n_per_kn(resistance, np.full(U.shape, 30.0), 10.0, U)
    law = stats.gamma((mean / std) ** 2, scale=std**2 / mean)
    np.testing.assert_allclose(drawn, law.ppf(U), rtol=1e-9)
    assert drawn.mean() == pytest.approx(mean, abs=2e-4)
    assert drawn.std() == pytest.approx(std, abs=1e-3)
    assert stats.skew(drawn) == pytest.approx(2.0 * std / mean, abs=0.01)
    u = np.array([stats.norm.cdf(-2.0), 0.05, 0.5, 0.95, stats.norm.cdf(2.0)])
    at = HumpNormLaw().basic_n_per_kn(resistance, np.full(5, 30.0), 10.0, u)
    np.testing.assert_allclose(at, QUANTILES[name], atol=0.0051)


def test_a_law_without_spread_gives_its_mean() -> None:
    drawn = HumpNormLaw().basic_n_per_kn(RollingResistance(1.4, 0.0), np.full(5, 30.0), 10.0, U[:5])
    assert drawn.tolist() == [1.4] * 5


@pytest.mark.parametrize("order", [1, 2, 3, 6])
def test_the_head_of_a_bend_has_an_erlang_law(order: int) -> None:
    law, bend = HumpNormLaw(erlang_order=order), Bend(10.0, 30.0, 2, 9.46)
    assert law.bend_numbers == order
    mean = 0.56e-3 * 2 + 0.23e-3 * 9.46
    drawn, whatever = heads_m(law, bend, np.random.default_rng(3).random((50_000, order)))
    assert stats.kstest(drawn, stats.erlang(order, scale=mean / order).cdf).pvalue > 0.01
    assert drawn.mean() == pytest.approx(mean, rel=0.02)
    assert law.mean_bend_draw * law.bend_scale_m(bend)[0] == pytest.approx(mean, rel=1e-12)
    assert drawn.std() == pytest.approx(mean / np.sqrt(order), rel=0.03)
    assert not whatever.any()


@pytest.mark.parametrize(("order", "std"), [(1, 0.132), (2, 0.093), (3, 0.076), (4, 0.066), (6, 0.054)])
def test_the_head_of_five_switches_spreads_as_worked_out(order: int, std: float) -> None:
    """5 switches of 4.73° and two curves of 11.5° at 5 m/s: worked out apart from this program."""
    bends = [*[Bend(0.0, 10.0, 1, 4.73)] * 5, *[Bend(0.0, 10.0, 0, 23.0 / 2)] * 2]
    law, rng = HumpNormLaw(erlang_order=order), np.random.default_rng(5)
    heads = np.sum([25.0 * heads_m(law, bend, rng.random((40_000, order)))[0] for bend in bends], axis=0)
    assert heads.mean() == pytest.approx(0.338, abs=0.003)
    assert heads.std() == pytest.approx(std, rel=0.03)


TB_ROWS = [
    (22.0, 20.0, (2.75, 1.91, 3.60), (2.06, 1.22, 2.91)),
    (22.0, -20.0, (3.38, 2.43, 4.33), (2.69, 1.74, 3.64)),
    (60.0, 20.0, (2.24, 1.61, 2.87), (1.55, 0.92, 2.18)),
    (60.0, -20.0, (2.75, 1.96, 3.54), (2.06, 1.27, 2.85)),
    (80.0, 20.0, (1.98, 1.46, 2.49), (1.29, 0.77, 1.80)),
    (80.0, -20.0, (2.42, 1.71, 3.12), (1.73, 1.02, 2.43)),
]
"""Mass, temperature; mean, 5 % and 95 % on the slope at 5 m/s and in the yard at 2 m/s: worked out from the norm."""


@pytest.mark.parametrize(("mass", "temperature", "slope", "yard"), TB_ROWS)
def test_tb_10062_gives_the_figures_of_the_norm(
    mass: float, temperature: float, slope: tuple[float, ...], yard: tuple[float, ...]
) -> None:
    law, u = Tb10062Law(), np.array([0.5, 0.05, 0.95])
    still = law.basic_n_per_kn(RollingResistance(9.9, 0.1), np.full(3, mass), temperature, u)
    # The norm's easy and hard runners are 1.65 standard deviations off, the quantiles 1.645.
    np.testing.assert_allclose(still + 2.0 * law.linear_n_per_kn, yard, atol=0.009)
    np.testing.assert_allclose(still + 5.0 * law.linear_n_per_kn + law.slope_extra_n_per_kn, slope, atol=0.009)


def test_tb_10062_spreads_normally_down_to_its_least_value() -> None:
    mass = np.full(U.shape, 30.0)
    drawn = Tb10062Law(least_n_per_kn=0.0).basic_n_per_kn(RollingResistance(1.0, 0.1), mass, 0.0, U)
    law = stats.norm(2.439 - 0.45, 0.602 - 0.09)
    np.testing.assert_allclose(drawn, np.maximum(law.ppf(U), 0.0), rtol=1e-9)
    cut_off = Tb10062Law(least_n_per_kn=1.0).basic_n_per_kn(RollingResistance(1.0, 0.1), mass, 0.0, U)
    assert cut_off.min() == 1.0
    assert (cut_off == 1.0).mean() == pytest.approx(law.cdf(1.0), abs=1e-4)


def test_tb_10062_takes_heads_whatever_the_speed() -> None:
    v2, head = heads_m(Tb10062Law(), Bend(0.0, 50.0, 4, 25.0), np.full((3, 1), 0.7))
    np.testing.assert_allclose(head, 0.296)
    assert not v2.any()


def test_the_two_norms_take_the_same_head_near_6_m_s() -> None:
    """Four facing switches and 25°: 0.13, 0.20 and 0.29 m at 4, 5 and 6 m/s against 0.296 m."""
    bend, law = Bend(0.0, 50.0, 4, 25.0), HumpNormLaw(erlang_order=50)
    mean = law.per_switch_m_s2 * bend.switches + law.per_degree_m_s2 * bend.turn_deg
    np.testing.assert_allclose([mean * v**2 for v in (4.0, 5.0, 6.0)], [0.128, 0.200, 0.288], atol=5e-4)


@pytest.mark.parametrize(
    ("key", "value", "allowed"),
    [("erlang_order", 0, "from 1 to 50"), ("per_switch_m_s2", -0.1, "from 0 to 0.1"), ("per_degree_m_s2", 1.0, "0.1")],
)
def test_a_norm_outside_its_range_is_refused(key: str, value: float, allowed: str) -> None:
    with pytest.raises(PlantError, match=rf"^resistance: {key} is .*{allowed}"):
        HumpNormLaw(**{key: value})  # type: ignore[arg-type]


def test_a_least_value_outside_its_range_is_refused() -> None:
    with pytest.raises(PlantError, match=r"^resistance: least_n_per_kn is -1"):
        Tb10062Law(least_n_per_kn=-1.0)


def test_the_sequence_is_splitmix64() -> None:
    """The first numbers for the seed 1234567, as the authors' reference code prints them."""
    words = mixed(np.uint64(1234567) + GOLDEN * np.arange(1, 4, dtype=np.uint64))
    assert words.tolist() == [6457827717110365317, 3203168211198807973, 9817491932198370423]


def test_a_cut_has_its_numbers_whoever_is_beside_it() -> None:
    train, cut = (np.ravel(a) for a in np.meshgrid(np.arange(30), np.arange(40)))
    whole = keyed_words(7, Purpose.PASS_NOISE, (train, cut), 12)
    order = np.random.default_rng(0).permutation(len(train))[:100]
    assert (keyed_words(7, Purpose.PASS_NOISE, (train[order], cut[order]), 5) == whole[:5, order]).all()


def test_no_two_keys_share_numbers() -> None:
    train, cut = (np.ravel(a) for a in np.meshgrid(np.arange(300), np.arange(40)))
    words = np.concatenate(
        [
            keyed_words(seed, purpose, keys, 3)
            for seed in (7, 8)
            for purpose in (Purpose.PASS_NOISE, Purpose.CUT_FRICTION)
            for keys in ((train, cut), (train, cut, np.zeros_like(cut)), (train, cut, np.ones_like(cut)))
        ]
    )
    assert len(np.unique(words)) == words.size


def test_numbers_are_uniform_and_neighbours_do_not_correlate() -> None:
    """n = 120 000; limits are crossed by chance once in ten thousand seeds."""
    train, cut = (np.ravel(a) for a in np.meshgrid(np.arange(3000), np.arange(40), indexing="ij"))
    u = keyed_uniform(1, Purpose.POSITION_ERROR, (train, cut), 2)
    assert u.min() > 0.0
    assert u.max() < 1.0
    assert stats.kstest(u[0], "uniform").pvalue > 1e-4
    for one, other in ((u[0, :-1], u[0, 1:]), (u[0, :-40], u[0, 40:]), (u[0], u[1])):
        assert abs(np.corrcoef(one, other)[0, 1]) * np.sqrt(len(one)) < 3.9


def test_negative_numbers_are_refused() -> None:
    for seed, key in ((-1, 0), (1, -1)):
        with pytest.raises(ValueError, match="must not be negative"):
            keyed_words(seed, Purpose.PASS_NOISE, (np.array([key]),), 1)


WHOLE = uniform_numbers(7, Purpose.CARS, 0, 3 * BLOCK, 6)


@given(first=st.integers(0, 2 * BLOCK), count=st.integers(0, BLOCK), columns=st.integers(0, 6))
def test_a_row_is_the_same_whatever_is_asked_for(first: int, count: int, columns: int) -> None:
    part = uniform_numbers(7, Purpose.CARS, first, count, columns)
    np.testing.assert_array_equal(part, WHOLE[first : first + count, :columns])


def test_purposes_and_seeds_have_numbers_of_their_own() -> None:
    drawn = [uniform_numbers(seed, purpose, 0, 2000, 1)[:, 0] for seed in (1, 2) for purpose in Purpose]
    between = np.corrcoef(drawn) - np.eye(len(drawn))
    assert np.abs(between).max() < 5.0 / np.sqrt(2000)


def test_purposes_keep_their_numbers() -> None:
    """A new number for an old purpose would move every study that names a seed."""
    assert {p.name: int(p) for p in Purpose}.items() >= {
        ("CARS", 1), ("WIND", 2), ("BENDS", 3), ("BUNCH_EXIT", 4), ("SPEED_NOISE", 5), ("EXIT_ERROR", 6)
    }  # fmt: skip
    assert len({int(p) for p in Purpose}) == len(Purpose)


def test_numbers_are_uniform_in_every_column_and_across_blocks() -> None:
    numbers = uniform_numbers(11, Purpose.WIND, 500, 20_000, 3)
    for column in numbers.T:
        assert stats.kstest(column, "uniform").pvalue > 0.001
    assert 0.0 < numbers.min() < numbers.max() < 1.0
    assert abs(np.corrcoef(numbers[:-BLOCK, 0], numbers[BLOCK:, 0])[0, 1]) < 5.0 / np.sqrt(20_000)


def test_neither_0_nor_1_can_come_out() -> None:
    """The generator gives multiples of 2⁻⁵³ below 1; both ends have finite quantiles after the shift."""
    ends = np.array([0.0, 1.0 - 2.0**-53]) * (1.0 - 2.0**-52) + 2.0**-53
    assert 0.0 < ends[0] < ends[1] < 1.0


@pytest.mark.parametrize(
    ("first", "count", "columns", "seed"), [(-1, 1, 1, 1), (0, -1, 1, 1), (0, 1, -1, 1), (0, 1, 1, -1)]
)
def test_negative_rows_and_purposes_are_refused(first: int, count: int, columns: int, seed: int) -> None:
    with pytest.raises(ValueError, match="must not be negative"):
        uniform_numbers(seed, Purpose.CARS, first, count, columns)
