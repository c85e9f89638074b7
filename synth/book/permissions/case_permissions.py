"""What each permission would give in every case of a configuration, computed and simulated, nothing quoted."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

from plant_models import Plant
from plant_models.approach import Approach
from synth.book.any_time.surface_table import polished_surfaces, starting_surfaces
from synth.book.class_setup import ClassSetup, Origin, class_setup, origin_of, validation_passes
from synth.book.estimation.simulated_prediction import prediction_passes, simulated_prediction
from synth.book.permissions.permission import CasePermissions, Permission, PermissionResult
from synth.book.tuned_table import TunedTable, predicted_by_passes, rounded, solutions, tuned_table, with_prediction
from synth.book.work_queue import run_nested
from synth.configuration.resolved_config import ResolvedConfig
from synth.problem.aim import Aim
from synth.problem.any_time_resolution import design_resolution
from synth.simulation.closed_loop import TableController
from synth.simulation.exit_statistics import exit_statistics, rms_ratio
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.solver.any_time.surface_polish import SurfacePolish
from synth.solver.one_blas_thread import one_blas_thread

APPROACH_M = 4.0
"""The approach that is tried where the configuration has none."""

Tell = Callable[[str], None]

Ask = Callable[[TunedTable, ExitSample], CasePermissions]
"""What permissions give beside the table of a case, and its passes."""


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

    Raises `PlantError` where `Plant.drive_at_any_time` does.
    """
    origin, passes = origin_of(config.sha256, created), validation_passes(config)

    def start(label: str, plant: Plant) -> list[Callable[[], CasePermissions]]:
        aims = [Aim(target, config.criterion) for target in config.targets_of(label)]
        cases = tuned_cases(config, label, plant, aims, passes, origin)
        return [partial(told_permissions, case, passes, origin, tell) for case in cases]

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


def told_permissions(case: CaseTuned, passes: RandomPasses, origin: Origin, tell: Tell) -> CasePermissions:
    """All permissions of one case, told of."""
    found = case_permissions(case, passes, origin)
    tell(f"{found.label} to {found.target_speed_m_s:g} m/s: {found.told}")
    return found


def asking(config: ResolvedConfig, setup: ClassSetup, aim: Aim, passes: RandomPasses, origin: Origin) -> Ask:
    """The function that a tune asks once it has the table of a case: nothing is tuned twice."""

    def ask(tuned: TunedTable, sample: ExitSample) -> CasePermissions:
        return case_permissions(CaseTuned(config, setup, aim, tuned, sample), passes, origin)

    return ask


def case_permissions(case: CaseTuned, passes: RandomPasses, origin: Origin) -> CasePermissions:
    """All permissions of one case."""
    plant, polish = case.setup.plant, None
    results = [several_stages(case)]
    if not case.config.regulator.estimator and case.config.criterion.requirement is None:
        with_estimator, polish = estimators(case, passes, origin)
        results += with_estimator
    results += [
        at_any_time(case, Permission.ANY_TIME, polish or polished(case, has_gauge=True)),
        at_any_time(case, Permission.WITHOUT_GAUGE, polished(case, has_gauge=False)),
    ]
    ahead = plant.approach.length_m > 0.0
    kind = Permission.NO_APPROACH if ahead else Permission.APPROACH
    approach = Approach() if ahead else Approach(APPROACH_M, plant.approach.entrance_stage)
    (other,) = tuned_cases(case.config, case.setup.label, replace(plant, approach=approach), [case.aim], passes, origin)
    results.append(case.result(kind, other.sample, other.tuned.table.predicted.rms_m_s))
    in_order = {each.permission: each for each in results}
    return CasePermissions(
        case.setup.label,
        case.target_m_s,
        exit_statistics(case.sample, case.target_m_s),
        case.tuned.table.predicted.rms_m_s,
        tuple(in_order[each] for each in Permission if each in in_order),
    )


def estimators(
    case: CaseTuned, passes: RandomPasses, origin: Origin
) -> tuple[list[PermissionResult], SurfacePolish | None]:
    """Estimator alone, and with commands at any time: one tune designs both, and surfaces for the measured speed."""
    regulator = case.config.regulator.model_copy(update={"estimator": True, "commands": "any_time"})
    config = replace(case.config, regulator=regulator)
    (both,) = tuned_cases(config, case.setup.label, case.setup.plant, [case.aim], passes, origin)
    made, setup = both.tuned.estimate, both.setup
    alone, sample = case.tuned.table, case.sample
    if made is not None and made.gains and setup.estimator is not None:
        alone, _ = predicted_by_passes(setup, made, setup.estimator, case.target_m_s)
        sample = setup.passes.run(TableController(alone))
    found = [
        case.result(Permission.ESTIMATOR, sample, alone.predicted.rms_m_s),
        case.result(Permission.ANY_TIME_ESTIMATOR, both.sample, both.tuned.table.predicted.rms_m_s),
    ]
    return found, None if both.tuned.surfaces is None else both.tuned.surfaces.polish


def polished(case: CaseTuned, has_gauge: bool) -> SurfacePolish:
    """Surfaces polished from the lines of the table."""
    plant = case.setup.plant
    start = starting_surfaces(plant, case.tuned.lines, has_gauge)
    return polished_surfaces(plant, case.aim, start, design_resolution(plant, case.target_m_s))


def at_any_time(case: CaseTuned, permission: Permission, polish: SurfacePolish) -> PermissionResult:
    """The table of polished surfaces for the measured speed, predicted and simulated."""
    table, _ = with_prediction(case.setup.check, rounded(case.setup, polish.surfaces, case.target_m_s))
    return case.result(permission, case.setup.passes.run(TableController(table)), table.predicted.rms_m_s)


def several_stages(case: CaseTuned) -> PermissionResult:
    """The table as it is, asked again at the stage that its answer leads to."""
    setup, controller = case.setup, TableController(case.tuned.table, multi_step=True)
    others = setup.passes.of_others(prediction_passes(case.config.validation.seed + 2, setup.label))
    predicted = simulated_prediction(others.run(controller), case.target_m_s)
    return case.result(Permission.JUMPS, setup.passes.run(controller), predicted.rms_m_s)
