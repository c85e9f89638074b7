"""Laws that the model has not: said where they are large enough to matter, and not said where they are not there."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from scripts.studies.identification.truths import TRUTHS, Yard
from synth.logs import unknowns as asked
from synth.logs.estimate import Estimate
from synth.logs.fitting_passes import FittingPasses
from synth.logs.residual_tests import (
    LAWS,
    PRESSURE,
    Effect,
    ResidualTest,
    beyond,
    residual_tests,
    wrong,
)
from synth.logs.unknowns import unknowns_of
from tests.effort import every
from tests.synth.logs.other_laws import OtherLaws

PASSES, SEED = 300, 11

BY_SPEED, BENT, RESISTANCE = LAWS.values()


def told_by(passes: FittingPasses, yard: Yard) -> dict[Effect, ResidualTest]:
    """The tests at the true numbers, by what they look for: an estimate would take a minute."""
    unknowns = unknowns_of(passes, yard.config.parameters)
    truth = TRUTHS[0].values(tuple(unknown.key for unknown in unknowns))
    u = np.array([unknown.standing(truth[unknown.key]) for unknown in unknowns])
    there = Estimate(unknowns, len(passes), 0.0, u, np.eye(len(u)), np.eye(len(u)))
    return {test.effect: test for test in residual_tests(passes, there, 2)}


def said(tests: dict[Effect, ResidualTest]) -> set[Effect]:
    return {test.effect for test in wrong(tuple(tests.values()))}


def under(laws: OtherLaws, yard: Yard, monkeypatch: pytest.MonkeyPatch) -> FittingPasses:
    monkeypatch.setattr("synth.simulation.logged_passes.rows_of_pass", laws.rows_of_pass)
    return yard.passes(TRUTHS[0], PASSES, SEED)


@pytest.fixture(scope="module")
def lawful(yard: Yard) -> FittingPasses:
    return yard.passes(TRUTHS[0], PASSES, SEED)


@pytest.mark.parametrize(
    ("laws", "effect", "size"),
    every(
        3,
        [
            (OtherLaws(friction_by_speed=-0.05), BY_SPEED, -5.0),
            (OtherLaws(force_by_pressure=0.15), BENT, 15.0),
            (OtherLaws(resistance_by_speed=0.3), RESISTANCE, 30.0),
        ],
    ),
)
def test_a_law_that_matters_is_found_with_its_size(
    laws: OtherLaws, effect: Effect, size: float, yard: Yard, monkeypatch: pytest.MonkeyPatch
) -> None:
    tests = told_by(under(laws, yard, monkeypatch), yard)
    assert effect in said(tests)
    low, high = tests[effect].interval
    assert abs(tests[effect].size - size) < high - low + 0.2 * abs(size)


@pytest.mark.parametrize(("amplitude_kpa", "speaks"), [(2.0, False), (8.0, True)])
def test_what_stays_in_the_gauge_is_told_in_kpa(
    amplitude_kpa: float, speaks: bool, yard: Yard, lawful: FittingPasses
) -> None:
    """A slow wave of the pressure, its rms amplitude / √2."""
    log = lawful.log
    wave = amplitude_kpa * np.sin(2.0 * np.pi * log.time_s / 1.7)
    tests = told_by(replace(lawful, log=replace(log, pressure_kpa=log.pressure_kpa + wave)), yard)
    assert (PRESSURE in said(tests)) == speaks
    assert tests[PRESSURE].size == pytest.approx(amplitude_kpa / np.sqrt(2.0), rel=0.1)


def test_what_is_beyond_is_a_p_value_of_both_sides() -> None:
    """Against draws, at the edge of what does not matter."""
    rng = np.random.default_rng(1)
    drawn = np.abs(2.0 + 1.5 * rng.standard_normal(400_000))
    for size in (0.5, 2.5, -6.0):
        assert beyond(size, 1.5, 2.0) == pytest.approx(np.mean(drawn >= abs(size)), abs=3e-3)
    assert beyond(1.96, 1.0, 0.0) == pytest.approx(0.05, abs=1e-4)


def test_keys_of_the_laws_are_those_of_the_likelihood() -> None:
    assert list(LAWS) == [asked.FRICTION_BY_SPEED, asked.FORCE_BY_PRESSURE, asked.RESISTANCE_BY_SPEED]
