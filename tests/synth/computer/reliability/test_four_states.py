"""The four states of the computer: closed form, null space, integration in time, Monte Carlo, and what must rise."""

from __future__ import annotations

from dataclasses import astuple, replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from plant_models import PlantError
from scripts.studies.control_computer.stationary import stationary_shares
from synth.computer.reliability.four_states import FourStates, State, StateShares

PRINTED = FourStates(0.01, 0.2, 0.4, 4.0, 0.5)
TO_REPAIR = replace(PRINTED, failed_check_to=State.REPAIR)
rates = st.floats(1e-4, 1e2)
chains = st.builds(
    FourStates, rates, rates, rates, rates, rates, st.sampled_from([State.MAINTENANCE, State.REPAIR])
)  # fmt: skip


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


def test_impossible_values_are_refused() -> None:
    for key in ("failure_per_h", "maintenance_per_h", "repair_per_h"):
        for value in (0.0, -1.0, float("nan"), float("inf")):
            with pytest.raises(PlantError, match=f"four states: {key} is"):
                replace(PRINTED, **{key: value})  # type: ignore[arg-type]  # a key of it
    with pytest.raises(PlantError, match=r"detection_per_h is -0\.1"):
        replace(PRINTED, detection_per_h=-0.1)
    with pytest.raises(PlantError, match="both 0"):
        replace(PRINTED, detection_per_h=0.0, check_per_h=0.0)
    with pytest.raises(PlantError, match="MAINTENANCE or REPAIR"):
        replace(PRINTED, failed_check_to=State.READY)
    with pytest.raises(PlantError, match="from 0 to 1"):
        StateShares(1.1, -0.1, 0.0, 0.0)
    with pytest.raises(PlantError, match="sum to"):
        StateShares(0.5, 0.1, 0.0, 0.0)
    with pytest.raises(PlantError, match="must not be negative"):
        PRINTED.transient(np.array([-1.0]))
