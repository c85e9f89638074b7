"""The tables of a case, as tunes write them: at rest and at any time, with and without estimator."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from scripts.studies.cases import Case
from scripts.studies.tuned_table import CREATED, rounded
from synth.problem.aim import Aim
from synth.retarder.class_setup import Origin, class_setup
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.tuned_table import TunedTable, read_back, solutions, tuned_table
from synth.simulation.random_passes import RandomPasses
from synth.solver.any_time.polynomial_surfaces import PolynomialSurfaces
from synth.solver.polynomial_lines import PolynomialLines
from tuning_tables import ControllerTable, Decisions, Estimator, Generator


@dataclass(frozen=True)
class TablePair:
    """Without estimator and with it."""

    without: ControllerTable
    with_estimator: ControllerTable


def tables_of(
    config: ResolvedConfig, case: Case, passes: RandomPasses, at_any_time: bool, price_m2_s2: float
) -> Mapping[Decisions, TablePair]:
    """The tables of `case` for each permission; at any time where asked.

    `price_m2_s2`: of a command, in the criterion.
    """
    origin = Origin(Generator("retarder-synth study", "0", config.sha256), CREATED)
    criterion = replace(config.criterion, switching_tolerance_m2_s2=price_m2_s2)

    def tuned(estimator: bool) -> Mapping[Decisions, ControllerTable]:
        changes = {"estimator": estimator, "commands": "any_time" if at_any_time else "at_rest"}
        asked = replace(config, regulator=config.regulator.model_copy(update=changes))
        setup = class_setup(asked, case.label, case.plant, passes, origin)
        (solution,) = solutions(setup.design, [Aim(case.target_m_s, criterion)])
        return tables_from(config, case, tuned_table(setup, solution))

    without, with_estimator = tuned(False), tuned(True)
    return {decisions: TablePair(without[decisions], with_estimator[decisions]) for decisions in without}


def tables_from(config: ResolvedConfig, case: Case, tuned: TunedTable) -> dict[Decisions, ControllerTable]:
    """Every table that one tune has made on its way."""
    estimator = tuned.table.estimator

    def stored(lines: PolynomialLines | PolynomialSurfaces, of: Estimator | None) -> ControllerTable:
        return read_back(rounded(config, case.plant, lines, case.target_m_s, of))

    made = {Decisions.AT_REST: stored(tuned.at_rest.lines, estimator)}
    if tuned.at_any_time is not None:
        made[Decisions.AT_ANY_TIME] = stored(tuned.at_any_time.lines, estimator)
    return made
