"""The four states of the computer: closed form, elimination, integration in time, Monte Carlo, and what must rise."""

from __future__ import annotations

from dataclasses import astuple, replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from synth.computer.reliability.four_states import FourStates, State

PRINTED = FourStates(0.01, 0.2, 0.4, 4.0, 0.5)
TO_REPAIR = replace(PRINTED, failed_check_to=State.REPAIR)
rates = st.floats(1e-4, 1e2)
chains = st.builds(
    FourStates, rates, rates, rates, rates, rates, st.sampled_from([State.MAINTENANCE, State.REPAIR])
)  # fmt: skip


def stationary_shares(generator_per_h: np.ndarray) -> np.ndarray:
    """Share of time (n,) in each state of a chain with this generator (n, n).

    One state after the other is taken out, without any subtraction: so a share of 1e-15 has all its digits, which the
    null space does not give. Grassmann, Taksar and Heyman, Operations Research 33 (1985).
    """
    rates, n = generator_per_h.copy(), len(generator_per_h)
    for k in range(n - 1, 0, -1):
        rates[:k, k] /= rates[k, :k].sum()
        rates[:k, :k] += np.outer(rates[:k, k], rates[k, :k])
    shares = np.ones(n)
    for k in range(1, n):
        shares[k] = shares[:k] @ rates[:k, k]
    return np.asarray(shares / shares.sum())


def chain_cycles(chain: FourStates, cycles: int, seed: int) -> np.ndarray:
    """Hours (cycles, 4) in each state from one entry into ready to the next; the earliest of competing clocks wins."""
    rng, hours = np.random.default_rng(seed), np.zeros((cycles, 4))
    fails, check = (rng.exponential(1.0 / rate, cycles) for rate in (chain.failure_per_h, chain.check_per_h))
    noticed, again = (rng.exponential(1.0 / rate, cycles) for rate in (chain.detection_per_h, chain.check_per_h))
    failed = fails < check
    hours[:, State.READY] = np.minimum(fails, check)
    hours[:, State.FAILED_UNNOTICED] = np.where(failed, np.minimum(noticed, again), 0.0)
    by_check = failed & (again < noticed) & (chain.failed_check_to is State.MAINTENANCE)
    maintained = ~failed | by_check
    hours[:, State.MAINTENANCE] = maintained * rng.exponential(1.0 / chain.maintenance_per_h, cycles)
    hours[:, State.REPAIR] = ~maintained * rng.exponential(1.0 / chain.repair_per_h, cycles)
    return hours


def test_the_matrix_is_that_of_the_print() -> None:
    """The rows of the print, with dt left out: λ ν on the first, ν μ on the second, ε on the third, γ on the fourth."""
    expected = [[-0.41, 0.01, 0.4, 0.0], [0.0, -0.6, 0.4, 0.2], [4.0, 0.0, -4.0, 0.0], [0.5, 0.0, 0.0, -0.5]]
    np.testing.assert_allclose(PRINTED.generator_per_h(), expected, atol=1e-15)
    assert TO_REPAIR.generator_per_h()[State.FAILED_UNNOTICED].tolist() == [
        0.0,
        -0.6000000000000001,
        0.0,
        0.6000000000000001,
    ]


def test_shares_by_hand() -> None:
    """p1 : p2 : p3 : p4 = 1 : 1/60 : 0.1·61/60 : 0.4/60; with a check that leads to repair 1 : 1/60 : 0.1 : 0.02."""
    by_hand = np.array([1.0, 1 / 60, 0.1 * 61 / 60, 0.4 / 60])
    np.testing.assert_allclose(astuple(PRINTED.stationary()), by_hand / by_hand.sum(), rtol=1e-14)
    by_hand = np.array([1.0, 1 / 60, 0.1, 0.02])
    np.testing.assert_allclose(astuple(TO_REPAIR.stationary()), by_hand / by_hand.sum(), rtol=1e-14)


@given(chains)
def test_closed_form_is_what_elimination_gives_in_every_digit(chain: FourStates) -> None:
    np.testing.assert_allclose(astuple(chain.stationary()), stationary_shares(chain.generator_per_h()), rtol=1e-13)


@pytest.mark.parametrize("chain", [PRINTED, TO_REPAIR])
@pytest.mark.parametrize("start", list(State))
def test_transient_is_that_of_the_differential_equations(chain: FourStates, start: State) -> None:
    hours = np.array([0.0, 0.1, 1.0, 5.0, 40.0])
    q, begin = chain.generator_per_h(), np.eye(4)[start]
    solved = solve_ivp(lambda _, p: p @ q, (0.0, 40.0), begin, "DOP853", hours, rtol=1e-11, atol=1e-13)
    np.testing.assert_allclose(chain.transient(hours, start), solved.y.T, atol=1e-9)
    (late,) = chain.transient(np.array([1e4]), start)
    np.testing.assert_allclose(late, astuple(chain.stationary()), rtol=1e-9)


@given(chains, st.floats(1.05, 10.0))
def test_detection_raises_availability_unless_maintenance_is_the_shorter_repair(
    chain: FourStates, factor: float
) -> None:
    """Where the check leads to repair, always. As printed only if a repair, 1/γ, is shorter than waiting for the check
    and its maintenance, 1/ν + 1/ε: for there the check repairs too."""
    now = chain.stationary().availability
    sooner = replace(chain, detection_per_h=factor * chain.detection_per_h).stationary().availability
    if chain.failed_check_to is State.REPAIR:
        assert sooner >= now
        return
    gain = 1.0 / chain.check_per_h + 1.0 / chain.maintenance_per_h - 1.0 / chain.repair_per_h
    assert (sooner - now) * gain >= -1e-12 * abs(gain)


def test_without_checks_or_without_detection_a_chain_still_works() -> None:
    unchecked, unaware = replace(PRINTED, check_per_h=0.0), replace(PRINTED, detection_per_h=0.0)
    assert unchecked.stationary().maintenance == 0.0
    assert unaware.stationary().repair == 0.0
    for chain in (unchecked, unaware):
        p = chain.stationary()
        np.testing.assert_allclose(astuple(p) @ chain.generator_per_h(), 0.0, atol=1e-14)
