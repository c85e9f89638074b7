"""The plant as a regulator with an estimator sees it: what its lines are solved and polished on."""

from __future__ import annotations

import math
from dataclasses import replace

from plant_models import Plant
from plant_models.speed_sensor import measured_speed_std
from synth.problem.estimator_resolution import design_error_m_s, estimator_resolution
from synth.problem.resolution import Resolution
from synth.retarder.estimation.estimated_table import controller_of
from synth.simulation.closed_loop import simulate
from synth.simulation.exit_statistics import exit_statistics
from synth.simulation.random_passes import RandomPasses
from synth.solver.chain.chain import Chain, persistent_chain
from synth.solver.chain.speed_measurement import SmoothMeasurement
from synth.solver.polynomial_lines import PolynomialLines

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
