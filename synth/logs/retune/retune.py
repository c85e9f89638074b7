"""New tables from measured passes: estimate, tune, what they gain on a plant that is known as well as the passes
tell it, and keep what is better beyond doubt.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence, Set
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np

from plant_models import Plant, PlantError
from synth.frame.faults import InputError
from synth.frame.workers.engine import Teller, Watcher
from synth.logs.estimate import Estimate, estimate
from synth.logs.fitting_passes import FittingPasses
from synth.logs.identified_config import identified, with_numbers
from synth.logs.residual_tests import rejected
from synth.logs.retune.tuned_books import Case, cases_of, class_setups, finished, plants_of, tuned_tables
from synth.logs.unknowns import unknowns_of, values_at
from synth.retarder.configuration.config_file import ConfigSource
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.failed_case import FailedCase
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


@dataclass(frozen=True)
class Retuned:
    """`config` before, `identified` after; `gains` of all cases; `old`, `new` tables by case.

    `tables`: the new book, in which cases without a proven gain keep their lines; empty where that is all of them.
    `failed`: cases that no new table could be tuned for; they keep the old one, if there is one.
    """

    config: ResolvedConfig
    identified: ResolvedConfig
    estimate: Estimate
    created: str
    gains: tuple[CaseGain, ...]
    old: Mapping[Case, ControllerTable]
    new: Mapping[Case, ControllerTable]
    tables: tuple[ControllerTable, ...]
    failed: tuple[FailedCase, ...] = ()

    @property
    def changed(self) -> tuple[CaseGain, ...]:
        """The cases whose new table is better beyond doubt, all cases considered."""
        return better(self.gains)


STANDARD = GainOrder()


@dataclass(frozen=True)
class RetuneOrder:
    """What runs in the yard: `old` tables by case, None: those that a tune of the configuration makes."""

    old: Mapping[Case, ControllerTable] | None
    created: str
    gain: GainOrder = STANDARD
    threads: int = 1


def retune(passes: FittingPasses, source: ConfigSource, order: RetuneOrder, watcher: Watcher) -> Retuned:
    """Tables for the configuration that `identify` would write: `source` with what `passes` say.

    Raises `InputError` or `PlantError` for numbers that no plant has, and where no case has a new table.
    """
    config = source.resolved()
    found = estimate(passes, unknowns_of(passes, config.parameters), order.threads)
    watcher.note(f"{len(found.unknowns)} numbers identified from {found.passes} passes")
    told = identified(source, found, f"{found.passes} passes").resolved()
    old = order.old
    if old is None:
        before = tuned_tables(config, class_setups(config, order.created), order.threads, Teller(lambda _: None))
        old = before.tables
        watcher.note(f"{len(old)} tables of the configuration tuned")
        for case in before.failed:
            watcher.note(f"with the configuration as it is, {case.sentence}")
    setups = class_setups(told, order.created)
    tuned = tuned_tables(told, setups, order.threads, watcher)
    new = tuned.tables or tuned.whole
    plants = likely_plants(source, found, order.gain)
    gains = predicted_gains(old, new, plants, order.gain, order.threads)
    watcher.note(f"{len(gains)} cases compared on {len(plants)} likely plants")
    proven = {gain.case for gain in better(gains)}
    tables = () if not proven else finished(setups, *book_of(cases_of(told), old, new, proven))
    return Retuned(config, told, found, order.created, gains, old, new, tables, tuned.failed)


def book_of(
    cases: Iterable[Case],
    old: Mapping[Case, ControllerTable],
    new: Mapping[Case, ControllerTable],
    proven: Set[Case],
) -> tuple[dict[Case, ControllerTable], frozenset[Case]]:
    """The tables of the new book in the order of `cases`, and the cases that keep their old lines.

    These are all that have an old table and are not `proven`, because they are within noise or have no new one.
    """
    cases = [case for case in cases if case in old or case in new]
    kept = frozenset(case for case in cases if case in old and case not in proven)
    return {case: old[case] if case in kept else new[case] for case in cases}, kept
