"""The passes that tables with an estimator are trimmed and chosen on, shared out to days of another mean friction, and
those that they are predicted from.

Lines for a good estimate brake late. What they lose in reserve shows on days on which cuts brake worse than they
should; on the mean day it hardly shows. So they are judged on three days, by the quadrature of Gauss and Hermite for
the mean of ξ_cut: 1 and 1 ± √3·`mean_cv`. Where the mean is taken as known there is one day, the mean one.

There is no exact prediction: the state of an estimator (estimated speed and friction) would be two more axes of the
chain, and taking its error for a white one predicts 0.60 to 0.95 of the rms that is then simulated. So the prediction
comes from passes that neither design nor validation use: its prediction ratio tests the sample, not the model. Most of
the mean square is due to the few cuts of low friction, so the passes are stratified ones, weighted
(`simulation.stratified_passes`), and every class of cuts has its own: the chance of one sample is not that of a book.
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial

import numpy as np

from plant_models import Plant
from plant_models.friction import Friction
from plant_models.frozen_arrays import Floats, frozen_arrays
from synth.kernels.loop.passes import Draws
from synth.problem.criterion import SQUARED_ERROR, TerminalCost
from synth.problem.problem import OVERSPEED_M_S
from synth.simulation.closed_loop import ClosedLoop, close_loop
from synth.simulation.controllers import Regulator
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import PassRow, RandomPasses, random_passes
from synth.simulation.stratified_passes import stratified_passes
from synth.solver.exit_density import ExitDensity
from tuning_tables import Predicted

SEVERAL = (1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0), (-math.sqrt(3.0), 0.0, math.sqrt(3.0))
ONE = (1.0,), (0.0,)
"""Weights of the days, and their means of ξ_cut in standard deviations from 1."""

LEAST_STD = 1e-12


@frozen_arrays
class TuningDays:
    """`draws`: the passes of each day; `loop(stages)`: the plant of any day with a regulator of so many stages;
    `weight` (D,): how many of all days each stands for."""

    loop: Callable[[int], ClosedLoop]
    draws: tuple[Draws, ...]
    weight: Floats

    def mean_squares(
        self,
        controller: Regulator,
        target_speed_m_s: float,
        change_m2_s2: float = 0.0,
        second_m2_s3: float = 0.0,
        terminal: TerminalCost = SQUARED_ERROR,
    ) -> Floats:
        """Mean cost of the exit speed on each day, (D,) in m²/s², by default the squared error, and what commands and
        seconds cost."""
        found = []
        for draws in self.draws:
            passed = self.loop(controller.stages).run(controller, draws)
            squares = terminal.at_exit(passed.exit_speed_m_s, target_speed_m_s)
            squares = squares + change_m2_s2 * passed.switchings + second_m2_s3 * passed.transit_time_s
            found.append(np.average(squares, weights=draws.weight))
        return np.array(found)


def tuning_days(plant: Plant, passes: RandomPasses) -> TuningDays:
    """The days of `plant`; each gets its part of `passes`."""
    weights, means = SEVERAL if plant.friction.mean_cv > 0.0 else ONE
    loops = cache(partial(close_loop, replace(plant, friction=plant.friction.of_any_day)))
    loop = loops(plant.top_stage + 1)
    share = len(passes) // len(means)
    parts = [passes.part(share * day, share * (day + 1)) for day in range(len(means))]
    # ξ_cut = 1 + mean_cv·y + CV·z, told as 1 + (CV of any day)·z'.
    whole = max(loop.plant.friction_cv, LEAST_STD)
    of_cut, of_mean = plant.friction_cv / whole, plant.friction.mean_cv / whole
    draws = (
        loop.draws(replace(part, cut_z=of_cut * part.cut_z + of_mean * y)) for part, y in zip(parts, means, strict=True)
    )
    return TuningDays(loops, tuple(draws), np.array(weights))


def tuning_row(friction: Friction) -> PassRow:
    """The row of passes for it: in strata where days of low friction count, whose rare cuts plain passes miss."""
    return stratified_passes if friction.mean_cv > 0.0 else random_passes


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
