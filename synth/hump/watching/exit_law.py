"""How cuts left a position: mean and spread of exit speed less target, each with its interval."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.special import stdtrit
from scipy.stats import chi2

from plant_models.frozen_arrays import Floats
from synth.frame.interval import Interval

FEWEST = 3
"""Passes; fewer have no spread."""


@dataclass(frozen=True)
class ExitLaw:
    """Mean and standard deviation of exit errors; intervals are Student's, and that of χ² for a normal law."""

    mean_m_s: Interval
    std_m_s: Interval


def exit_law(errors_m_s: Floats) -> ExitLaw | None:
    """Of the errors that are known; None for fewer than `FEWEST`."""
    known = errors_m_s[np.isfinite(errors_m_s)]
    n = len(known)
    if n < FEWEST:
        return None
    mean, std = float(known.mean()), float(known.std(ddof=1))
    half = float(stdtrit(n - 1, 0.975)) * std / math.sqrt(n)
    low, high = (std * math.sqrt((n - 1) / float(chi2.ppf(q, n - 1))) for q in (0.975, 0.025))
    return ExitLaw(Interval(mean, mean - half, mean + half, n), Interval(std, low, high, n))
