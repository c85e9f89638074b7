"""One table on its nominal plant, and the same passes on any other plant."""

from __future__ import annotations

from dataclasses import dataclass

from plant_models import Plant
from scripts.studies.robustness.findings import OutcomeRow
from scripts.studies.robustness.perturbation import Perturbation
from synth.simulation.closed_loop import TableController, simulate
from synth.simulation.exit_statistics import exit_statistics, rms_ratio
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from tuning_tables import ControllerTable


@dataclass(frozen=True)
class Trial:
    """A table, the plant it was tuned for, common random passes, and how they end there."""

    label: str
    table: ControllerTable
    plant: Plant
    passes: RandomPasses
    nominal: ExitSample

    @property
    def target_m_s(self) -> float:
        """The commanded exit speed."""
        return self.table.target_speed_m_s

    def sample(self, perturbation: Perturbation, table: ControllerTable | None = None) -> ExitSample:
        """The passes under `perturbation`, by the trial's table or another; `PlantError` for an impossible plant."""
        return simulate(perturbation.change(self.plant), TableController(table or self.table), self.passes)

    def outcome(self, perturbation: Perturbation, table: ControllerTable | None = None) -> OutcomeRow:
        """Figures of `sample`, compared with the nominal passes of the trial's table."""
        sample = self.sample(perturbation, table)
        s = exit_statistics(sample, self.target_m_s)
        ratio, ratio_ci95 = rms_ratio(sample, self.nominal, self.target_m_s)
        return OutcomeRow(
            perturbation.name, perturbation.note, s.rms_m_s, s.rms_ci95_m_s, ratio, ratio_ci95, s.bias_m_s,
            s.bias_ci95_m_s, s.overspeed, s.overspeed_ci95, s.stalled, s.stalled_ci95, s.switchings,
        )  # fmt: skip


def trial_of(label: str, table: ControllerTable, plant: Plant, passes: RandomPasses) -> Trial:
    """The trial of `table`, tuned for `plant`."""
    return Trial(label, table, plant, passes, simulate(plant, TableController(table), passes))
