"""The tables of a case as a tune makes them, for the measured speed and for the estimated one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from plant_models import Plant
from scripts.studies.cases import OTHER_PLANTS, Case, named_cases
from scripts.studies.tuned_table import CREATED
from synth.problem.aim import Aim
from synth.retarder.class_setup import class_setup, origin_of, validation_passes
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.tuned_table import solutions, tuned_table
from synth.simulation.closed_loop import TableController


@dataclass(frozen=True)
class TunedCase:
    """A case, its table without estimator and the one with it."""

    case: Case
    before: TableController
    after: TableController


def tuned_case(config: ResolvedConfig, case: Case) -> TunedCase:
    """Both tables of `case`, one of `config`."""
    made = (table_of(config, case.label, case.plant, case.target_m_s, estimator) for estimator in (False, True))
    return TunedCase(case, *made)


def table_of(config: ResolvedConfig, label: str, plant: Plant, target_m_s: float, estimator: bool) -> TableController:
    """The table of the class `label`, rounded as a controller has it."""
    regulated = replace(config, regulator=config.regulator.model_copy(update={"estimator": estimator}))
    origin = origin_of(config.sha256, CREATED)
    setup = class_setup(regulated, label, plant, validation_passes(config).part(0, 1), origin)
    (solution,) = solutions(setup.design, [Aim(target_m_s, config.criterion)])
    return TableController(tuned_table(setup, solution).table)


def cases_of(config: ResolvedConfig, words: Sequence[str], long_cut: bool) -> tuple[tuple[ResolvedConfig, Case], ...]:
    """The cases of `config` that `words` name; with `long_cut` the three gondolas of another configuration too."""
    found = [(config, case) for case in named_cases(config, words)]
    if long_cut:
        other = parse_config(dict(OTHER_PLANTS)["three cars"], "three cars")
        ((label, plant),) = other.plants()
        found.append((other, Case(label, plant, min(other.targets_of(label)))))
    return tuple(found)
