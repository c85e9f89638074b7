"""Simulated passes that many controllers of one plant are put through: common random numbers, made ready once; and
how slow and how fast a position can let each of them leave, whatever regulator commands it.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, cached_property, partial

import numpy as np

from plant_models import Plant
from synth.kernels.loop.passes import Draws
from synth.simulation.closed_loop import ClosedLoop, LineController, close_loop
from synth.simulation.controllers import Regulator, fixed, full_brake
from synth.simulation.passes import ExitSample, PassTrace
from synth.simulation.random_passes import RandomPasses
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


@dataclass(frozen=True)
class CommonPasses:
    """`passes` and what they mean for `plant`; `loop(stages)` is the plant with a regulator of so many stages.

    Build it with `common_passes`: a loop is then made once for each number of stages.
    """

    plant: Plant
    passes: RandomPasses
    draws: Draws
    loop: Callable[[int], ClosedLoop]

    def __len__(self) -> int:
        return len(self.passes)

    def run(self, controller: Regulator) -> ExitSample:
        """All passes under `controller`."""
        return self.loop(controller.stages).run(controller, self.draws)

    @cached_property
    def at_full_brake(self) -> ExitSample:
        """All passes under a regulator that raises at every decision: what a table can brake at most.

        It hears every reading: an estimator decides beside a lost one, too.
        """
        plant = self.plant
        hardest = full_brake(plant.top_stage + 1, plant.start_m, plant.exit_m)
        heard = self.draws._replace(noise_z=fixed(self.passes.noise_z, np.float32))
        return self.loop(hardest.stages).run(hardest, heard)

    @cached_property
    def exit_range(self) -> ExitRange:
        """What the position can do to each pass, whatever regulator commands it."""
        return exit_range(self.loop(self.plant.top_stage + 1), self.draws)

    def trace(self, controller: Regulator, index: int, cut_factor: float) -> PassTrace:
        """Pass `index` event by event, but with the friction factor `cut_factor`."""
        loop = self.loop(controller.stages)
        return loop.follow(controller, loop.draws(self.passes.part(index, index + 1), cut_factor))

    def first(self, count: int) -> CommonPasses:
        """The first `count` of these passes, or all if there are fewer."""
        few = Draws._make(array[:count] for array in self.draws)
        return CommonPasses(self.plant, self.passes.part(0, min(count, len(self))), few, self.loop)

    def of_others(self, passes: RandomPasses) -> CommonPasses:
        """Other passes of the same plant."""
        return CommonPasses(self.plant, passes, self.loop(self.plant.top_stage + 1).draws(passes), self.loop)


def common_passes(plant: Plant, passes: RandomPasses) -> CommonPasses:
    """Make `passes` ready for `plant`."""
    loop = cache(partial(close_loop, plant))
    return CommonPasses(plant, passes, loop(plant.top_stage + 1).draws(passes), loop)
