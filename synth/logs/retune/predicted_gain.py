"""What new tables gain against old ones on a plant that is known as well as measured passes tell it."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from plant_models import Plant, PlantError
from synth.frame.input_error import InputError
from synth.logs.estimate import Estimate
from synth.logs.holm import rejected
from synth.logs.identified_config import with_numbers
from synth.logs.retune.tuned_books import Case, plants_of
from synth.logs.unknowns import values_at
from synth.retarder.configuration.config_file import ConfigSource
from synth.simulation.closed_loop import close_loop
from synth.simulation.controllers import TableController
from synth.simulation.replicates import student_quantile
from synth.simulation.stratified_passes import stratified_passes
from tuning_tables import ControllerTable

MOST_FALSE = 0.025
"""Chance that any case is called better whose new table is not, of all cases together."""

MOST_TRIES = 50
"""Draws of numbers that no plant may have, before that is a fault of the estimate."""


@dataclass(frozen=True)
class GainOrder:
    """`sets` of numbers are drawn from the law of the estimate, `passes` simulated on each; `seed` of both."""

    sets: int = 16
    passes: int = 2000
    seed: int = 41


@dataclass(frozen=True)
class CaseGain:
    """One case: rms of exit − target under both tables on the identified plants, m/s, and new / old.

    `ratio_ci95` holds the chance of the passes and what the estimate leaves open; it is of this case alone. `p_value`:
    of as small a ratio or a smaller one where the new table is no better (Student's law, one side). `plants`: so many
    were drawn.
    """

    label: str
    target_m_s: float
    old_rms_m_s: float
    new_rms_m_s: float
    ratio: float
    ratio_ci95: tuple[float, float]
    p_value: float
    plants: int

    @property
    def case(self) -> Case:
        """Label and target."""
        return self.label, self.target_m_s


def better(gains: Sequence[CaseGain]) -> tuple[CaseGain, ...]:
    """Those whose new table is shown to be better, in their order.

    By Holm's rule over all cases: a book of a hundred cases would else have cases called better by chance alone.
    """
    proven = set(rejected([gain.p_value for gain in gains], MOST_FALSE))
    return tuple(gain for number, gain in enumerate(gains) if number in proven)


def likely_plants(source: ConfigSource, estimate: Estimate, order: GainOrder) -> tuple[dict[str, Plant], ...]:
    """Plants by label for each of `order.sets` draws of the numbers, normal around the estimate.

    All numbers are drawn, those too that the passes hardly tell. Draws that no plant may have are drawn anew;
    `InputError` or `PlantError` where there is nothing else.
    """
    rng = np.random.default_rng(order.seed)
    found: list[dict[str, Plant]] = []
    fault: InputError | PlantError = PlantError("")
    for _ in range(order.sets + MOST_TRIES):
        u = rng.multivariate_normal(estimate.u, estimate.covariance, method="eigh")
        try:
            drawn = with_numbers(source, values_at(estimate.unknowns, u), "drawn numbers", lambda _: "drawn")
            found.append(plants_of(drawn.resolved()))
        except (InputError, PlantError) as one:
            fault = one
        if len(found) == order.sets:
            return tuple(found)
    raise fault


def case_gain(
    case: Case, tables: tuple[ControllerTable, ControllerTable], plants: Sequence[Plant], order: GainOrder
) -> CaseGain:
    """Old and new table on each of `plants`, on the same passes; other passes on each plant."""
    squares = np.empty((len(plants), 2))
    for number, plant in enumerate(plants):
        passes = stratified_passes(order.seed, number * order.passes, order.passes)
        for column, table in enumerate(tables):
            loop = close_loop(plant, len(table.stages))
            sample = loop.run(TableController(table), loop.draws(passes))
            error = sample.exit_speed_m_s - case[1]
            squares[number, column] = sample.weight @ error**2 / sample.weight.sum()
    old, new = np.sqrt(squares.mean(axis=0)).tolist()
    of_log = 0.5 * np.log(squares[:, 1] / squares[:, 0])
    middle, spread = float(of_log.mean()), float(of_log.std(ddof=1)) * math.sqrt(1.0 + 1.0 / len(plants))
    half = student_quantile(len(plants) - 1) * spread
    ends = (math.exp(middle - half), math.exp(middle + half))
    chance = no_better(middle, spread, len(plants) - 1)
    return CaseGain(*case, old, new, math.exp(middle), ends, chance, len(plants))


def no_better(log_ratio: float, spread: float, freedom: int) -> float:
    """P value of a logarithm of new / old that is `log_ratio` with the standard deviation `spread`."""
    from scipy.special import stdtr  # start-up: scipy only where it is needed

    if spread == 0.0:
        return 0.0 if log_ratio < 0.0 else 1.0
    return float(stdtr(freedom, log_ratio / spread))


def predicted_gains(
    old: Mapping[Case, ControllerTable],
    new: Mapping[Case, ControllerTable],
    plants: Sequence[Mapping[str, Plant]],
    order: GainOrder,
    threads: int = 1,
) -> tuple[CaseGain, ...]:
    """For every case that has an old table and a new one, in the order of the new ones."""
    cases = [case for case in new if case in old]
    with ThreadPoolExecutor(threads) as pool:
        return tuple(
            pool.map(lambda case: case_gain(case, (old[case], new[case]), [p[case[0]] for p in plants], order), cases)
        )
