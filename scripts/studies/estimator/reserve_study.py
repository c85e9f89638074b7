"""How much reserve lines for the estimated speed should keep, and what it costs.

For every case the tables that `tune` would write with several uncertainties of the mean friction, 0 first, and the
table without estimator; all of them on the same fresh passes, on the plant that they were made for and on plants that
brake otherwise. Where `tune` would leave the estimator out, the table without it stands for the one with it.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from scripts.studies.cases import Case, class_cases
from scripts.studies.estimator.pair import FRESH, Both, as_tuned, compared
from scripts.studies.estimator.reserve_findings import CaseRows, Excess, Reserves, Row
from scripts.studies.estimator.wrong import braking_otherwise
from scripts.studies.options import option
from scripts.studies.side_by_side import side_by_side
from scripts.studies.study import Method, Tell
from synth.problem.aim import OVERSPEED_M_S, Aim
from synth.problem.problem import Problem
from synth.retarder.configuration.config_file import load_config, parse_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.simulation.closed_loop import simulate
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.simulation.replicates import REPLICATE_PASSES
from synth.simulation.stratified_passes import stratified_passes

OTHERS = (
    ("park", '[position]\nname = "rnz-2m-park"\n[[cut]]\ncar = "gondola-4"\nmass_t = 36\n'),
    ("three cars", '[targets]\nexit_speeds_m_s = [4.0]\n[[cut]]\ncar = "gondola-4"\ncars = 3\nmass_t = 156\n'),
    ("8 axles", '[[cut]]\ncar = "tank-8"\nmass_t = 120\n'),
)
"""Cases besides those of the configuration: name, configuration."""


@dataclass(frozen=True)
class Options:
    """What is studied."""

    config: Path | None = option(None, "configuration; the built-in default book without it")
    masses_t: tuple[float, ...] = option((), "only cuts of these masses, t")
    targets_m_s: tuple[float, ...] = option((), "exit speeds, m/s; those of the configuration without it", (0.1, 20.0))
    mean_cvs: tuple[float, ...] = option(
        (0.0, 0.06, 0.08, 0.1, 0.15), "friction.mean_cv, compared to the first", (0, 0.3)
    )
    others: int = option(len(OTHERS), "how many of the other plants", (0, len(OTHERS)))
    passes: int = option(20_000, "fresh passes of each case", (200, 10**7))


def run(options: Options, tell: Tell) -> Reserves:
    """Tune all tables, simulate all on every plant."""
    config = load_config(options.config)
    seed = config.validation.seed + FRESH
    passes = stratified_passes(seed, 0, options.passes)

    def rows_of(order: tuple[str, ResolvedConfig, Case]) -> CaseRows:
        name, own, case = order
        rows = tuple(reserve_rows(own, case, passes, options.mean_cvs))
        told = ", ".join(f"{row.worst_ratio:.3f} ({row.worst_plant})" for row in rows)
        tell(f"{name}: worst ratio {told}")
        return CaseRows(name, rows)

    orders = [(case.name, config, case) for case in class_cases(config, options.masses_t, options.targets_m_s)]
    for name, text in OTHERS[: options.others]:
        other = parse_config(text, name)
        orders += [(f"{name}, {case.name}", other, case) for case in class_cases(other, (), ())]
    assumed = config.retarder.friction.mean_cv
    return Reserves(config.sha256, seed, options.passes, assumed, side_by_side(rows_of, orders))


def reserve_rows(config: ResolvedConfig, case: Case, passes: RandomPasses, mean_cvs: Sequence[float]) -> Iterator[Row]:
    """One case with each uncertainty of the mean."""
    plants = {wrong.name: wrong.plant for wrong in braking_otherwise(case.plant)}
    without: dict[str, ExitSample] = {}
    nominal = next(iter(plants))
    first = 0.0
    for mean_cv in mean_cvs:
        friction = replace(case.plant.friction, mean_cv=mean_cv)
        problem = Problem(replace(case.plant, friction=friction), Aim(case.target_m_s, config.criterion))
        pair = as_tuned(problem, config, case.label)
        without = without or {name: simulate(plant, pair.plain, passes) for name, plant in plants.items()}
        with_it = {name: simulate(plant, pair.estimated, passes) for name, plant in plants.items()}
        found = {name: compared(case.target_m_s, without[name], with_it[name]) for name in plants}
        rms = found[nominal].rms_m_s[1]
        first = first or rms
        worst = max(found, key=lambda name: found[name].ratio)
        excess = {name: excess_outside((without[name], with_it[name]), case.target_m_s) for name in plants}
        most = max(excess, key=lambda name: excess[name][0])
        yield Row(
            mean_cv=mean_cv,
            rms_m_s=rms,
            price=rms / first,
            ratio=found[nominal].ratio,
            worst_plant=worst,
            worst_ratio=found[worst].ratio,
            worst_ci95=found[worst].ratio_ci95,
            outside=found[nominal].outside,
            most=Excess(most, found[most].outside, *excess[most]),
        )


def excess_outside(samples: tuple[ExitSample, ExitSample], target_m_s: float) -> Both:
    """By how much more of all cuts the second leaves outside, and the half width of its 95 % interval; paired."""
    weight = samples[0].weight
    far = [np.abs(sample.exit_speed_m_s - target_m_s) > OVERSPEED_M_S for sample in samples]
    more = weight * (far[1].astype(np.float64) - far[0])
    by_replicate = more[: len(more) // REPLICATE_PASSES * REPLICATE_PASSES].reshape(-1, REPLICATE_PASSES).mean(axis=1)
    spread = float(by_replicate.std(ddof=1)) / np.sqrt(len(by_replicate))
    return float(more.sum() / weight.sum()), float(1.96 * spread)


METHOD = Method(Options, Options(None, (52.0,), (3.0,), (0.0, 0.15), 0, 400), Reserves, run)
