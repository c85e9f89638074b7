"""A prediction from simulated passes, where no exact one exists: regulators with an estimator.

The state of an estimator (estimated speed and friction) would be two more axes of the chain, and taking its error for
a white one predicts 0.60 to 0.95 of the rms that is then simulated. So the prediction comes from passes that neither
design nor validation use: its honesty tests the sample, not the model.

Most of the mean square is due to the few cuts whose friction is far from the mean. So frictions are drawn with
`WIDENING` times the spread, and each pass counts by how much rarer it is in truth.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from synth.criterion.exit_density import ExitDensity
from synth.fitting.tabulate import OVERSPEED_M_S
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses, random_passes
from tuning_tables import Predicted

WIDENING = 1.5


@dataclass(frozen=True)
class WeightedPasses:
    """Passes, and the share of the whole (n,) that each stands for."""

    passes: RandomPasses
    weight: NDArray[np.float64]


def weighted_passes(seed: int, count: int) -> WeightedPasses:
    """`count` passes of `seed` with friction factors spread `WIDENING` times as widely, and their weights."""
    passes = random_passes(seed, 0, count)
    z = WIDENING * passes.cut_z
    weight = np.exp(0.5 * (passes.cut_z**2 - z**2))
    return WeightedPasses(replace(passes, cut_z=z), weight / weight.sum())


def simulated_prediction(sample: ExitSample, weight: NDArray[np.float64], target_speed_m_s: float) -> Predicted:
    """The figures of a table as `sample` has them, weighted (n,); a stall counts as exit speed 0."""
    error = sample.exit_speed_m_s - target_speed_m_s
    return Predicted(
        rms_m_s=float(np.sqrt(weight @ error**2)),
        bias_m_s=float(weight @ error) + 0.0,  # no -0.0
        p_overspeed=min(float(weight[error > OVERSPEED_M_S].sum()), 1.0),
        switchings=float(weight @ sample.switchings),
        p_stall=min(float(weight[sample.stalled].sum()), 1.0),
        passes=len(error),
    )


def density_of(sample: ExitSample, weight: NDArray[np.float64], speed_m_s: NDArray[np.float64]) -> ExitDensity:
    """The passes shared out between grid speeds (E,), even in v²/2, so that the mean energy is kept."""
    moving, part = sample.exit_speed_m_s[~sample.stalled], weight[~sample.stalled]
    place = np.clip(0.5 * moving**2 / (0.5 * speed_m_s[1] ** 2), 0.0, len(speed_m_s) - 1.0)
    cell = np.minimum(place.astype(np.int64), len(speed_m_s) - 2)
    share = place - cell
    size = len(speed_m_s)
    probability = np.bincount(cell, part * (1.0 - share), size) + np.bincount(cell + 1, part * share, size)
    return ExitDensity(
        speed_m_s=speed_m_s,
        probability=probability.astype(np.float64),
        stalled=float(weight[sample.stalled].sum()),
        escaped=0.0,
        switchings=float(weight @ sample.switchings),
    )
