"""A table for a regulator that compares the estimated speed with its lines.

Solver and polish take the estimate for a sensor with a smaller, white error. It is not white: what friction does
along the path enters the estimate and the motion alike, and a cut that brakes worse than it did is thought slower
than it is. What that does to the exit is a small shift, which a trim of all lower and all upper lines takes out in the
closed loop, on passes that no validation uses.

Lines for a good estimate brake later than lines for the measured speed, and keep less reserve for cuts of little
friction. So they are designed for the friction of any day, and trimmed and chosen on several (`tuning_days`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant
from plant_models.speed_sensor import measured_speed_std
from synth.book.estimation.estimator_design import estimator_of, speed_error_m_s
from synth.book.estimation.tuning_days import tuning_days
from synth.problem.estimator_resolution import estimator_resolution, guessed_error_m_s
from synth.problem.problem import Problem
from synth.problem.resolution import Resolution
from synth.simulation.closed_loop import Controller, LineController, close_loop
from synth.simulation.random_passes import RandomPasses
from synth.solver.any_time.polynomial_surfaces import PolynomialSurfaces
from synth.solver.chain.chain import Chain, persistent_chain
from synth.solver.chain.speed_measurement import SmoothMeasurement
from synth.solver.polynomial_lines import PolynomialLines, opened
from synth.solver.tuned_lines import POLISH_TOLERANCE, tuned_lines
from tuning_tables.estimator import Estimator

ROUNDS = 3
SETTLED = 0.05
"""Designs are repeated until the error found in the closed loop differs by less than this share, at most so often."""

ERROR_PASSES = 100
FIRST_TRIM_M_S = 0.02
LEAST_SQUARE_M2_S2 = 1e-12

RESERVE_NODES = 1
"""More scenarios of friction for any day: lines keep a reserve down to the lowest of them and no further."""

RESERVE_TOLERANCE = 1e-3
"""Of the polish for the friction of any day: most of that cost is of cuts that no lines can brake, and a share of it
would be too coarse."""

NO_WORSE = 1.03
"""Of the rms without estimator; a table that is worse than this on one of its days has no estimator."""


Lines = TypeVar("Lines", PolynomialLines, PolynomialSurfaces)

Pairs = tuple[tuple[float, float], ...]
"""What is added to lower and to upper lines, m/s: times Legendre polynomials of the path, from the constant up."""


@dataclass(frozen=True)
class Trim:
    """How lines are trimmed: how many Legendre polynomials of the path move, in so many evaluations.

    `change_m2_s2`, `second_m2_s3`: what a command and a second cost beside the squared error.
    """

    terms: int
    evaluations: int
    change_m2_s2: float = 0.0
    second_m2_s3: float = 0.0


FREE = Trim(0, 0)
"""Nothing moves, and nothing has a price beside the squared error."""

SHIFTS = Trim(1, 25)
"""All lower and all upper lines are shifted. Commands at rest are few, and cost nothing here."""


@dataclass(frozen=True)
class EstimatedTable(Generic[Lines]):
    """Lines or surfaces for the estimated speed, the estimator, and the error of its speed where decisions are taken.

    `trim_m_s`: what was added to all lower and to all upper lines; `rms_before_m_s`, `rms_after_m_s`: simulated on the
    tuning passes without and with it; `rounds`: designs until the error had settled. `designed`: whether the lines are
    those designed for the estimate; else those for the measured speed did better with it, too.
    `plain_rms_m_s`: of the latter without estimator, on the same passes; `worst_day`: the largest ratio, with estimator
    to without, of the rms on one of the days that the passes stand for.

    With several days, each counts by that ratio: an rms is `plain_rms_m_s` of the mean day, times the quadratic mean
    of the days' ratios.
    """

    lines: Lines
    estimator: Estimator
    error_m_s: float
    trim_m_s: Pairs
    rms_before_m_s: float
    rms_after_m_s: float
    rounds: int
    designed: bool
    plain_rms_m_s: float
    worst_day: float

    @property
    def gains(self) -> bool:
        """Whether the estimator did better than none on the tuning passes, and not much worse on any day of them.

        Else it should be left out.
        """
        return self.rms_after_m_s < self.plain_rms_m_s and self.worst_day <= NO_WORSE


def estimator_design(plant: Plant, resolution: Resolution, lowest_target_m_s: float) -> Chain:
    """The grid to design lines for estimated speeds on, for all errors and targets of a plant on any day."""
    of_any_day = replace(plant, friction=plant.friction.of_any_day)
    finer = estimator_resolution(resolution, plant.sensor, lowest_target_m_s)
    if plant.friction.mean_cv > 0.0:
        finer = replace(finer, friction_nodes=finer.friction_nodes + RESERVE_NODES)
    return persistent_chain(of_any_day, finer)


def estimated_table(
    problem: Problem, design: Chain, measured: PolynomialLines, tuning: RandomPasses
) -> EstimatedTable[PolynomialLines]:
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
    shifts = replace(SHIFTS, second_m2_s3=problem.criterion.time_price_m2_s3)
    design_of_both = Design(lines, measured, estimator, error, rounds, controller_of, opened, shifts)
    return fitted_to_days(problem, design_of_both, tuning)


@dataclass(frozen=True)
class Design(Generic[Lines]):
    """Lines or surfaces `designed` for an estimated speed, and those for the `measured` one, both before the trim.

    `controller`: a regulator that compares the estimated speed with such lines, or without an estimator the measured
    one; `opened`: the lines with every pair far enough apart.
    """

    designed: Lines
    measured: Lines
    estimator: Estimator
    error_m_s: float
    rounds: int
    controller: Callable[[Lines, Estimator | None], Controller]
    opened: Callable[[Lines], Lines]
    trim: Trim

    def moved(self, lines: Lines, by_m_s: Pairs) -> Lines:
        """All lower and all upper lines moved, and no pair nearer than the polish allows."""
        return self.opened(moved(lines, by_m_s))


def fitted_to_days(problem: Problem, design: Design[Lines], tuning: RandomPasses) -> EstimatedTable[Lines]:
    """The better of both trimmed on `tuning`, each with the estimator; beside it those measured without."""
    days, target_m_s = tuning_days(problem.plant, tuning), problem.target_speed_m_s

    def squares(lines: Lines, estimator: Estimator | None, prices: Trim = FREE) -> NDArray[np.float64]:
        controller = design.controller(lines, estimator)
        return days.mean_squares(controller, target_m_s, prices.change_m2_s2, prices.second_m2_s3)

    plain = np.maximum(squares(design.measured, None), LEAST_SQUARE_M2_S2)
    share = days.weight * plain[len(plain) // 2] / plain

    def rms(lines: Lines, prices: Trim = FREE) -> float:
        return float(np.sqrt(share @ squares(lines, design.estimator, prices)))

    def trim(lines: Lines) -> Pairs:
        return trimmed(lambda pairs: rms(design.moved(lines, pairs), design.trim), design.trim)[0]

    lines = design.designed
    shifts = trim(lines)
    designed = rms(design.moved(lines, shifts)) <= rms(design.measured)
    if not designed:
        lines = design.measured
        shifts = trim(lines)
    kept = design.moved(lines, shifts)
    before, after = rms(lines), rms(kept)
    worst_day = float(np.sqrt((squares(kept, design.estimator) / plain).max()))
    rms_plain = float(np.sqrt(share @ plain))
    how = design.estimator, design.error_m_s, shifts, before, after, design.rounds, designed
    return EstimatedTable(kept, *how, rms_plain, worst_day)


def designed_lines(problem: Problem, design: Chain, degree: int, error_m_s: float) -> PolynomialLines:
    """Solved, fitted and polished for a regulator that sees the speed with a white error, unquantised."""
    seen = replace(design, measurement=SmoothMeasurement(measured_speed_std(error_m_s, 0.0)))
    tolerance = RESERVE_TOLERANCE if problem.plant.friction.mean_cv > 0.0 else POLISH_TOLERANCE
    return tuned_lines(seen, problem.aim, degree, tolerance).lines


def controller_of(lines: PolynomialLines, estimator: Estimator | None) -> LineController:
    """A regulator that compares the estimated speed with `lines`; without an estimator, the measured one."""
    return LineController(lines.at(lines.nodes_m(301)), estimator=estimator)


def moved(lines: Lines, by_m_s: Pairs) -> Lines:
    """All lower and all upper lines moved."""
    coefficients: NDArray[np.float64] = lines.coefficients.copy()
    for term, (lower, upper) in enumerate(by_m_s):
        coefficients[:, 0, term] += lower
        coefficients[:, 1, term] += upper
    return replace(lines, coefficients=coefficients)


def trimmed(rms: Callable[[Pairs], float], how: Trim) -> tuple[Pairs, float, float]:
    """The shifts with the least `rms` that a short simplex search finds, with `rms` before and after.

    Never worse than no shift: that is where the search begins.
    """
    from scipy.optimize import minimize  # start-up: scipy only where it is needed

    numbers = 2 * how.terms

    def pairs(x: Any) -> Pairs:
        return tuple((float(lower), float(upper)) for lower, upper in np.reshape(x, (-1, 2)))

    before = rms(pairs(np.zeros(numbers)))
    simplex = np.vstack([np.zeros(numbers), FIRST_TRIM_M_S * np.eye(numbers)])
    options: Any = {"initial_simplex": simplex, "maxfev": how.evaluations, "xatol": 1e-3, "fatol": 1e-5}

    def objective(x: Any) -> Any:
        return rms(pairs(x))

    found = minimize(objective, np.zeros(numbers), method="Nelder-Mead", options=options)
    if found.fun >= before:
        return pairs(np.zeros(numbers)), before, before
    return pairs(found.x), before, float(found.fun)
