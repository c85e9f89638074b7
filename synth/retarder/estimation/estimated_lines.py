"""Lines and surfaces for the estimated speed: the plant as a regulator with an estimator sees it, what is polished on
it, and what is trimmed (`estimated_table`).

Surfaces, for a regulator that may command at every sample, are designed as lines are, for the friction of any day, and
trimmed in the closed loop on the tuning days. But the error of the estimate is not taken for white: a regulator that is
asked at every sample would count on the next sample to take it away. What hidden friction and resistance shift of the
estimate is known to the design.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from plant_models import Plant
from plant_models.speed_sensor import measured_speed_std
from synth.problem.problem import Aim
from synth.problem.resolution import Resolution, design_error_m_s, design_resolution, estimator_resolution
from synth.retarder.checked_design import (
    CheckedDesign,
    checked_design,
    polished_surfaces,
    starting_surfaces,
    trial_table,
)
from synth.retarder.estimation.estimated_table import (
    EstimatedTable,
    Trim,
    Untrimmed,
    controller_of,
    lines_for_estimate,
    trimmed_on,
)
from synth.retarder.estimation.estimator_design import error_of_estimate, estimator_of
from synth.retarder.estimation.tuning_days import TuningDays
from synth.simulation.closed_loop import TableController, close_loop, simulate
from synth.simulation.exit_statistics import exit_statistics
from synth.simulation.random_passes import RandomPasses
from synth.solver.any_time.polynomial_surfaces import PolynomialSurfaces
from synth.solver.any_time.surface_polish import opened
from synth.solver.backward_induction import Solution
from synth.solver.chain.chain import Chain, persistent_chain
from synth.solver.chain.speed_measurement import SmoothMeasurement
from synth.solver.descent import Descent
from synth.solver.switching_lines import PolynomialLines
from tuning_tables.estimator import Estimator

RESERVE_NODES = 1
"""More scenarios of friction for any day: lines keep a reserve down to the lowest of them and no further."""


SLOW_DAY_SHARE, SLOW_DAY_Z = 1.0 / 6.0, math.sqrt(3.0)
"""The upper of the three nodes of Gauss and Hermite for how slow the valves are. The lower is left to the middle one:
faster valves ask for nothing more."""

SLOW_DAY_FRICTIONS = 3
"""Scenarios of friction of that day, at the mean resistance. With as many as on the usual day its rms is the same
within 3 % (22, 52, 66, 85 t)."""


def estimate_chain(plant: Plant, resolution: Resolution, lowest_target_m_s: float) -> Chain:
    """The chain to design lines for estimated speeds on, for all targets of a plant on any day.

    The speed is seen with a white error, unquantised.
    """
    finer = estimator_resolution(resolution, plant.sensor, lowest_target_m_s)
    if plant.friction.mean_cv > 0.0:
        finer = replace(finer, friction_nodes=finer.friction_nodes + RESERVE_NODES)
    seen = SmoothMeasurement(measured_speed_std(design_error_m_s(plant.sensor), 0.0))
    usual = replace(persistent_chain(on_any_day(plant), finer), measurement=seen)
    if plant.position.pneumatics.day_spread == 0.0:
        return usual
    coarser = replace(finer, friction_nodes=SLOW_DAY_FRICTIONS, resistance_nodes=1)
    slow = replace(persistent_chain(on_a_slow_day(plant), coarser), measurement=seen)
    return replace(usual, other_days=((SLOW_DAY_SHARE, slow),))


def rms_with_white_error(plant: Plant, lines: PolynomialLines, target_m_s: float, passes: RandomPasses) -> float:
    """What the lines reach where the error of the estimate is white, m/s: the figure of the chain, without its grid.

    `passes` are of `plant` on any day.
    """
    sensor = replace(plant.sensor, noise_m_s=design_error_m_s(plant.sensor), resolution_m_s=0.0)
    sample = simulate(replace(on_any_day(plant), sensor=sensor), controller_of(lines, None), passes)
    return exit_statistics(sample, target_m_s).rms_m_s


def on_a_slow_day(plant: Plant) -> Plant:
    """`plant` on a day of slow valves, with the friction of an unknown day."""
    drive = plant.position.pneumatics.on_day(SLOW_DAY_Z)
    return replace(on_any_day(plant), position=replace(plant.position, pneumatics=drive))


def on_any_day(plant: Plant) -> Plant:
    """`plant` with the friction of a cut on an unknown day."""
    return replace(plant, friction=plant.friction.of_any_day)


@dataclass(frozen=True)
class SimulatedRms:
    """The rms of lines on simulated passes, m/s; `most_off`: a grid is not believed where it differs by more.

    More than for an exact figure: the rare cuts that saturate the brake make up to a fifth of it, by chance.
    """

    rms_m_s: float
    most_off: float = 1.5


def estimated_lines(
    plant: Plant, solution: Solution, degree: int, tuning: RandomPasses, days: TuningDays
) -> tuple[CheckedDesign[SimulatedRms], EstimatedTable[PolynomialLines]]:
    """How the lines of a solution on `estimate_chain` were designed, and how they were trimmed on `days`.

    `tuning`: passes of `plant` on any day, on which the grid of the design is judged.
    """
    aim = solution.aim

    def judge(lines: PolynomialLines) -> SimulatedRms:
        return SimulatedRms(rms_with_white_error(plant, lines, aim.target_speed_m_s, tuning))

    design = checked_design(solution, solution.chain, degree, judge)
    estimator, error_m_s = estimator_of(plant), design_error_m_s(plant.sensor)
    untrimmed = lines_for_estimate(design.kept.lines, estimator, error_m_s, aim.criterion)
    return design, trimmed_on(days, aim.target_speed_m_s, untrimmed)


ERROR_PASSES = 300
"""Passes on which the error of the estimate is found."""

LEAST_NOISE = 0.5
"""The noise is taken for no less than this share of the whole error: a smaller one would ask for a finer grid. With
0.5, and a grid for it, the rms of 22, 36 and 52 t to 3 m/s is the same within 2 %."""

TRIM_TERMS, TRIM_EVALUATIONS = 3, 100
"""Surfaces are asked far oftener than lines, so what is not white in the error moves them more, and not everywhere
alike: with two shifts 22 t to 2 m/s has 0.89 of the rms of the default table, with parabolas of the path 0.77."""

RESISTANCES = 2
"""Values of the running resistance, at least."""


def estimated_surfaces(
    plant: Plant, aim: Aim, made: EstimatedTable[PolynomialLines], has_gauge: bool, tuning: RandomPasses
) -> tuple[Descent[PolynomialSurfaces], Untrimmed[PolynomialSurfaces]]:
    """How surfaces were polished from the lines that were `made` for the estimator and commands at rest; and these, to
    be trimmed. `tuning`: passes on which the error of the estimate is found.
    """
    target_m_s = aim.target_speed_m_s
    start = starting_surfaces(plant, made.lines, has_gauge)

    def controller(surfaces: PolynomialSurfaces, estimator: Estimator) -> TableController:
        return TableController(trial_table(plant, surfaces, target_m_s, estimator))

    first = controller(start, made.estimator)
    loop = close_loop(plant, first.stages)
    draws = loop.draws(tuning.part(0, min(ERROR_PASSES, len(tuning))))
    error = error_of_estimate(loop, first, draws, LEAST_NOISE * made.error_m_s)
    steps = estimate_resolution(plant, target_m_s, made.error_m_s)
    polish = polished_surfaces(on_any_day(plant), aim, start, steps, error)
    criterion = aim.criterion
    prices = criterion.switching_tolerance_m2_s2, criterion.time_price_m2_s3, criterion.terminal
    trim = Trim(TRIM_TERMS, TRIM_EVALUATIONS, *prices)
    return polish, Untrimmed(polish.best, made.estimator, made.error_m_s, controller, opened, trim)


def estimate_resolution(plant: Plant, target_m_s: float, error_m_s: float) -> Resolution:
    """The grid to design surfaces for a speed with an error of `error_m_s` on, for the friction of any day."""
    steps = design_resolution(plant, target_m_s, error_m_s=error_m_s)
    more = RESERVE_NODES if plant.friction.mean_cv > 0.0 else 0
    resistances = max(RESISTANCES, steps.resistance_nodes)
    return replace(steps, friction_nodes=steps.friction_nodes + more, resistance_nodes=resistances)
