"""What a log says of each of its cuts, passes of the closed loop that are drawn from that, and the exits that
tables are predicted to give.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from plant_models import Plant
from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from plant_models.speed_sensor import measured_speed_std
from synth.kernels.loop.motion import brake_rows
from synth.kernels.loop.passes import Draws
from synth.kernels.measured.pass_filter import SLOWEST_M_S
from synth.logs import unknowns as asked
from synth.logs.fitting_passes import FittingPasses
from synth.logs.likelihood import Innovations, Likelihood, scales
from synth.problem.problem import OVERSPEED_M_S
from synth.simulation.closed_loop import ClosedLoop, close_loop
from synth.simulation.controllers import TableController, fixed
from synth.simulation.random_passes import RandomPasses, random_passes, readings_z
from tuning_tables.active_table import ActiveTable

OTHER_RESISTANCE = 1.25
"""Times its mean: where the friction is asked for a second time."""

KNOWN_SPREAD = 1e-6
"""Spread of a resistance that is told."""


@frozen_arrays
class KnownCuts:
    """(m,) each. Of the resistance w: `resistance_n_per_kn`, `resistance_variance`; of the friction ξ, given w:
    `friction` at w = `at_n_per_kn`, `by_resistance` dξ/dw, `friction_std`. `force`: brake on the cut over that on one
    of its class. `speed_m_s` and `path_m` at the first reading of the regulator, `speed_std_m_s`"""

    resistance_n_per_kn: Floats
    resistance_variance: Floats
    friction: Floats
    at_n_per_kn: Floats
    by_resistance: Floats
    friction_std: Floats
    force: Floats
    speed_m_s: Floats
    speed_std_m_s: float
    path_m: Floats

    def taken(self, numbers: Ints) -> KnownCuts:
        """Some of the cuts, in any order and as often as asked."""
        arrays = {name: value[numbers] for name, value in vars(self).items() if isinstance(value, np.ndarray)}
        return KnownCuts(**arrays, speed_std_m_s=self.speed_std_m_s)


def known_cuts(like: Likelihood, found: Innovations, values: Mapping[str, float]) -> KnownCuts:
    """From the filter of the likelihood, whose innovations at `values` are `found`.

    ξ and w are one normal law: two more runs of the filter, with a resistance that is told, give the law of ξ for it.
    """
    passes, log = like.passes, like.passes.log
    told = {**values, asked.RESISTANCE_SPREAD: KNOWN_SPREAD}
    mean = like.spread(told).resistance_n_per_kn
    other = {**told, **{asked.RESISTANCE + label: OTHER_RESISTANCE * mean_of_class(values, label, plant)
                        for label, plant in passes.plants}}  # fmt: skip
    here, there = like.at(told).cuts, like.at(other).cuts
    cuts = [passes.cut(number) for number in range(len(log))]
    force = np.empty(len(log))
    for number, (_, plant) in enumerate(passes.plants):
        mine = passes.class_of == number
        force[mine] = scales(plant, passes, cuts)[1][mine]
    bias = values.get(asked.BIAS, 0.0)
    # A log may begin before the regulator does.
    start_m = np.array([plant.start_m for _, plant in passes.plants])[passes.class_of][log.pass_of_row]
    usable = np.flatnonzero((log.speed_m_s - bias > SLOWEST_M_S) & (log.path_m >= start_m))
    rows = usable[np.minimum(np.searchsorted(usable, log.first_row[:-1]), len(usable) - 1)]
    return KnownCuts(
        found.cuts.resistance_n_per_kn, found.cuts.resistance_variance,
        here.friction, mean, (there.friction - here.friction) / ((OTHER_RESISTANCE - 1.0) * mean),
        np.sqrt(here.friction_variance), force, log.speed_m_s[rows] - bias,
        measured_speed_std(values[asked.NOISE], passes.plant.sensor.resolution_m_s), log.path_m[rows],
    )  # fmt: skip


def mean_of_class(values: Mapping[str, float], label: str, plant: Plant) -> float:
    """Mean resistance of a class."""
    return values.get(asked.RESISTANCE + label, plant.resistance.mean_n_per_kn)


def draws_of(loop: ClosedLoop, cuts: KnownCuts, passes: RandomPasses, fresh: bool) -> Draws:
    """One pass of the closed loop for each of `cuts` (n,) and `passes` (n,).

    The cut comes as it was measured, with friction and resistance as the log knows them, or, if `fresh`, as those of
    any cut of the class. Friction along the path and noise are new.
    """
    plant = loop.plant
    if fresh:
        resistance = loop.resistance_n_kn(passes.resistance_u)
        friction = plant.friction.cut_factor(passes.cut_z, plant.friction_cv)
    else:
        resistance = gamma_quantile(cuts.resistance_n_per_kn, cuts.resistance_variance, passes.resistance_u)
        friction = cuts.friction + cuts.by_resistance * (resistance - cuts.at_n_per_kn)
        friction = np.maximum(friction + cuts.friction_std * passes.cut_z, plant.friction.floor)
    factor, path_z = fixed(friction * cuts.force, np.float64), fixed(passes.path_z, np.float32)
    rows = np.empty((len(passes), len(loop.path.gravity_m_s2)))
    brake_rows(loop.path, factor, path_z, rows)
    start, first = begin(loop, cuts, resistance, passes.entry_u)
    return Draws(
        factor, fixed(resistance, np.float64), fixed(start, np.float64), fixed(first, np.float64), path_z,
        fixed(readings_z(passes, plant.sensor), np.float32), fixed(rows, np.float64), fixed(passes.weight, np.float64),
    )  # fmt: skip


def begin(loop: ClosedLoop, cuts: KnownCuts, resistance: Floats, u: Floats) -> tuple[Floats, Floats]:
    """Speed where the regulator begins to act, and the time from there to the first sample, (n,) each."""
    from scipy.special import ndtri  # start-up: scipy only where it is needed

    gravity = float(loop.path.gravity_m_s2[0])
    run_m = np.maximum(cuts.path_m - loop.plant.start_m, 0.0)
    speed = cuts.speed_m_s - cuts.speed_std_m_s * ndtri(np.clip(u, 1e-12, 1.0 - 1e-12))
    square = speed**2 - 2.0 * (gravity - loop.path.drag_m_s2_per_n_kn * resistance) * run_m
    start = np.sqrt(np.maximum(square, SLOWEST_M_S**2))
    since = run_m / np.maximum(0.5 * (start + speed), SLOWEST_M_S)
    # A reading may have been missing; samples come a period apart.
    return start, np.remainder(since, loop.sensor.period_s)


def gamma_quantile(mean: Floats, variance: Floats, u: Floats) -> Floats:
    """Quantiles `u` of gamma laws; the mean where there is no variance."""
    from scipy.special import gammaincinv  # start-up: scipy only where it is needed

    known = variance < 1e-9
    shape = np.where(known, 1.0, mean**2 / np.where(known, 1.0, variance))
    return np.asarray(np.where(known, mean, gammaincinv(shape, u) * mean / shape), dtype=np.float64)


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
