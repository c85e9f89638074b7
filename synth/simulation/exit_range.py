"""How slow and how fast a position can let each pass leave, whatever regulator commands it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from plant_models import Plant
from synth.kernels.loop.passes import Draws
from synth.simulation.closed_loop import ClosedLoop, LineController, close_loop
from synth.simulation.controllers import full_brake
from synth.simulation.passes import ExitSample
from synth.solver.switching_lines import SwitchingLines

ABOVE_EVERY_SPEED_M_S = 1e3


@dataclass(frozen=True)
class ExitRange:
    """The same passes braked as hard as the position can, and not braked.

    Whatever a regulator commands, at rest or at any time, it lets no pass leave slower than in `slowest` or faster than
    in `fastest`: of two brakes that act on the same pass, the one with the higher pressure at every time never makes it
    faster.
    """

    slowest: ExitSample
    fastest: ExitSample


def exit_range(loop: ClosedLoop, draws: Draws) -> ExitRange:
    """The range of the passes `draws` of the plant of `loop`.

    `slowest`: the highest stage, commanded at the first sample in one go, before the entrance too. So it bounds also
    the regulators that may command only a lower stage there. To raise as they may would not bound them: who times the
    fill so that the valve is still open at the entrance has the higher pressure. `fastest`: released at the first
    sample, in one go.
    """
    plant = loop.plant
    free = close_loop(any_stage_at_once(plant), plant.top_stage + 1)
    hardest = full_brake(free.stages, plant.start_m, plant.exit_m)
    return ExitRange(free.run(hardest, draws), free.run(released(free.stages, plant.start_m, plant.exit_m), draws))


def any_stage_at_once(plant: Plant) -> Plant:
    """`plant` whose regulator may command any stage before the entrance."""
    return replace(plant, approach=replace(plant.approach, entrance_stage=plant.top_stage))


def released(stages: int, start_m: float, exit_m: float) -> LineController:
    """A regulator of so many stages that releases at its first decision and never brakes."""
    lower, upper = np.full((stages, 2), ABOVE_EVERY_SPEED_M_S), np.full((stages, 2), np.inf)
    lower[0] = -np.inf
    return LineController(SwitchingLines(np.array([start_m, exit_m]), lower, upper))
