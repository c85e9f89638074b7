"""Exits that tables are predicted to give on measured cuts."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.logs.fitting_passes import FittingPasses
from synth.logs.replay.known_cuts import KnownCuts, draws_of
from synth.problem.aim import OVERSPEED_M_S
from synth.simulation.closed_loop import close_loop
from synth.simulation.controllers import TableController
from synth.simulation.random_passes import random_passes
from tuning_tables.active_table import ActiveTable

TOGETHER = 4000
"""Passes of the closed loop in memory at a time."""

BAND = (0.1, 0.9)
"""Quantiles at the ends of the band of a prediction."""


@frozen_arrays
class PredictedExits:
    """Of m passes under one table: `mean_m_s` and `band_m_s` (m, 2) of the exit speed, `square_m2_s2` mean square of
    exit − target, `overspeed` chance of an exit more than 0.3 m/s too fast; NaN where there is no prediction."""

    mean_m_s: Floats
    band_m_s: Floats
    square_m2_s2: Floats
    overspeed: Floats


@dataclass(frozen=True)
class Replayer:
    """`passes` with what is known of their cuts; `draws` of each pass, from the row of random numbers of `seed`."""

    passes: FittingPasses
    cuts: KnownCuts
    draws: int
    seed: int

    def exits(self, tables: Sequence[ActiveTable], of_pass: Ints, fresh: bool) -> Floats:
        """Exit speeds (m, draws) under the table of each pass; NaN for passes whose `of_pass` is negative.

        The same cuts, friction and noise whatever the tables: exits under two books differ by the books alone. With
        `fresh` the cuts are any of their class, and only their entry is as measured.
        """
        log = self.passes.log
        exits = np.full((len(log), self.draws), np.nan)
        for number, (_, plant) in enumerate(self.passes.plants):
            of_class = np.flatnonzero(self.passes.class_of == number)
            loops = {stages: close_loop(plant, stages) for stages in {len(t.coefficients) for t in tables}}
            size = max(1, TOGETHER // self.draws)
            for first in range(0, len(of_class), size):
                some = of_class[first : first + size]
                for table in sorted(set(of_pass[some].tolist()) - {-1}):
                    mine = np.flatnonzero(of_pass[some] == table)
                    loop = loops[len(tables[table].coefficients)]
                    cells = len(loop.path.gravity_m_s2) - loop.path.approach_cells
                    passes = random_passes(self.seed + number, first * self.draws, len(some) * self.draws, cells)
                    rows = (mine[:, None] * self.draws + np.arange(self.draws)).ravel()
                    chosen = type(passes)(**{name: values[rows] for name, values in vars(passes).items()})
                    drawn = draws_of(loop, self.cuts.taken(np.repeat(some[mine], self.draws)), chosen, fresh)
                    sample = loop.run(TableController(tables[table]), drawn)
                    exits[some[mine]] = sample.exit_speed_m_s.reshape(len(mine), self.draws)
        return exits


def predicted_exits(exits: Floats, target_m_s: Floats) -> PredictedExits:
    """What `exits` (m, draws) say, with the targets (m,)."""
    error = exits - target_m_s[:, None]
    return PredictedExits(
        exits.mean(axis=1),
        np.quantile(exits, BAND, axis=1).T,
        np.mean(error**2, axis=1),
        np.where(np.isnan(error[:, 0]), np.nan, np.mean(error > OVERSPEED_M_S, axis=1)),
    )


@dataclass(frozen=True)
class Bootstrapped:
    """A figure of all passes with its 95 % interval: passes are drawn anew, with replacement."""

    value: float
    ci95: tuple[float, float]


RESAMPLES = 1000


def bootstrapped(figure: Callable[[Floats], Floats], passes: int, seed: int) -> Bootstrapped:
    """`figure` takes weights (k, passes), each row of sum 1, and gives k values."""
    rng = np.random.default_rng(seed)
    weights = rng.multinomial(passes, np.full(passes, 1.0 / passes), RESAMPLES) / passes
    low, high = np.quantile(figure(weights), (0.025, 0.975))
    return Bootstrapped(float(figure(np.full((1, passes), 1.0 / passes))[0]), (float(low), float(high)))
