"""Passes that end near the target, apart from the rare cuts that saturate the brake whatever the lines."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from plant_models.frozen_arrays import Floats
from synth.simulation.replicates import Interval, half_width, rms_of, share_of

if TYPE_CHECKING:
    from synth.simulation.passes import ExitSample

NEAR_M_S = 0.3
"""Cuts farther off than this have saturated the brake, and no line can mend that."""


@dataclass(frozen=True)
class NearTarget:
    """rms of the passes within `NEAR_M_S` of the target, its 95 % interval; share of all others."""

    rms_m_s: float
    ci95_m_s: Interval
    outside: float


def near_target(sample: ExitSample, target_m_s: float) -> NearTarget:
    """These figures of a sample."""
    error, weight = sample.exit_speed_m_s - target_m_s, sample.weight
    far = np.abs(error) > NEAR_M_S
    rms, ends = rms_of(error, np.where(far, 0.0, weight))
    return NearTarget(rms, ends, share_of(far, weight)[0])


def near_ratio(sample: ExitSample, reference: ExitSample, target_m_s: float) -> tuple[float, Interval]:
    """rms of the passes near the target / that of `reference`, on the same passes, and its 95 % interval (paired).

    Each sample counts those of its own passes that end near the target. The delta method on the logarithm of either
    rms, whose difference is taken pass by pass.
    """
    weight = sample.weight
    a, da = log_rms_near(sample.exit_speed_m_s - target_m_s, weight)
    b, db = log_rms_near(reference.exit_speed_m_s - target_m_s, weight)
    half = half_width(da - db, weight)
    return math.exp(a - b), (math.exp(a - b - half), math.exp(a - b + half))


def log_rms_near(error: Floats, weight: Floats) -> tuple[float, Floats]:
    """(logarithm of the rms of the passes near the target, what each pass adds to it to first order, in all 0)."""
    near = weight * (np.abs(error) <= NEAR_M_S)
    square, total = near * error**2, float(weight.sum())
    influence = 0.5 * total * (square / square.sum() - near / near.sum())
    return 0.5 * math.log(square.sum() / near.sum()), influence
