"""One permission that hardware may give a regulator, and what it would give in one case."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from synth.simulation.exit_statistics import ExitStatistics
from synth.simulation.replicates import Interval


class Permission(Enum):
    """What a regulator may do or know more, or less, than the configuration says; the value is its name in files."""

    JUMPS = "several stages a command"
    ANY_TIME = "commands at any time"
    WITHOUT_GAUGE = "commands at any time, no pressure gauge"
    ESTIMATOR = "estimator"
    ANY_TIME_ESTIMATOR = "commands at any time, estimator"
    APPROACH = "approach of 4 m"
    NO_APPROACH = "without the approach"


@dataclass(frozen=True)
class PermissionResult:
    """The closed loop of a regulator with a permission: its figures, and its rms over that of the configured table.

    `ratio_ci95`: paired, 95 %. `predicted_rms_m_s`: exact, or from other passes for an estimator and for jumps.
    """

    permission: Permission
    statistics: ExitStatistics
    ratio: float
    ratio_ci95: Interval
    predicted_rms_m_s: float


@dataclass(frozen=True)
class CasePermissions:
    """One cut class and target: the table as configured, and what each permission would give on the same passes."""

    label: str
    target_speed_m_s: float
    table: ExitStatistics
    predicted_rms_m_s: float
    results: tuple[PermissionResult, ...]

    def of(self, permission: Permission) -> PermissionResult | None:
        """The result of a permission, None where it was not asked for."""
        return next((each for each in self.results if each.permission is permission), None)

    @property
    def told(self) -> str:
        """The case in a few words, for who waits for it: what commands at any time give, which are always asked for."""
        found = self.of(Permission.ANY_TIME)
        return "" if found is None else f"rms with commands at any time × {found.ratio:.2f}"
