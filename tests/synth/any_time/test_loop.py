"""The simulator of commands at any time: the rule that it runs, and commands during a change of stage."""

from __future__ import annotations

import math

import numpy as np
import pytest
from numpy.typing import NDArray

from plant_models import Plant
from synth.simulation.closed_loop import close_loop
from synth.simulation.random_passes import random_passes
from synth.solver.any_time.polynomial_surfaces import PolynomialSurfaces
from synth.solver.switching_lines import SwitchingLines
from tests.synth.any_time.tabled import tabled


def powers_of(surfaces: PolynomialSurfaces) -> NDArray[np.float64]:
    """Coefficients (K + 1, 2, powers of x, powers of u), ascending."""
    found = np.zeros((*surfaces.has_line.shape, len(surfaces.degrees), max(surfaces.degrees) + 1))
    first = 0
    for power, degree in enumerate(surfaces.degrees):
        for stage, side in surfaces.lines:
            series = np.polynomial.legendre.leg2poly(surfaces.coefficients[stage, side, first : first + degree + 1])
            found[stage, side, power, : len(series)] = series
        first += degree + 1
    return found


def falling_lines(plant: Plant, nodes: int) -> SwitchingLines:
    """Lines that fall to 3 m/s and make much ado."""
    s = np.linspace(0.0, plant.exit_m, nodes)
    middle = 3.0 + 1.2 * (1.0 - s / plant.exit_m) ** 2 + 0.03 * np.sin(s) + 0.1 * np.arange(3)[:, None]
    lower, upper = middle - 0.03, middle + 0.03
    lower[0], upper[-1] = -np.inf, np.inf
    return SwitchingLines(s, lower, upper)


def polynomials(
    plant: Plant, coefficients: np.ndarray, has_line: np.ndarray, degrees: tuple[int, ...]
) -> PolynomialSurfaces:
    stages = np.asarray(plant.position.stage_pressures_kpa)
    return PolynomialSurfaces(plant.start_m, plant.exit_m, stages, degrees, coefficients, has_line)


def test_the_polynomial_rule_commands_what_its_polynomial_says(plant: Plant) -> None:
    rng = np.random.default_rng(4)
    series = 0.05 * rng.standard_normal((3, 2, 5))
    series[:, 0, 0], series[:, 1, 0] = 3.1, 3.2
    series[:, :, 1] = -0.5
    has_line = np.array([[False, True], [True, True], [True, False]])
    surfaces = polynomials(plant, series, has_line, (3, 0))
    coefficients, controller = powers_of(surfaces), tabled(plant, surfaces)
    loop, stages = close_loop(plant, plant.position.top_stage + 1), plant.position.stage_pressures_kpa
    commands = in_transient = 0
    for i in range(20):
        trace = loop.follow(controller, loop.draws(random_passes(12, i, 1)))
        at = np.flatnonzero(~np.isnan(trace.measured_m_s))
        stage = 0
        for j, event in enumerate(at):
            # The pressure follows from the overpressure just before the sample only where the pads touch and the
            # pressure stands still; elsewhere the commands of this test are not checked.
            known = event > 1 and trace.overpressure_kpa[event] == trace.overpressure_kpa[event - 1] > 0.0
            s, v = trace.path_m[event], trace.measured_m_s[event]
            u, x = 2.0 * s / plant.exit_m - 1.0, 0.01 * (50.0 + trace.overpressure_kpa[event] - stages[stage])
            lower, upper = (
                sum(coefficients[stage, side, b, a] * x**b * u**a for b in range(2) for a in range(4))
                for side in (0, 1)
            )
            step = -1 if has_line[stage, 0] and v < lower else int(has_line[stage, 1] and v > upper)
            if known:
                assert trace.stage[event] - stage == step
                commands += step != 0
            in_transient += j > 0 and trace.stage[event] != stage and event - at[j - 1] > 1
            stage = int(trace.stage[event])
    assert commands > 10
    assert in_transient > 10  # commands while the pressure was moving


def test_two_stages_can_be_climbed_in_two_samples(plant: Plant) -> None:
    always_up = np.full((3, 2, 1), 0.5)
    has_line = np.array([[False, True], [False, True], [False, False]])
    trace = close_loop(plant, plant.position.top_stage + 1).follow(
        tabled(plant, polynomials(plant, always_up, has_line, (0,))),
        close_loop(plant, plant.position.top_stage + 1).draws(random_passes(1, 0, 1)),
    )
    times = trace.time_s[1:][np.diff(trace.stage) == 1]
    assert np.diff(times) == pytest.approx([0.1])
    pressure = 50.0 + trace.overpressure_kpa
    still_s = 0.02 + 0.1 + 0.2  # computing, valve and touch delay from the first command, and no second delay
    filled = trace.time_s[np.argmax(pressure > 284.9)] - times[0]
    assert filled == pytest.approx(still_s + 0.3 * math.log((700.0 - 15.0) / (700.0 - 285.0)), abs=0.021)
