"""What a tune for a radar finds out about one case (cut class × target speed)."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from plant_models.frozen_arrays import frozen_arrays
from synth.problem.requirement_found import Finding
from synth.retarder.comparison.comparison import Comparison
from synth.retarder.comparison.measured import Measured
from synth.retarder.off_nominal.outcome import OffNominal
from synth.retarder.pareto.pareto_front import ParetoFront
from synth.retarder.tuned_case import Feasibility, GridCheck, TunedCase
from synth.solver.switching_lines import SwitchingLines
from synth.solver.tabulate import lines_of
from tuning_tables import ControllerTable

if TYPE_CHECKING:
    from synth.retarder.tuned_table import AnyEstimate

LINE_NODES = 301


@frozen_arrays
class CaseResult(TunedCase):
    """One case of tables with lines or surfaces, and beside its closed loop everything that it is compared with.

    `grid`: whether the grid of the design for the measured speed and commands at rest is to be believed; `finding`:
    what the criterion's requirement took; `estimate`: where an estimator is asked for, how its lines were designed;
    `ties`: see `share_of_ties`; `front`: where it is asked for, what less time in the position costs; `off_nominal`:
    what the table does on other plants than its own.
    """

    table: ControllerTable
    grid: GridCheck
    finding: Finding | None
    estimate: AnyEstimate | None
    comparison: Comparison
    feasibility: Feasibility
    ties: float
    front: ParetoFront | None
    off_nominal: tuple[OffNominal, ...]

    @property
    def table_lines(self) -> SwitchingLines:
        """The lines of the table, sampled densely."""
        return lines_of(self.table, np.linspace(self.plant.start_m, self.plant.exit_m, LINE_NODES))

    @property
    def controllers(self) -> tuple[Measured, ...]:
        """All controllers that had the passes: the table first."""
        return (self.measured, *self.comparison.entries)

    @property
    def remarks(self) -> tuple[str, ...]:
        """See `TunedCase`."""
        return () if self.finding is None else (self.finding.sentence,)

    @property
    def warnings(self) -> tuple[str, ...]:
        """See `TunedCase`."""
        found = list(super().warnings)
        if not self.grid.is_believed:
            found.append(
                f"on the grid of its design the rms is {self.grid.design_rms_m_s:.4f} m/s, without it "
                f"{self.grid.independent_rms_m_s:.4f}: there may be better lines; lower grid.speed_step_m_s"
            )
        sensor = self.plant.sensor
        if sensor.missed_share > 0.0 and self.table.predicted.passes is None:
            found.append(
                f"the prediction of the table counts on every reading, but {100.0 * sensor.missed_share:g} % are lost "
                "(sensor.missed_share): the simulation knows it, and regulator.estimator = true predicts with it"
            )
        return tuple(found)


def fronts_of(cases: Iterable[CaseResult]) -> tuple[ParetoFront, ...]:
    """What less time in the position costs, by case, where that was asked for."""
    return tuple(case.front for case in cases if case.front is not None)
