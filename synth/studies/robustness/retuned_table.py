"""The table that a tune would have made, had it known the true plant."""

from __future__ import annotations

from plant_models import Plant
from synth.configuration.resolved_config import ResolvedConfig
from synth.problem.aim import Aim
from synth.solver.chain.chain import persistent_chain
from synth.solver.tabulate import tabulate
from synth.solver.tuned_lines import tuned_lines
from tuning_tables import ControllerTable, Generator, Predicted


def retuned(config: ResolvedConfig, plant: Plant, target_m_s: float) -> ControllerTable:
    """Solved, fitted, polished and rounded as in a tune of `plant`; without prediction and validation."""
    resolution = config.grid.resolution(plant.sensor.sample_period_s)
    design = persistent_chain(plant, resolution)
    lines = tuned_lines(design, Aim(target_m_s, config.criterion), config.fit.degree).lines
    unknown, by = Predicted(0.0, 0.0, 0.0, 0.0), Generator("robustness", "0", config.sha256)
    return tabulate(plant, lines, target_m_s, unknown, by, "retuned", "2000-01-01T00:00:00Z")
