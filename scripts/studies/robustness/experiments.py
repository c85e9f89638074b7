"""The experiments on one table: one parameter at a time, sweeps, all parameters together."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant
from scripts.studies.robustness.findings import EndsRow, SweepRow, TogetherRow
from scripts.studies.robustness.perturbation import Ends, all_off, one_off
from scripts.studies.robustness.trial import Trial
from scripts.studies.side_by_side import side_by_side
from synth.book.sensitivity.hypercube import unit_hypercube
from synth.configuration.plant_parameter import Parameter

DIGITS = 6
"""Decimals of what is kept of hundreds of points."""


def one_at_a_time(
    trial: Trial, parameters: Sequence[Parameter], ends: Callable[[Plant, Parameter], Ends]
) -> tuple[EndsRow, ...]:
    """Every parameter at both `ends` (of `perturbation.ends_by` or `sensible_ends`), the largest rms first."""

    def both(parameter: Parameter) -> EndsRow:
        low, high = ends(trial.plant, parameter)
        values = low.value, high.value
        less, more = trial.outcome(low), trial.outcome(high)
        return EndsRow(parameter.key, parameter.name, parameter.assumed, parameter.nominal, values, less, more)

    return tuple(sorted(side_by_side(both, parameters), key=lambda row: -row.worst.rms_m_s))


def sweep(trial: Trial, parameter: Parameter, relative: Sequence[float], limit_m_s: float) -> SweepRow:
    """`parameter` at each of `relative`, ascending, with 0 among them."""
    outcomes = side_by_side(lambda x: trial.outcome(one_off(trial.plant, parameter, x)), relative)
    rms = tuple(outcome.rms_m_s for outcome in outcomes)
    return SweepRow(
        parameter.key, parameter.name, tuple(relative), rms, steepest(rms), tolerated(relative, rms, limit_m_s), ()
    )


def steepest(rms_m_s: Sequence[float]) -> float:
    """The largest ratio between neighbouring points."""
    return max((max(a, b) / min(a, b) for a, b in pairwise(rms_m_s)), default=1.0)


def tolerated(
    relative: Sequence[float], rms_m_s: Sequence[float], limit_m_s: float
) -> tuple[float | None, float | None]:
    """How far the parameter may fall and rise before the rms passes the limit; None where it never does.

    Linear between the points; (0, 0) where the nominal plant itself is beyond it.
    """
    centre = list(relative).index(0.0)
    if rms_m_s[centre] > limit_m_s:
        return 0.0, 0.0
    down = first_crossing(relative[centre::-1], rms_m_s[centre::-1], limit_m_s)
    return down, first_crossing(relative[centre:], rms_m_s[centre:], limit_m_s)


def first_crossing(relative: Sequence[float], rms_m_s: Sequence[float], limit_m_s: float) -> float | None:
    """Where the rms first passes the limit on the way from `relative[0]`; linear between points, None if nowhere."""
    for (x, a), (y, b) in pairwise(zip(relative, rms_m_s, strict=True)):
        if b > limit_m_s:
            return float(x + (y - x) * (limit_m_s - a) / (b - a))
    return None


def hypercube(parameters: int, span: float, points: int, seed: int) -> NDArray[np.float64]:
    """Points of a Latin hypercube, uniform over ±`span`, (points, parameters)."""
    relative: NDArray[np.float64] = span * (2.0 * unit_hypercube(parameters, points, seed) - 1.0)
    return relative


def together(trial: Trial, parameters: Sequence[Parameter], span: float, points: int, seed: int) -> TogetherRow:
    """All assumed `parameters` that are not nominally zero, off at once by up to `span`."""
    from scipy.stats import spearmanr  # start-up: scipy only where it is needed

    varied = tuple(p for p in parameters if p.assumed and p.nominal != 0.0)
    relative = hypercube(len(varied), span, points, seed)
    outcomes = side_by_side(lambda row: trial.outcome(all_off(varied, row)), relative.tolist())
    rms = [outcome.rms_m_s for outcome in outcomes]
    return TogetherRow(
        span=span,
        passes=len(trial.passes),
        names=tuple(p.name for p in varied),
        rank_correlation=tuple(round(float(spearmanr(column, rms).statistic), DIGITS) for column in relative.T),
        rms_m_s=tuple(round(each, DIGITS) for each in rms),
        overspeed=tuple(round(outcome.overspeed, DIGITS) for outcome in outcomes),
        stalled=tuple(round(outcome.stalled, DIGITS) for outcome in outcomes),
    )
