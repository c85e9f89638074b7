"""A table for a regulator that compares the estimated speed with its lines.

Solver and polish take the estimate for a sensor with a small, white error. It is not white: what friction does along
the path enters the estimate and the motion alike, and a cut that brakes worse than it did is thought slower than it is.
What that does to the exit is a small shift, which a trim of all lower and of all upper lines takes out in the closed
loop, on passes that no validation uses.

Lines for a good estimate brake later than lines for the measured speed, and keep less reserve for cuts of little
friction. So they are designed for the friction of any day, and trimmed on several (`tuning_days`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, Generic, TypeVar

import numpy as np

from plant_models.frozen_arrays import Floats
from synth.problem.criterion import SQUARED_ERROR, Criterion, TerminalCost
from synth.retarder.estimation.tuning_days import TuningDays
from synth.simulation.closed_loop import Controller, LineController
from synth.solver.any_time.polynomial_surfaces import PolynomialSurfaces
from synth.solver.switching_lines import PolynomialLines, opened
from tuning_tables.estimator import Estimator

FIRST_TRIM_M_S = 0.02
LEAST_SQUARE_M2_S2 = 1e-12

Lines = TypeVar("Lines", PolynomialLines, PolynomialSurfaces)

Pairs = tuple[tuple[float, float], ...]
"""What is added to lower and to upper lines, m/s: times Legendre polynomials of the path, from the constant up."""


@dataclass(frozen=True)
class Trim:
    """How lines are trimmed: how many Legendre polynomials of the path move, in so many evaluations.

    `change_m2_s2`, `second_m2_s3`: what a command and a second cost beside the squared error, or what else an
    exit speed costs by `terminal`.
    """

    terms: int
    evaluations: int
    change_m2_s2: float = 0.0
    second_m2_s3: float = 0.0
    terminal: TerminalCost = SQUARED_ERROR


SHIFTS = Trim(1, 14)
"""All lower and all upper lines are shifted. Commands at rest are few, and cost nothing here. With 25 evaluations the
mean rms of the default book is the same within 0.5 %."""


@dataclass(frozen=True)
class EstimatedTable(Generic[Lines]):
    """Lines or surfaces for the estimated speed, and the estimator.

    `error_m_s`: the error of the speed that they were designed for; `trim_m_s`: what was added to all lower and to all
    upper lines afterwards; `rms_before_m_s`, `rms_after_m_s`: simulated on the tuning passes without and with it. With
    several days, each counts by its ratio to that without trim: an rms is that of the mean day, times the quadratic
    mean of the days' ratios.
    """

    lines: Lines
    estimator: Estimator
    error_m_s: float
    trim_m_s: Pairs
    rms_before_m_s: float
    rms_after_m_s: float


@dataclass(frozen=True)
class Untrimmed(Generic[Lines]):
    """Lines or surfaces designed for an estimated speed with the error `error_m_s`, before the trim.

    `controller`: a regulator that compares the estimated speed with such lines; `opened`: the lines with every pair far
    enough apart.
    """

    lines: Lines
    estimator: Estimator
    error_m_s: float
    controller: Callable[[Lines, Estimator], Controller]
    opened: Callable[[Lines], Lines]
    trim: Trim

    def moved(self, by_m_s: Pairs) -> Lines:
        """All lower and all upper lines moved, and no pair nearer than the polish allows."""
        return self.opened(moved(self.lines, by_m_s))


def trimmed_on(days: TuningDays, target_m_s: float, design: Untrimmed[Lines]) -> EstimatedTable[Lines]:
    """The lines of `design` with the shifts that are best on `days`."""

    def squares(by_m_s: Pairs) -> Floats:
        controller = design.controller(design.moved(by_m_s), design.estimator)
        prices = design.trim.change_m2_s2, design.trim.second_m2_s3, design.trim.terminal
        return days.mean_squares(controller, target_m_s, *prices)

    as_designed = np.maximum(squares(no_shift(design.trim)), LEAST_SQUARE_M2_S2)
    share = days.weight * as_designed[len(as_designed) // 2] / as_designed

    def rms(by_m_s: Pairs) -> float:
        return float(np.sqrt(share @ squares(by_m_s)))

    shifts, before, after = trimmed(rms, design.trim)
    return EstimatedTable(design.moved(shifts), design.estimator, design.error_m_s, shifts, before, after)


def lines_for_estimate(
    lines: PolynomialLines, estimator: Estimator, error_m_s: float, criterion: Criterion
) -> Untrimmed[PolynomialLines]:
    """Lines for commands at rest, to be trimmed for `criterion`."""
    shifts = replace(SHIFTS, second_m2_s3=criterion.time_price_m2_s3, terminal=criterion.terminal)
    return Untrimmed(lines, estimator, error_m_s, controller_of, opened, shifts)


def controller_of(lines: PolynomialLines, estimator: Estimator | None) -> LineController:
    """A regulator that compares the estimated speed with `lines`; without an estimator, the measured one."""
    return LineController(lines.at(lines.nodes_m(301)), estimator=estimator)


def moved(lines: Lines, by_m_s: Pairs) -> Lines:
    """All lower and all upper lines moved."""
    coefficients: Floats = lines.coefficients.copy()
    for term, (lower, upper) in enumerate(by_m_s):
        coefficients[:, 0, term] += lower
        coefficients[:, 1, term] += upper
    return replace(lines, coefficients=coefficients)


def no_shift(how: Trim) -> Pairs:
    """Every Legendre polynomial times nothing."""
    return ((0.0, 0.0),) * how.terms


def trimmed(rms: Callable[[Pairs], float], how: Trim) -> tuple[Pairs, float, float]:
    """The shifts with the least `rms` that a short simplex search finds, with `rms` before and after.

    Never worse than no shift: that is where the search begins.
    """
    from scipy.optimize import minimize  # start-up: scipy only where it is needed

    numbers = 2 * how.terms

    def pairs(x: Any) -> Pairs:
        return tuple((float(lower), float(upper)) for lower, upper in np.reshape(x, (-1, 2)))

    def objective(x: Any) -> Any:
        return rms(pairs(x))

    before = rms(no_shift(how))
    simplex = np.vstack([np.zeros(numbers), FIRST_TRIM_M_S * np.eye(numbers)])
    options: Any = {"initial_simplex": simplex, "maxfev": how.evaluations, "xatol": 1e-3, "fatol": 1e-5}
    found = minimize(objective, np.zeros(numbers), method="Nelder-Mead", options=options)
    if found.fun >= before:
        return no_shift(how), before, before
    return pairs(found.x), before, float(found.fun)
