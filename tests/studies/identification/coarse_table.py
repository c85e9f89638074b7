"""A controller table of our own plant, solved in about a second: coarse, but of the same making as a real one."""

from __future__ import annotations

from plant_models import Plant
from synth.problem.problem import Aim
from synth.problem.resolution import Resolution
from synth.solver.chain.chain import persistent_chain
from synth.solver.tabulate import UNPREDICTED, tabulate
from synth.solver.tuned_lines import tuned_lines
from tuning_tables import ControllerTable, Generator

COARSE = Resolution(path_step_m=1.0, speed_step_m_s=0.06, friction_nodes=3, resistance_nodes=1)
DEGREE = 3


def coarse_table(plant: Plant, target_m_s: float) -> ControllerTable:
    """Solved on a coarse grid, fitted, polished and rounded; not predicted."""
    lines = tuned_lines(persistent_chain(plant, COARSE), Aim(target_m_s), DEGREE).best
    maker, name = Generator("a test", "0", "0" * 64), f"{plant.cut.mass_t:g}-t-to-{target_m_s:g}"
    return tabulate(plant, lines, target_m_s, UNPREDICTED, maker, name, "2000-01-01T00:00:00Z")
