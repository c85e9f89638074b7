"""Permissions that hardware may give a regulator, what each would give, in one case and over all, and configurations
for which nobody can tell that.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from statistics import median

from plant_models import PlantError
from synth.frame.faults import InputError
from synth.problem.resolution import design_resolution
from synth.retarder.configuration.plant_fault import in_file
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.failed_case import FailedCase
from synth.simulation.exit_statistics import ExitStatistics
from synth.simulation.replicates import Interval


class Permission(Enum):
    """What a regulator may do or know more, or less, than the configuration says; the value is its name in files."""

    ANY_TIME = "commands at any time"
    WITHOUT_GAUGE = "commands at any time, no pressure gauge"
    ESTIMATOR = "estimator"
    NO_ESTIMATOR = "without the estimator"
    APPROACH = "approach of 4 m"
    NO_APPROACH = "without the approach"


@dataclass(frozen=True)
class PermissionResult:
    """The closed loop of a regulator with a permission: its figures, and its rms over that of the configured table.

    `ratio_ci95`: paired, 95 %. `predicted_rms_m_s`: exact, or from other passes for an estimator.
    """

    permission: Permission
    statistics: ExitStatistics
    ratio: float
    ratio_ci95: Interval
    predicted_rms_m_s: float


@dataclass(frozen=True)
class FailedPermission:
    """A permission that nothing could be designed for in one case, and why."""

    permission: Permission
    reason: str


@dataclass(frozen=True)
class CasePermissions:
    """One cut class and target: the table as configured, and what each permission would give on the same passes.

    `failed`: what was asked for besides, and cannot be told.
    """

    label: str
    target_speed_m_s: float
    table: ExitStatistics
    predicted_rms_m_s: float
    results: tuple[PermissionResult, ...]
    failed: tuple[FailedPermission, ...] = ()

    def of(self, permission: Permission) -> PermissionResult | None:
        """The result of a permission, None where it was not asked for."""
        return next((each for each in self.results if each.permission is permission), None)

    @property
    def told(self) -> str:
        """The case in a few words, for who waits for it: what commands at any time give, which are always asked for,
        and what cannot be told."""
        found = self.of(Permission.ANY_TIME)
        words = [] if found is None else [f"rms with commands at any time × {found.ratio:.2f}"]
        return "; ".join([*words, *(f"{each.permission.value} cannot be decided" for each in self.failed)])

    @property
    def missing(self) -> tuple[str, ...]:
        """A sentence's part for each permission that cannot be told."""
        where = f"{self.label} to {self.target_speed_m_s:g} m/s"
        return tuple(f"{where}, {each.permission.value}: {each.reason}" for each in self.failed)


@dataclass(frozen=True)
class AllPermissions:
    """The cases of a configuration, in its order; `failed`: those without a table to compare anything with."""

    cases: tuple[CasePermissions, ...]
    failed: tuple[FailedCase, ...]

    @property
    def complete(self) -> bool:
        """Whether all that was asked for is told."""
        return not self.failed and not any(case.failed for case in self.cases)


def asked_of(cases: Sequence[CasePermissions]) -> list[Permission]:
    """The permissions that were asked for in some case."""
    return [each for each in Permission if any(case.of(each) for case in cases)]


def median_ratios(cases: Sequence[CasePermissions]) -> dict[str, float]:
    """The median of each permission's ratio over all cases, by its name."""
    return {each.value: median(result.ratio for case in cases if (result := case.of(each))) for each in asked_of(cases)}


def medians(cases: Sequence[CasePermissions]) -> str:
    """The same as a list in words."""
    return ", ".join(f"{name} {ratio:.2f}" for name, ratio in median_ratios(cases).items())


def require_tellable(config: ResolvedConfig, source: str, asked: str) -> None:
    """`InputError` about `source` where nobody can tell permissions of `config`; `asked`: what asks for them."""
    if config.criterion.requirement is not None:
        raise InputError(
            f"{source}: criterion has p_overspeed or worst_friction_*, for which {asked} has no design: commands at "
            "any time are designed for the mean square error alone; leave these keys out"
        )
    if config.regulator.at_any_time:
        raise InputError(
            f'{source}: regulator.commands is "any_time", but {asked} tells what to ask the hardware for beyond '
            'commands at rest: set it to "at_rest"'
        )
    with in_file(source):
        for _, problem in config.problems():
            try:
                problem.plant.drive_at_any_time()
                design_resolution(problem.plant, problem.target_speed_m_s)
            except PlantError as error:  # nobody has asked for such commands by name
                raise PlantError(f"{error}; {asked} designs commands at any time") from None


def tellable(config: ResolvedConfig) -> bool:
    """Whether permissions of `config` can be told."""
    try:
        require_tellable(config, "", "")
    except InputError:
        return False
    return True
