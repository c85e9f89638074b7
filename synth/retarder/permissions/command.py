"""The command `hardware`: what to ask of the hardware, told by what each permission would give in every case."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from synth.frame.command import Asked, Command, Limit, Steps, Work
from synth.frame.exhibits import Chapter
from synth.retarder.asked_tune import RadarEpochs
from synth.retarder.configuration.config_file import parse_config
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.configured import head_of, require_room, sensors_left_aside
from synth.retarder.exit_figures import CHANCE_ONLY
from synth.retarder.options import PermissionsOptions

if TYPE_CHECKING:
    from synth.retarder.permissions.permission import AllPermissions

LIMITS_OF_USE = (
    "Figures are those of a model with the parameters of this page. Assumed ones are guesses.",
    CHANCE_ONLY,
    "A permission is judged by the table that is designed for it. What the hardware costs is not told.",
)


SOLVED_TOGETHER = 3
"""A class as configured, with the other estimator and with the other approach stay in memory until all targets of it
are compared."""


@dataclass(frozen=True)
class AskedPermissions:
    """A configuration, what messages call its file, and how many cases are compared at a time."""

    config: ResolvedConfig
    place: str
    workers: int


@dataclass(frozen=True)
class FoundPermissions:
    """What permissions give in a configuration of this title."""

    title: str
    told: AllPermissions


def resolve(asked: Asked[ResolvedConfig, PermissionsOptions]) -> AskedPermissions:
    """Refuse what cannot be told, and what does not fit into memory."""
    from synth.retarder.permissions.permission import require_tellable

    require_tellable(asked.settings, asked.place, "'hardware'")
    require_room(asked.settings, RadarEpochs(), asked.place, SOLVED_TOGETHER * asked.options.workers)
    return AskedPermissions(asked.settings, asked.place, asked.options.workers)


def compute(asked: AskedPermissions, work: Work) -> FoundPermissions:
    """All permissions of all cases; `InputError` where no case has a table."""
    from synth.frame.version import creation_time
    from synth.kernels.cache import guarded
    from synth.retarder.failed_case import require_a_table, tables_refused
    from synth.retarder.permissions.case_permissions import permissions_of

    with tables_refused(asked.place, asked.config):
        told = guarded(permissions_of, asked.config, creation_time(), asked.workers, work.progress)
        require_a_table(told.cases, told.failed)
    return FoundPermissions(asked.config.title, told)


def limits(found: FoundPermissions) -> Iterator[Limit]:
    """Whether all that was asked for is told."""
    parts = [part for case in found.told.cases for part in case.missing]
    parts += [case.sentence for case in found.told.failed]
    yield Limit(f"not decided: {'; '.join(parts)}" if parts else "every permission is decided in every case", not parts)


def show(found: FoundPermissions) -> Iterator[Chapter]:
    """What is shown of it."""
    from synth.retarder.permissions.shown import permissions

    yield Chapter("Permissions of the hardware", tuple(permissions(found.title, found.told)))


COMMAND = Command(
    name="hardware",
    read=parse_config,
    options=PermissionsOptions,
    resolve=resolve,
    head=lambda asked: head_of(asked.config, sensors_left_aside(asked.config)),
    steps=lambda asked: Steps(len(asked.config.problems()), "comparing", "cases"),
    compute=compute,
    show=show,
    limits=limits,
    limits_of_use=LIMITS_OF_USE,
)
