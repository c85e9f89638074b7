"""A prediction from simulated passes, where no exact one exists: regulators with an estimator.

The state of an estimator (estimated speed and friction) would be two more axes of the chain, and taking its error for
a white one predicts 0.60 to 0.95 of the rms that is then simulated. So the prediction comes from passes that neither
design nor validation use: its prediction ratio tests the sample, not the model.

Most of the mean square is due to the few cuts of low friction, so the passes are stratified ones, weighted
(`simulation.stratified_passes`), and every class of cuts has its own: the chance of one sample is not that of a book.
"""

from __future__ import annotations

import zlib

import numpy as np

from plant_models.frozen_arrays import Floats
from synth.problem.aim import OVERSPEED_M_S
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.exit_density import ExitDensity
from tuning_tables import Predicted

PREDICTION_PASSES = 10_000

CLASSES = 2**20
"""Rows of passes that labels of classes are shared out to."""


def prediction_passes(seed: int, label: str) -> RandomPasses:
    """The passes that tables of the class `label` are predicted on: a part of the row `seed` that its label gives."""
    return stratified_passes(seed, zlib.crc32(label.encode("utf-8")) % CLASSES * PREDICTION_PASSES, PREDICTION_PASSES)


def simulated_prediction(sample: ExitSample, target_speed_m_s: float) -> Predicted:
    """The figures of a table as `sample` has them; a stall counts as exit speed 0."""
    error, weight = sample.exit_speed_m_s - target_speed_m_s, sample.weight / sample.weight.sum()
    return Predicted(
        rms_m_s=float(np.sqrt(weight @ error**2)),
        bias_m_s=float(weight @ error) + 0.0,  # no -0.0
        p_overspeed=min(float(weight[error > OVERSPEED_M_S].sum()), 1.0),
        switchings=float(weight @ sample.switchings),
        p_stall=min(float(weight[sample.stalled].sum()), 1.0),
        passes=len(error),
    )


def density_of(sample: ExitSample, speed_m_s: Floats) -> ExitDensity:
    """The passes shared out between grid speeds (E,), even in v²/2, so that the mean energy is kept."""
    weight = sample.weight / sample.weight.sum()
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
