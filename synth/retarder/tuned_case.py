"""What a tune finds out about a cut class and target, on whatever epochs the regulator decides; how cases are grouped,
and what files are called.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant
from plant_models.frozen_arrays import Floats, frozen_arrays
from synth.retarder.comparison.measured import Measured
from synth.simulation.exit_statistics import BrakePower, ExitStatistics, UnavoidableError
from synth.simulation.passes import PassTrace
from synth.solver.descent import Descent
from synth.solver.exit_density import ExitDensity
from tuning_tables.document import StageTable


@frozen_arrays
class Feasibility:
    """From which entry speeds the position can keep `limit_m_s`, the rms that is accepted.

    `entry_m_s` (n,) up to the position's highest entry speed, and `entry_rms_m_s` (n,): rms of the unavoidable error of
    cuts that enter with that speed; `served_m_s`: (low, high) where it meets the limit, None if nowhere.
    """

    limit_m_s: float
    entry_m_s: Floats
    entry_rms_m_s: Floats
    served_m_s: tuple[float, float] | None


@dataclass(frozen=True)
class GridCheck:
    """The rms of polished lines on the grid of their design, and what an independent computation says of it.

    `again`: whether the design is a second one, on finer speeds, as the first was not believed. `most_off`: factor
    between the two, either way, beyond which the grid is not believed.
    """

    design_rms_m_s: float
    independent_rms_m_s: float
    again: bool
    most_off: float

    @property
    def share(self) -> float:
        """The first over the second; 1 where the second is 0."""
        return self.design_rms_m_s / self.independent_rms_m_s if self.independent_rms_m_s > 0.0 else 1.0

    @property
    def is_believed(self) -> bool:
        """Whether the two agree."""
        return 1.0 / self.most_off <= self.share <= self.most_off


MOST_ESCAPED = 1e-4
"""Probability that may leave the top of the speed grid before a prediction is called doubtful."""


@frozen_arrays
class TunedCase:
    """One cut class and target: the table as read back, its prediction, and what the closed loop says of it.

    `predicted`: the exit density behind the table's prediction; `polish`: how the search for lines, surfaces or
    switching speeds of least cost ended. `statistics` are of the simulated passes, which left with `exit_speeds_m_s`
    (n,), stalls as 0, and stand for `exit_weight` (n,) cuts; `brake_power`: what of their error is for want of it;
    `unavoidable`: the error that no regulator of the position avoids, of any that decides on these epochs. `traces`:
    passes of the table with the friction factors `TRACE_FACTORS`.
    """

    label: str
    plant: Plant
    table: StageTable
    predicted: ExitDensity
    polish: Descent[object]
    exit_speeds_m_s: NDArray[np.float32]
    exit_weight: Floats
    statistics: ExitStatistics
    brake_power: BrakePower
    unavoidable: UnavoidableError
    traces: tuple[PassTrace, ...]

    @property
    def target_speed_m_s(self) -> float:
        """The commanded exit speed."""
        return self.table.target_speed_m_s

    @property
    def target_name(self) -> str:
        """The commanded exit speed in words."""
        return f"target {self.target_speed_m_s:g} m/s"

    @property
    def name(self) -> str:
        """Cut class and target in one line."""
        return f"{self.label}, {self.target_name}"

    @property
    def cut_name(self) -> str:
        """Cut class with what matters of the cut: category, mass, axles."""
        cut = self.plant.cut
        return f"{self.label} (category {cut.category}, {cut.mass_t:g} t, {cut.axles} axles)"

    @property
    def measured(self) -> Measured:
        """The closed loop of the table, beside what the table predicts of it."""
        predicted = self.table.predicted
        return Measured("table", self.statistics, predicted.rms_m_s, predicted.passes)

    @property
    def remarks(self) -> tuple[str, ...]:
        """What else is told when the case has ended, a sentence each."""
        return ()

    @property
    def warnings(self) -> tuple[str, ...]:
        """What throws doubt on the figures of the case, a sentence each."""
        found = []
        if not self.polish.converged:
            found.append(
                f"the polish ended before it converged ({self.polish.status}): its table is the best of "
                f"{self.polish.evaluations} evaluations"
            )
        if self.predicted.escaped > MOST_ESCAPED:
            found.append(
                f"a probability of {self.predicted.escaped:.1e} left the top of the speed grid in the prediction, "
                f"where {MOST_ESCAPED:g} is allowed: lower grid.speed_step_m_s"
            )
        return tuple(found)


Case = TypeVar("Case", bound=TunedCase)


def file_stem(*parts: str) -> str:
    """A file name from words: lower case, letters and digits of any script kept, the rest one hyphen."""
    text = "".join(c if c.isalnum() or c == "." else " " for c in " ".join(parts).lower())
    return "-".join(text.split())


def by_class(cases: Iterable[Case]) -> tuple[tuple[Case, ...], ...]:
    """The cases of each cut class, in the order in which the classes first appear."""
    groups: dict[str, list[Case]] = {}
    for case in cases:
        groups.setdefault(case.label, []).append(case)
    return tuple(tuple(group) for group in groups.values())
