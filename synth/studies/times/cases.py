"""The closed loop that is timed: the middle class of the default book and the solver's lines for its middle target."""

from __future__ import annotations

from dataclasses import dataclass

from plant_models import Plant
from synth.configuration.config_file import load_config
from synth.problem.aim import Aim
from synth.simulation.closed_loop import LineController
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import persistent_chain


@dataclass(frozen=True)
class LoopCase:
    """A plant under lines; `name` is its label and target."""

    name: str
    config_sha256: str
    plant: Plant
    controller: LineController


def middle_case() -> LoopCase:
    """Solve it."""
    config = load_config(None)
    label, plant = config.plants()[len(config.plants()) // 2]
    target = config.targets_m_s[len(config.targets_m_s) // 2]
    lines = solve(persistent_chain(plant, config.resolution), Aim(target, config.criterion)).lines
    return LoopCase(f"{label} to {target:g} m/s", config.sha256, plant, LineController(lines))
