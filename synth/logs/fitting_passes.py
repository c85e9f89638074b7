"""Which cut class of a configuration each measured pass belongs to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from plant_models import Cut, Plant
from plant_models.frozen_arrays import Ints, frozen_arrays
from synth.frame.input_error import InputError
from synth.logs.released_drive import released_drive_vents
from tuning_tables.pass_log.pass_log import PassLog


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
