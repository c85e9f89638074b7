"""The last metres on finer energies: nothing is lost where a density is handed over, refined or made positive."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from synth.kernels.sweep.finer_end import refine, refine_landings, refinement
from synth.problem.criterion import share_above
from synth.solver.chain.chain import Chain, chain_of
from synth.solver.evaluation import exit_density
from synth.solver.exit_density import ExitDensity, without_negative
from synth.solver.resolved_density import density_by_end, finer_end
from tests.properties.test_density_and_value import FEW, SEEDS, random_lines


def normal_on_grid(mean_m_s: float, cells: float, step_m2_s2: float = 0.02) -> ExitDensity:
    """A density normal in energy, `cells` cells wide."""
    energy = step_m2_s2 * np.arange(400)
    weight = np.exp(-0.5 * ((energy - 0.5 * mean_m_s**2) / (cells * step_m2_s2)) ** 2)
    return ExitDensity(np.sqrt(2.0 * energy), weight / weight.sum(), 0.0, 0.0, 0.0)


def moments(density: ExitDensity) -> NDArray[np.float64]:
    """Mass, mean and mean square of the speed."""
    speed = density.speed_m_s
    return np.stack([np.ones_like(speed), speed, speed**2]) @ density.probability


@FEW
@given(seed=SEEDS, length_m=st.floats(0.0, 9.5), staircase=st.booleans())
def test_an_end_that_is_no_finer_changes_nothing(
    small: Callable[[], Chain], seed: int, length_m: float, staircase: bool
) -> None:
    """Handed over at any node, below any ceiling: the same exits, stalls and commands, but for what is negligible."""
    chain = small().quantised() if staircase else small()
    lines = random_lines(chain, seed)
    end = finer_end(chain, lines.at_decisions(chain.decisions), length_m, 1)
    found, whole = density_by_end(chain, lines, end), exit_density(chain, lines)
    assert end.node == len(chain.drive_m_s2) - max(1, round(length_m / chain.grid.path_step_m))
    np.testing.assert_allclose(found.probability, whole.probability, atol=2e-6)
    assert found.stalled == pytest.approx(whole.stalled, abs=2e-6)
    assert found.switchings == pytest.approx(whole.switchings, abs=2e-5)


@pytest.mark.parametrize("times", [2, 3])
def test_a_finer_end_of_the_whole_path_is_a_finer_chain(small: Callable[[], Chain], times: int) -> None:
    """Handed over at the start, all but the entry is that of a chain with the finer step, to 0.02 % of the rms.

    The coarse chain alone is off by 1 % or more.
    """
    chain = small()
    lines = random_lines(chain, 7)
    finer = replace(chain.resolution, speed_step_m_s=chain.resolution.speed_step_m_s / times)
    wanted = exit_density(chain_of(chain.plant, finer, chain.scenarios), lines).rms_m_s(2.5)
    found = density_by_end(chain, lines, finer_end(chain, lines.at_decisions(chain.decisions), 100.0, times)).rms_m_s(
        2.5
    )
    print(times, found / wanted - 1.0, exit_density(chain, lines).rms_m_s(2.5) / wanted - 1.0)
    assert found == pytest.approx(wanted, rel=2e-4)


def test_landings_between_energies_are_those_of_the_motion(small: Callable[[], Chain]) -> None:
    """Interpolated and integrated from the last 4 m on: alike to 1e-4 m and m²/s² but where a cut leaves or stops.

    These are 1.6 % of the landings, and alike to 5 cm and 0.016 m²/s², a third of a coarse cell.
    """
    plant, resolution = small().plant, small().resolution
    chain = chain_of(plant, replace(resolution, speed_step_m_s=0.015), small().scenarios)
    end = finer_end(chain, random_lines(chain, 3).at_decisions(chain.decisions), 4.0, 3)
    finer = replace(chain.resolution, speed_step_m_s=0.005)
    wanted = chain_of(chain.plant, finer, chain.scenarios).landings
    count = end.chain.landings.points - 40
    for found, exact in (
        (end.chain.landings.travel_m, wanted.travel_m), (end.chain.landings.energy_m2_s2, wanted.energy_m2_s2)
    ):  # fmt: skip
        part = exact[end.node :, ..., :count]
        moves = (wanted.travel_m[end.node :, ..., :count] >= 0.0) & (end.chain.landings.travel_m[..., :count] >= 0.0)
        error = np.abs(found[..., :count] - part)[moves]
        print(moves.mean(), (error > 1e-4).mean(), error.max())
        assert moves.mean() > 0.5
        assert (error > 1e-4).mean() < 0.04
        assert error.max() < 0.05
    stalls = (wanted.travel_m[end.node :, ..., :count] < 0.0) != (end.chain.landings.travel_m[..., :count] < 0.0)
    assert stalls.mean() < 0.01


@given(seed=SEEDS, times=st.integers(1, 6))
def test_a_refined_row_keeps_mass_mean_and_mean_square(seed: int, times: int) -> None:
    """In cells next to a stall, which are refined linearly, mass and mean."""
    rng = np.random.default_rng(seed)
    row, share = rng.standard_normal(30), rng.uniform(0.0, 1.0, 30)
    row[-2:] = 0.0
    before, finer = share * row, np.zeros(30 * times)
    left = row - before
    refine(row, 0, 30, share, refinement(times), finer)
    np.testing.assert_allclose(row, left, atol=1e-15)
    cell = np.arange(30.0)
    fine = np.arange(30.0 * times) / times
    assert finer.sum() == pytest.approx(before.sum(), abs=1e-12)
    assert finer @ fine == pytest.approx(before @ cell, abs=1e-10)
    inner, finer = np.where(cell < 2, 0.0, before), np.zeros(30 * times)
    refine(inner.copy(), 0, 30, np.ones(30), refinement(times), finer)
    assert finer @ fine**2 == pytest.approx(inner @ cell**2, abs=1e-9)


def test_a_smooth_row_is_refined_to_what_it_is() -> None:
    """A normal density 2.5 cells wide, to 0.5 % of its largest value between the points."""
    cell, fine = np.arange(60.0), np.arange(180.0) / 3
    finer = np.zeros(180)
    refine(np.exp(-0.5 * ((cell - 30.0) / 2.5) ** 2), 0, 60, np.ones(60), refinement(3), finer)
    np.testing.assert_allclose(3.0 * finer, np.exp(-0.5 * ((fine - 30.0) / 2.5) ** 2), atol=5e-3)


@given(seed=SEEDS, size=st.floats(1e-8, 1e-3))
def test_a_density_made_positive_keeps_its_moments_and_its_tails(seed: int, size: float) -> None:
    """Six ripples of up to a thousandth beside the peak, a thin tail: moments to 1e-10, the tail as it was."""
    rng = np.random.default_rng(seed)
    density = normal_on_grid(2.0, 3.0)
    probability = 0.999 * density.probability
    probability[250:300] += 0.001 / 50.0
    beside = np.flatnonzero((density.probability > 1e-6) & (density.probability < 1e-3))
    probability[rng.choice(beside[beside < 200], 6, replace=False)] -= size
    rippled = replace(density, probability=probability)
    found = without_negative(rippled)
    assert found.probability.min() >= 0.0
    np.testing.assert_allclose(moments(found), moments(rippled), rtol=1e-10)
    np.testing.assert_array_equal(found.probability[250:300], probability[250:300])


def test_a_density_that_is_positive_stays_as_it_is() -> None:
    density = normal_on_grid(2.0, 3.0)
    assert without_negative(density) is density


@pytest.mark.parametrize(("cells", "error"), [(2.0, 6e-4), (3.3, 1e-4)])
def test_a_probability_of_overspeed_is_right_anywhere_between_grid_points(cells: float, error: float) -> None:
    """Of a law normal in energy; sharing the cell at the limit linearly would be wrong by 2e-3 and 6e-4."""
    density, step = normal_on_grid(2.0, cells), 0.02
    found, shared, exact = (np.empty(41) for _ in range(3))
    for i, limit in enumerate(np.linspace(1.8, 2.3, 41)):
        exact[i] = 0.5 * math.erfc((0.5 * limit**2 - 2.0) / (cells * step) / math.sqrt(2.0))
        found[i] = density.p_overspeed(float(limit))
        shared[i] = density.probability @ share_above(density.speed_m_s, float(limit))
    print(abs(found - exact).max(), abs(shared - exact).max())
    assert abs(found - exact).max() < error
    assert abs(shared - exact).max() > 3.0 * error
    assert density.p_overspeed(0.01) == pytest.approx(1.0)
    assert density.p_overspeed(99.0) == 0.0


@pytest.mark.parametrize(("points", "times"), [(5, 2), (17, 3), (40, 4)])
def test_landings_between_energies_are_those_of_the_cubic(points: int, times: int) -> None:
    """A cubic in the energy is met exactly from the second cell after a stall to the third below the top."""
    energy, stalls = np.arange(points + 8.0), 2 if points > 5 else 0
    ends = np.stack([3.0 + 1e-3 * energy**3, 0.5 * energy**2 - 1e-3 * energy**3]).reshape(1, 1, 1, 2, -1)
    ends[..., 0, :stalls] = -1.0
    fine = np.full((1, 1, 1, 2, times * points), np.nan)
    refine_landings(ends, points, 0, times, fine)
    place = np.arange(times * (stalls + 1), times * (points - 2)) / times
    within = slice(times * (stalls + 1), times * (points - 2))
    np.testing.assert_allclose(fine[0, 0, 0, 0, within], 3.0 + 1e-3 * place**3, rtol=1e-13)
    np.testing.assert_allclose(fine[0, 0, 0, 1, within], 0.5 * place**2 - 1e-3 * place**3, atol=1e-12)
    assert not np.isnan(fine).any()
