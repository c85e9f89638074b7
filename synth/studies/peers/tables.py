"""The tables of a case, as a tune writes them: at rest and at any time, with and without estimator."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

from synth.book.class_setup import Origin, class_setup
from synth.book.tuned_table import TunedTable, read_back, solutions, tuned_table
from synth.configuration.resolved_config import ResolvedConfig
from synth.problem.aim import Aim
from synth.simulation.random_passes import RandomPasses
from synth.solver.any_time.polynomial_surfaces import PolynomialSurfaces
from synth.solver.polynomial_lines import PolynomialLines
from synth.studies.cases import Case
from synth.studies.tuned_table import CREATED, rounded
from tuning_tables import ControllerTable, Decisions, Estimator, Generator


@dataclass(frozen=True)
class TablePair:
    """`without` and `with_estimator`, which is None where a tune leaves the estimator out because it does not gain."""

    without: ControllerTable
    with_estimator: ControllerTable | None

    @property
    def best(self) -> ControllerTable:
        """What a tune writes where it is asked for an estimator."""
        return self.with_estimator or self.without


def tables_of(
    config: ResolvedConfig, case: Case, passes: RandomPasses, at_any_time: bool, price_m2_s2: float
) -> Mapping[Decisions, TablePair]:
    """The tables of `case` for each permission; at any time where asked.

    `price_m2_s2`: of a command, in the criterion.
    """
    commands = "any_time" if at_any_time else "at_rest"
    asked = replace(config, regulator=config.regulator.model_copy(update={"estimator": True, "commands": commands}))
    origin = Origin(Generator("retarder-synth study", "0", config.sha256), CREATED)
    setup = class_setup(asked, case.label, case.plant, passes, origin)
    criterion = replace(config.criterion, switching_tolerance_m2_s2=price_m2_s2)
    (solution,) = solutions(setup.design, [Aim(case.target_m_s, criterion)])
    return pairs_of(config, case, tuned_table(setup, solution))


def pairs_of(config: ResolvedConfig, case: Case, tuned: TunedTable) -> dict[Decisions, TablePair]:
    """Every table that one tune has made on its way."""

    def stored(lines: PolynomialLines | PolynomialSurfaces, estimator: Estimator | None = None) -> ControllerTable:
        return read_back(rounded(config, case.plant, lines, case.target_m_s, estimator))

    made = tuned.estimate
    gains = made is not None and made.gains
    rest = TablePair(stored(tuned.design.kept.lines), stored(made.lines, made.estimator) if made and gains else None)
    if tuned.surfaces is None:
        return {Decisions.AT_REST: rest}
    free = tuned.surfaces.estimate
    kept = stored(free.lines, free.estimator) if free is not None and free.gains else None
    return {Decisions.AT_REST: rest, Decisions.AT_ANY_TIME: TablePair(stored(tuned.surfaces.polish.surfaces), kept)}
