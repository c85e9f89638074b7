"""A table for a regulator that compares the estimated speed with its lines.

Solver and polish take the estimate for a sensor with a smaller, white error. It is not white: what friction does
along the path enters the estimate and the motion alike, and a cut that brakes worse than it did is thought slower
than it is. What that does to the exit is a small shift, which a trim of all lower and all upper lines takes out in the
closed loop, on passes that no validation uses.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant
from plant_models.speed_sensor import measured_speed_std
from synth.book.estimation.estimator_design import estimator_of, speed_error_m_s
from synth.kernels.loop.closed_loop import Draws
from synth.problem.estimator_resolution import estimator_resolution, guessed_error_m_s
from synth.problem.problem import Problem
from synth.problem.resolution import Resolution
from synth.simulation.closed_loop import ClosedLoop, LineController, close_loop
from synth.simulation.random_passes import RandomPasses
from synth.solver.chain.chain import Chain, persistent_chain
from synth.solver.chain.speed_measurement import SmoothMeasurement
from synth.solver.polynomial_lines import PolynomialLines, opened
from synth.solver.tuned_lines import tuned_lines
from tuning_tables.estimator import Estimator

ROUNDS = 3
SETTLED = 0.05
"""Designs are repeated until the error found in the closed loop differs by less than this share, at most so often."""

ERROR_PASSES = 100
TRIM_EVALUATIONS = 25
FIRST_TRIM_M_S = 0.02


@dataclass(frozen=True)
class EstimatedTable:
    """Lines for the estimated speed, the estimator, and the error of its speed where decisions are taken.

    `trim_m_s`: what was added to all lower and to all upper lines; `rms_before_m_s`, `rms_after_m_s`: simulated on the
    tuning passes without and with it; `rounds`: designs until the error had settled. `designed`: whether the lines are
    those designed for the estimate; else those for the measured speed did better with it, too.
    `plain_rms_m_s`: of the latter without estimator, on the same passes.
    """

    lines: PolynomialLines
    estimator: Estimator
    error_m_s: float
    trim_m_s: tuple[float, float]
    rms_before_m_s: float
    rms_after_m_s: float
    rounds: int
    designed: bool
    plain_rms_m_s: float

    @property
    def gains(self) -> bool:
        """Whether the estimator did better than none on the tuning passes; else it should be left out."""
        return self.rms_after_m_s < self.plain_rms_m_s


def estimator_design(plant: Plant, resolution: Resolution, lowest_target_m_s: float) -> Chain:
    """The grid to design lines for estimated speeds on, for all errors and targets of a plant."""
    return persistent_chain(plant, estimator_resolution(resolution, plant.sensor, lowest_target_m_s))


def estimated_table(problem: Problem, design: Chain, measured: PolynomialLines, tuning: RandomPasses) -> EstimatedTable:
    """Design the lines of one case for its estimator, on the `estimator_design` of its plant.

    `measured`: lines for the measured speed, of the degree wanted; kept where design goes wrong. `tuning` are passes to
    find the error and the trim on.
    """
    plant, estimator = problem.plant, estimator_of(problem.plant)
    loop = close_loop(plant, plant.top_stage + 1)
    error = guessed_error_m_s(plant.sensor)
    rounds, settled = 0, False
    while not settled and rounds < ROUNDS:
        rounds += 1
        lines = designed_lines(problem, design, measured.degree, error)
        controller = controller_of(lines, estimator)
        found = speed_error_m_s(loop, controller, tuning.part(0, min(ERROR_PASSES, len(tuning))))
        settled = abs(found - error) <= SETTLED * error
        error = found
    draws = loop.draws(tuning)

    def trim(lines: PolynomialLines) -> tuple[tuple[float, float], float, float]:
        return trimmed(lambda a, b: rms_of(loop, draws, shifted(lines, a, b), estimator, problem))

    shifts, before, after = trim(lines)
    plain = rms_of(loop, draws, measured, None, problem)
    designed = after <= rms_of(loop, draws, measured, estimator, problem)
    if not designed:
        lines = measured
        shifts, before, after = trim(lines)
    return EstimatedTable(shifted(lines, *shifts), estimator, error, shifts, before, after, rounds, designed, plain)


def designed_lines(problem: Problem, design: Chain, degree: int, error_m_s: float) -> PolynomialLines:
    """Solved, fitted and polished for a regulator that sees the speed with a white error, unquantised."""
    seen = replace(design, measurement=SmoothMeasurement(measured_speed_std(error_m_s, 0.0)))
    return tuned_lines(seen, problem.aim, degree).lines


def controller_of(lines: PolynomialLines, estimator: Estimator | None) -> LineController:
    """A regulator that compares the estimated speed with `lines`; without an estimator, the measured one."""
    return LineController(lines.at(lines.nodes_m(301)), estimator=estimator)


def shifted(lines: PolynomialLines, lower_m_s: float, upper_m_s: float) -> PolynomialLines:
    """All lower and all upper lines moved, and no pair nearer than the polish allows."""
    coefficients: NDArray[np.float64] = lines.coefficients.copy()
    # The constant Legendre polynomial is 1.
    coefficients[:, 0, 0] += lower_m_s
    coefficients[:, 1, 0] += upper_m_s
    return opened(replace(lines, coefficients=coefficients))


def rms_of(
    loop: ClosedLoop, draws: Draws, lines: PolynomialLines, estimator: Estimator | None, problem: Problem
) -> float:
    """Simulated rms error at the exit, m/s."""
    exits = loop.run(controller_of(lines, estimator), draws).exit_speed_m_s
    return float(np.sqrt(np.mean((exits - problem.target_speed_m_s) ** 2)))


def trimmed(rms: Callable[[float, float], float]) -> tuple[tuple[float, float], float, float]:
    """The two shifts with the least `rms` that a short simplex search finds, with `rms` before and after.

    Never worse than no shift: that is where the search begins.
    """
    from scipy.optimize import minimize  # start-up: scipy only where it is needed

    before = rms(0.0, 0.0)
    simplex = [[0.0, 0.0], [FIRST_TRIM_M_S, 0.0], [0.0, FIRST_TRIM_M_S]]
    options: Any = {"initial_simplex": simplex, "maxfev": TRIM_EVALUATIONS, "xatol": 1e-3, "fatol": 1e-5}

    def objective(x: Any) -> Any:
        return rms(float(x[0]), float(x[1]))

    found = minimize(objective, np.zeros(2), method="Nelder-Mead", options=options)
    if found.fun >= before:
        return (0.0, 0.0), before, before
    return (float(found.x[0]), float(found.x[1])), before, float(found.fun)
