"""What each permission would give in every case of a configuration, computed and simulated, nothing quoted."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import partial

from plant_models import Plant
from plant_models.track_profile import Approach
from synth.frame.workers.engine import Watcher
from synth.problem.problem import Aim
from synth.retarder.class_setup import ClassSetup, Origin, class_setup, origin_of, validation_passes
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.configuration.settings import RegulatorSettings
from synth.retarder.failed_case import FailedCase, attempted
from synth.retarder.permissions.permission import (
    AllPermissions,
    CasePermissions,
    FailedPermission,
    Permission,
    PermissionResult,
)
from synth.retarder.tune import every_case
from synth.retarder.tuned_table import TunedTable, at_any_time, solutions, tuned_table
from synth.simulation.closed_loop import TableController
from synth.simulation.exit_statistics import exit_statistics, rms_ratio
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.solver.backward_induction import Solution
from synth.solver.descent import one_blas_thread

APPROACH_M = 4.0
"""The approach that is tried where the configuration has none."""

Design = Callable[[], PermissionResult | FailedCase]
"""Designs, predicts and simulates one permission; raises what `attempted` takes for a failure, or returns one."""


@dataclass(frozen=True)
class SolvedClass:
    """A cut class with all its targets solved at once: what their tables are made from."""

    config: ResolvedConfig
    setup: ClassSetup
    solutions: tuple[Solution, ...]


@dataclass(frozen=True)
class OtherClass:
    """A cut class solved anew for a permission that changes its configuration or plant, or why it cannot be."""

    permission: Permission
    solved: SolvedClass | FailedCase


@dataclass(frozen=True)
class CaseTuned:
    """A case with its table as configured: what permissions are compared with."""

    config: ResolvedConfig
    setup: ClassSetup
    aim: Aim
    tuned: TunedTable
    sample: ExitSample

    @property
    def target_m_s(self) -> float:
        """The commanded exit speed."""
        return self.aim.target_speed_m_s

    def result(self, permission: Permission, sample: ExitSample, predicted_m_s: float) -> PermissionResult:
        """What a closed loop on the common passes says of a permission."""
        ratio, ci95 = rms_ratio(sample, self.sample, self.target_m_s)
        return PermissionResult(permission, exit_statistics(sample, self.target_m_s), ratio, ci95, predicted_m_s)


@one_blas_thread()
def permissions_of(config: ResolvedConfig, created: str, workers: int, watcher: Watcher) -> AllPermissions:
    """All cases of `config`, on `workers` threads; no figure depends on how many.

    A case without a table, or a permission without a design, is told of, and loses no other.
    """
    origin, passes = origin_of(config.sha256, created), validation_passes(config)

    def prepared(label: str, plant: Plant) -> list[Callable[[], CasePermissions]]:
        solved = solved_class(config, label, plant, passes, origin)
        others = tuple(other_classes(solved))
        return [partial(permissions_of_case, solved, others, each) for each in range(len(solved.solutions))]

    def done(case: CasePermissions) -> None:
        watcher.done(f"{case.label} to {case.target_speed_m_s:g} m/s: {case.told}")

    return AllPermissions(*every_case(config, prepared, done, watcher, workers))


def solved_class(config: ResolvedConfig, label: str, plant: Plant, passes: RandomPasses, origin: Origin) -> SolvedClass:
    """All targets of a class solved at once."""
    setup = class_setup(config, label, plant, passes, origin)
    return SolvedClass(config, setup, solutions(setup.design, config.aims_of(label)))


def other_classes(solved: SolvedClass) -> Iterator[OtherClass]:
    """The class with the estimator taken or given, and with the approach taken or given."""
    config, setup = solved.config, solved.setup
    plant, regulator = setup.plant, config.regulator
    ahead = plant.approach.length_m > 0.0
    approach = Approach() if ahead else Approach(APPROACH_M, plant.approach.entrance_stage)
    other = replace(config, regulator=regulator.model_copy(update={"estimator": not regulator.estimator}))
    for permission, changed, changed_plant in (
        (Permission.NO_ESTIMATOR if regulator.estimator else Permission.ESTIMATOR, other, plant),
        (Permission.NO_APPROACH if ahead else Permission.APPROACH, config, replace(plant, approach=approach)),
    ):
        solve = partial(solved_class, changed, setup.label, changed_plant, setup.passes.passes, setup.origin)
        yield OtherClass(permission, attempted(solve, setup.label, 0.0, changed))


def case_tuned(solved: SolvedClass, index: int) -> CaseTuned:
    """The table of one target of a class, and its passes."""
    setup, solution = solved.setup, solved.solutions[index]
    tuned = tuned_table(setup, solution)
    return CaseTuned(solved.config, setup, solution.aim, tuned, setup.passes.run(TableController(tuned.table)))


def permissions_of_case(solved: SolvedClass, others: tuple[OtherClass, ...], index: int) -> CasePermissions:
    """All permissions of one target of a class; with its reason each that nothing can be designed for."""
    case = case_tuned(solved, index)
    results, failed = [], []
    for permission, design in designs(case, others, index):
        found = attempted(design, case.setup.label, case.target_m_s, case.config)
        if isinstance(found, FailedCase):
            failed.append(FailedPermission(permission, found.reason))
        else:
            results.append(found)
    in_order = {each.permission: each for each in results}
    return CasePermissions(
        case.setup.label,
        case.target_m_s,
        exit_statistics(case.sample, case.target_m_s),
        case.tuned.table.predicted.rms_m_s,
        tuple(in_order[each] for each in Permission if each in in_order),
        tuple(failed),
    )


def designs(case: CaseTuned, others: Iterable[OtherClass], index: int) -> Iterator[tuple[Permission, Design]]:
    """Every permission that can be asked for, with its design; `index`: of the target among those of the class."""
    for other in others:
        yield other.permission, partial(tuned_anew, case, other, index)
    for kind, pressure in ((Permission.ANY_TIME, "gauge"), (Permission.WITHOUT_GAUGE, "none")):
        sampled = case.config.regulator.model_copy(update={"commands": "any_time", "pressure": pressure})
        yield kind, partial(with_surfaces, case, kind, sampled)


def tuned_anew(case: CaseTuned, other: OtherClass, index: int) -> PermissionResult | FailedCase:
    """The same case tuned with another configuration or plant, on the same passes."""
    if isinstance(other.solved, FailedCase):
        return other.solved
    anew = case_tuned(other.solved, index)
    return case.result(other.permission, anew.sample, anew.tuned.table.predicted.rms_m_s)


def with_surfaces(case: CaseTuned, permission: Permission, regulator: RegulatorSettings) -> PermissionResult:
    """The table for commands at any time, polished from the lines of the table."""
    table = at_any_time(replace(case.setup, regulator=regulator), case.aim, case.tuned).table
    return case.result(permission, case.setup.passes.run(TableController(table)), table.predicted.rms_m_s)
