"""What a regulator reaches that is told the friction of every cut, with more effort than a tune makes.

All else is as it is: sensor, sampling, valves, path noise, one stage a command. It passes cuts as they come, each with
the lines for its friction.
"""

from __future__ import annotations

from dataclasses import replace

from plant_models import Plant
from synth.problem.aim import Aim
from synth.retarder.comparison.told_regulator import Told, by_lines, run_told
from synth.simulation.closed_loop import close_loop
from synth.simulation.passes import ExitSample
from synth.simulation.random_passes import RandomPasses
from synth.solver.backward_induction import solve
from synth.solver.chain.chain import Chain
from synth.solver.told_lines import SQUARED_ERROR_ALONE, Effort, told_lines
from synth.solver.tuned_lines import fitted, polished

THOROUGH = Effort(frictions=13, iterations=(40, 40), resistance_nodes=2, least_share=0.0)
"""At more frictions; until a step gains nothing; also for the resistance that is not told; at every friction."""


def thorough(frictions: int, iterations: int) -> Effort:
    """As `THOROUGH`, with so many frictions and iterations of each polish."""
    return replace(THOROUGH, frictions=frictions, iterations=(iterations, iterations))


def told_friction(design: Chain, target_m_s: float, degree: int, effort: Effort = THOROUGH) -> Told:
    """The regulator of lines that are solved, fitted and polished on `design`, then polished for each friction."""
    solution = solve(design, Aim(target_m_s, SQUARED_ERROR_ALONE))
    fit = fitted(solution, degree)
    return by_lines(told_lines(design, target_m_s, polished(solution, fit).best, fit.curvature, effort))


def simulate_told(plant: Plant, told: Told, passes: RandomPasses) -> ExitSample:
    """`passes` of `plant`, each under the regulator for its friction."""
    loop = close_loop(plant, plant.top_stage + 1)
    return run_told(lambda _: loop, loop.draws(passes), told)
