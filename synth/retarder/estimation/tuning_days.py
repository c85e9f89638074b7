"""The passes that tables with an estimator are trimmed and chosen on, shared out to days of another mean friction.

Lines for a good estimate brake late. What they lose in reserve shows on days on which cuts brake worse than they
should; on the mean day it hardly shows. So they are judged on three days, by the quadrature of Gauss and Hermite for
the mean of ξ_cut: 1 and 1 ± √3·`mean_cv`. Where the mean is taken as known there is one day, the mean one.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from functools import cache, partial

import numpy as np

from plant_models import Plant
from plant_models.friction import Friction
from plant_models.frozen_arrays import Floats, frozen_arrays
from synth.kernels.loop.passes import Draws
from synth.problem.criterion import SQUARED_ERROR
from synth.problem.terminal_cost import TerminalCost
from synth.simulation.closed_loop import ClosedLoop, close_loop
from synth.simulation.controllers import Regulator
from synth.simulation.random_passes import PassRow, RandomPasses, random_passes
from synth.simulation.stratified_passes import stratified_passes

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
