"""Sound passes of log files, and which cut class of a configuration each belongs to: what every command on measured
passes asks.

A released drive is open to the air, or rests at the edge of its dead band as in every other stage. The drive of
`plant_models` has one regulator for all stages: coming from above, stage 0 rests at the upper edge of the dead band.
Many drives leave the exhaust valve open when they are released; then the pressure goes on to that of the air. No number
of the model makes one of the other, so it is told from the readings of the gauge.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

import numpy as np

from plant_models import Cut, Plant
from plant_models.frozen_arrays import Ints, frozen_arrays
from plant_models.pneumatics import Pneumatics
from synth.frame.command import Head
from synth.frame.faults import InputError
from synth.logs.log_options import LogOptions
from synth.retarder.configuration.resolved_config import ResolvedConfig
from synth.retarder.configured import head_of
from tuning_tables.errors import InvalidLog
from tuning_tables.pass_log.log_files import read_logs
from tuning_tables.pass_log.log_mapping import read_mapping
from tuning_tables.pass_log.pass_log import PassLog

REST_S: Final = 2.0
"""So long after a command the pressure is near where it stays: four usual time constants, and the delays."""

FEWEST_VISITS: Final = 10
"""Of a kind; of fewer the middle says nothing."""

OPEN_BAND_KPA: Final = 1e-3
"""Dead band of a drive that is open to the air: less than any gauge shows."""


def released_drive_vents(log: PassLog, stage_pressures_kpa: tuple[float, ...], pneumatics: Pneumatics) -> bool:
    """Whether stage 0 rests nearer to the pressure of the air than to the edge of the dead band.

    The dead band is that of the log: how far from their pressure the other stages rest. False where there is no gauge,
    or where too few visits to stage 0, or to the other stages, last long enough.
    """
    rows = last_rows_of_visits(log)
    stage, read = log.stage[rows], log.pressure_kpa[rows]
    released, braking = read[stage == 0], stage > 0
    if len(released) < FEWEST_VISITS or np.count_nonzero(braking) < FEWEST_VISITS:
        return False
    off = np.abs(read[braking] - np.asarray(stage_pressures_kpa)[stage[braking]])
    air, band = max(stage_pressures_kpa[0], pneumatics.exhaust_pressure_kpa), float(np.median(off))
    return bool(abs(np.median(released) - air) < 0.5 * band)


def last_rows_of_visits(log: PassLog) -> Ints:
    """The last row with a reading of each visit to a stage, of those that lasted `REST_S` by then."""
    begins = np.diff(log.stage, prepend=-1) != 0
    begins[log.first_row[:-1]] = True
    first = np.flatnonzero(begins)
    visit = np.cumsum(begins) - 1
    read = np.isfinite(log.pressure_kpa)
    last = np.full(len(first), -1)
    np.maximum.at(last, visit[read], np.flatnonzero(read))
    known = last >= 0
    long = log.time_s[last[known]] - log.time_s[first[known]] >= REST_S
    return np.asarray(last[known][long], dtype=np.int64)


@frozen_arrays
class FittingPasses:
    """A log whose passes all belong to classes of one position.

    `plants`: (label, plant) of the classes; `class_of` (m,): number of the class of each pass. `released_vents`: a
    released drive is open to the air (`released_drive`).
    """

    log: PassLog
    plants: tuple[tuple[str, Plant], ...]
    class_of: Ints
    released_vents: bool

    def __repr__(self) -> str:
        return f"FittingPasses({len(self)} passes of {len(self.plants)} cut classes)"

    def __len__(self) -> int:
        return len(self.log)

    @property
    def plant(self) -> Plant:
        """One of them: all stand at the same position."""
        return self.plants[0][1]

    def cut(self, number: int) -> Cut:
        """The cut of pass `number` with the mass that was logged."""
        of_class: Cut = self.plants[self.class_of[number]][1].cut
        return replace(of_class, mass_t=float(self.log.mass_t[number]))

    def taken(self, numbers: Ints) -> FittingPasses:
        """Some of the passes."""
        return replace(self, log=self.log.taken(numbers), class_of=self.class_of[numbers])


def fitting_passes(log: PassLog, plants: Sequence[tuple[str, Plant]], source: str) -> FittingPasses:
    """Each pass to the class with as many axles and the nearest mass per axle; `InputError` where there is none.

    `source` is what a message calls the configuration.
    """
    axles = np.array([plant.cut.axles for _, plant in plants])
    load = np.array([plant.cut.axle_load_t for _, plant in plants])
    same = axles[None, :] == log.axles[:, None]
    lost = np.flatnonzero(~same.any(axis=1))
    if len(lost):
        first = int(lost[0])
        raise InputError(
            f"{source}: no cut class has {log.axles[first]} axles, as the cut {log.cut_id[first]} of the log"
            f"{f' and {len(lost) - 1} more have' if len(lost) > 1 else ' has'}; add a [[cut]] of such cars"
        )
    apart = np.where(same, np.abs(load[None, :] - (log.mass_t / log.axles)[:, None]), np.inf)
    top = plants[0][1].position.top_stage
    highest = int(log.stage.max())
    if highest > top:
        raise InputError(f"{source}: the position has the stages 0 to {top}, but the log commands stage {highest}")
    position = plants[0][1].position
    vents = released_drive_vents(log, position.stage_pressures_kpa, position.pneumatics)
    return FittingPasses(log, tuple(plants), np.argmin(apart, axis=1), vents)


def loaded_passes(
    logs: Sequence[Path],
    mapping: Path | None,
    config: ResolvedConfig,
    source: str,
    warn: Callable[[str], None],
) -> FittingPasses:
    """The sound passes in `logs`; `warn` is told of files and passes that are left out.

    `source` is what a message calls the configuration. `mapping`: a file that names foreign columns.
    Raises `InputError` where no pass is sound, and for cuts that no class fits.
    """
    try:
        names = None if mapping is None else read_mapping(mapping)
        loaded = read_logs(logs, names, config.retarder.position.top_stage)
    except InvalidLog as fault:
        raise InputError(str(fault)) from None
    for refused in loaded.refused:
        warn(refused.sentence)
    for left_out in loaded.faults:
        warn(left_out.sentence)
    return fitting_passes(loaded.log, config.plants(), source)


@dataclass(frozen=True, eq=False)
class AskedPasses:
    """`passes` by the cut classes of `config`, which messages call `place`; `warnings` tell what is left out."""

    config: ResolvedConfig
    place: str
    passes: FittingPasses
    warnings: tuple[str, ...]

    def head(self, more_warnings: tuple[str, ...] = (), reads: tuple[Path, ...] = ()) -> Head:
        """What is said of configuration and logs, with the other files that are read."""
        return head_of(self.config, (*self.warnings, *more_warnings), reads)


def asked_passes(options: LogOptions, config: ResolvedConfig, place: str) -> AskedPasses:
    """The passes of the logs that were typed; `InputError` where none is sound, or no class fits one."""
    warnings: list[str] = []
    passes = loaded_passes(options.logs, options.mapping, config, place, warnings.append)
    return AskedPasses(config, place, passes, tuple(warnings))
