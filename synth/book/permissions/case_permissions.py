"""What each permission would give in every case of a configuration, computed and simulated, nothing quoted."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from plant_models import Plant
from plant_models.approach import Approach
from synth.book.class_setup import ClassSetup, Origin, class_setup, origin_of, validation_passes
from synth.book.permissions.permission import CasePermissions, Permission, PermissionResult
from synth.book.tuned_table import TunedTable, solutions, tuned_table
from synth.book.work_queue import run_nested
from synth.configuration.resolved_config import ResolvedConfig
from synth.problem.aim import Aim
from synth.simulation.any_time.laws import PolynomialController
from synth.simulation.any_time.loop import any_time_loop
from synth.simulation.closed_loop import TableController
from synth.simulation.exit_statistics import exit_statistics, rms_ratio
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.solver.any_time.polynomial_surfaces import CUBIC_ALONE, CUBIC_AND_SLOPE, surfaces_of_lines
from synth.solver.any_time.sampled_chain import check_sampled_chain, design_resolution, sampled_chain
from synth.solver.any_time.surface_evaluation import SurfaceEvaluation
from synth.solver.any_time.surface_polish import polish_surfaces
from synth.solver.one_blas_thread import one_blas_thread

APPROACH_M = 4.0
"""The approach that is tried where the configuration has none."""

Tell = Callable[[str], None]


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
def permissions_of(config: ResolvedConfig, created: str, workers: int, tell: Tell) -> tuple[CasePermissions, ...]:
    """All cases of `config`, on `workers` threads; no figure depends on how many.

    Raises `PlantError` where `drive_at_any_time` does.
    """
    origin, passes = origin_of(config.sha256, created), validation_passes(config)

    def start(label: str, plant: Plant) -> list[Callable[[], CasePermissions]]:
        aims = [Aim(target, config.criterion) for target in config.targets_of(label)]
        cases = tuned_cases(config, label, plant, aims, passes, origin)
        return [partial(case_permissions, case, passes, origin, tell) for case in cases]

    found = run_nested([partial(start, *each) for each in config.plants()], workers)
    return tuple(case for cases in found for case in cases)


def tuned_cases(
    config: ResolvedConfig, label: str, plant: Plant, aims: list[Aim], passes: RandomPasses, origin: Origin
) -> list[CaseTuned]:
    """The tables of a class, and their passes."""
    setup = class_setup(config, label, plant, passes, origin)
    found = []
    for solution in solutions(setup.design, aims):
        tuned = tuned_table(setup, solution)
        found.append(CaseTuned(config, setup, solution.aim, tuned, setup.passes.run(TableController(tuned.table))))
    return found


def case_permissions(case: CaseTuned, passes: RandomPasses, origin: Origin, tell: Tell) -> CasePermissions:
    """All permissions of one case."""
    label, plant = case.setup.label, case.setup.plant
    results = [
        at_any_time(case, Permission.ANY_TIME, CUBIC_AND_SLOPE),
        at_any_time(case, Permission.WITHOUT_GAUGE, CUBIC_ALONE),
    ]
    if not case.config.regulator.estimator and case.config.criterion.requirement is None:
        estimating = replace(case.config, regulator=case.config.regulator.model_copy(update={"estimator": True}))
        results.append(at_rest(case, Permission.ESTIMATOR, estimating, plant, passes, origin))
    ahead = case.setup.plant.approach.length_m > 0.0
    kind = Permission.NO_APPROACH if ahead else Permission.APPROACH
    approach = Approach() if ahead else Approach(APPROACH_M, plant.approach.entrance_stage)
    results.append(at_rest(case, kind, case.config, replace(plant, approach=approach), passes, origin))
    tell(f"{label} to {case.target_m_s:g} m/s: rms with commands at any time × {results[0].ratio:.2f}")
    statistics = exit_statistics(case.sample, case.target_m_s)
    return CasePermissions(label, case.target_m_s, statistics, case.tuned.table.predicted.rms_m_s, tuple(results))


def at_any_time(case: CaseTuned, permission: Permission, degrees: tuple[int, ...]) -> PermissionResult:
    """Surfaces polished from the lines of the table, predicted and simulated."""
    plant, lines = case.setup.plant, case.tuned.lines
    steps = design_resolution(plant, case.target_m_s)
    design, check, loop = sampled_chain(plant, steps), check_sampled_chain(plant, steps), any_time_loop(plant)
    stages = np.asarray(plant.position.stage_pressures_kpa[: design.modes.stages])
    start = surfaces_of_lines(lines, stages, degrees)
    surfaces = polish_surfaces(start, SurfaceEvaluation(design), case.aim).surfaces
    density = SurfaceEvaluation(check).density(surfaces.at(check.grid.path_m[:-1], check.modes))
    sample = loop.run(PolynomialController(surfaces), case.setup.passes.draws)
    return case.result(permission, sample, density.rms_m_s(case.target_m_s))


def at_rest(
    case: CaseTuned, permission: Permission, config: ResolvedConfig, plant: Plant, passes: RandomPasses, origin: Origin
) -> PermissionResult:
    """The table that a tune of another configuration or plant makes, on the same passes."""
    (other,) = tuned_cases(config, case.setup.label, plant, [case.aim], passes, origin)
    return case.result(permission, other.sample, other.tuned.table.predicted.rms_m_s)
