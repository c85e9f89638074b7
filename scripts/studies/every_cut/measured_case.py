"""One case as a tune does it: its table, the rules tuned for it, and all of them on the same passes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial

from scripts.studies.every_cut.cut_figures import Beside, BesideWithout, CutFigures, Outcome, Untuned
from scripts.studies.every_cut.random_case import RandomCase
from scripts.studies.plant_changes import friction
from scripts.studies.tuned_table import CREATED
from synth.problem.aim import Aim
from synth.retarder.attempted_case import attempted
from synth.retarder.class_setup import TUNING_PASSES, ClassSetup, class_setup, origin_of, validation_passes
from synth.retarder.comparison.baselines import TunedBaseline, tune_baselines
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.failed_case import FailedCase
from synth.retarder.tuned_table import ValidatedLines, read_back, solutions, tuned_table, validated_table
from synth.simulation.closed_loop import TableController
from synth.simulation.common_passes import common_passes
from synth.simulation.exit_statistics import exit_statistics, rms_ratio
from synth.simulation.random_passes import random_passes
from synth.simulation.unavoidable_error import unavoidable_error

WEAK = 0.8
"""Share of the friction on a day that brakes badly."""


def measured(case: RandomCase, config: ResolvedConfig) -> Outcome:
    """The figures of `case`, of which `config` is the configuration; the case as untuned where a tune refuses it."""
    ((label, _),) = config.plants()
    (target,) = config.targets_m_s
    found = attempted(partial(figures_of, case, config), label, target, config)
    return Untuned(case, found.reason) if isinstance(found, FailedCase) else found


def figures_of(case: RandomCase, config: ResolvedConfig) -> CutFigures:
    """The figures of `case`; raises `PlantError` and `InvalidTable` as a tune's parts do."""
    ((label, plant),) = config.plants()
    (target,) = config.targets_m_s
    setup = class_setup(config, label, plant, validation_passes(config), origin_of(config.sha256, CREATED))
    (solution,) = solutions(setup.design, [Aim(target, config.criterion)])
    tuned = tuned_table(setup, solution)
    validated = validated_table(setup, tuned.table, read_back)
    ends = setup.passes.exit_range
    unavoidable = unavoidable_error(ends.slowest, ends.fastest, target)
    tuning = setup.passes.of_others(random_passes(config.validation.seed + 1, 0, TUNING_PASSES))
    best = best_of(tune_baselines(tuning, target), setup, validated)
    figures, plain = validated.statistics, config.regulator.model_copy(update={"estimator": False})
    return CutFigures(
        case=case,
        length_m=plant.pass_m,
        rms_m_s=figures.rms_m_s,
        rms_ci95_m_s=figures.rms_ci95_m_s,
        predicted_rms_m_s=validated.table.predicted.rms_m_s,
        designed_again=tuned.design.grid.again,
        switchings=figures.switchings,
        feasible=not unavoidable.forbids(config.acceptance.rms_m_s),
        best=best,
        without=beside_without(replace(config, regulator=plain), setup, validated),
    )


def beside_without(config: ResolvedConfig, setup: ClassSetup, validated: ValidatedLines) -> BesideWithout:
    """The table beside that of `config`, without estimator, on its plant and where friction is weak."""
    ((label, plant),) = config.plants()
    target, passes = validated.table.target_speed_m_s, setup.passes.passes
    other = class_setup(config, label, plant, passes, setup.origin)
    (solution,) = solutions(other.design, [Aim(target, config.criterion)])
    table, plain = TableController(validated.table), TableController(tuned_table(other, solution).table)
    weak = common_passes(friction(WEAK, 1.0)(plant), passes)
    return BesideWithout(
        *rms_ratio(validated.sample, setup.passes.run(plain), target),
        *rms_ratio(weak.run(table), weak.run(plain), target),
    )


def best_of(rules: Sequence[TunedBaseline], setup: ClassSetup, table: ValidatedLines) -> Beside:
    """The rule of least rms on the passes of `setup`, beside the table on the same passes."""
    return min((beside(rule, setup, table) for rule in rules), key=lambda each: each.rms_m_s)


def beside(rule: TunedBaseline, setup: ClassSetup, validated: ValidatedLines) -> Beside:
    """One rule beside the table."""
    target = validated.table.target_speed_m_s
    sample = setup.passes.run(rule.controller)
    found = exit_statistics(sample, target)
    ratio, ratio_ci95 = rms_ratio(validated.sample, sample, target)
    return Beside(rule.name, found.rms_m_s, found.switchings, ratio, ratio_ci95)
