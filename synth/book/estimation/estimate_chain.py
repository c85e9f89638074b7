"""The plant as a regulator with an estimator sees it: what its lines are solved and polished on."""

from __future__ import annotations

from dataclasses import replace

from plant_models import Plant
from plant_models.speed_sensor import measured_speed_std
from synth.book.estimation.estimated_table import controller_of
from synth.problem.estimator_resolution import design_error_m_s, estimator_resolution
from synth.problem.resolution import Resolution
from synth.simulation.closed_loop import simulate
from synth.simulation.exit_statistics import exit_statistics
from synth.simulation.random_passes import RandomPasses
from synth.solver.chain.chain import Chain, persistent_chain
from synth.solver.chain.speed_measurement import SmoothMeasurement
from synth.solver.polynomial_lines import PolynomialLines

RESERVE_NODES = 1
"""More scenarios of friction for any day: lines keep a reserve down to the lowest of them and no further."""


def estimate_chain(plant: Plant, resolution: Resolution, lowest_target_m_s: float) -> Chain:
    """The chain to design lines for estimated speeds on, for all targets of a plant on any day.

    The speed is seen with a white error, unquantised.
    """
    finer = estimator_resolution(resolution, plant.sensor, lowest_target_m_s)
    if plant.friction.mean_cv > 0.0:
        finer = replace(finer, friction_nodes=finer.friction_nodes + RESERVE_NODES)
    seen = SmoothMeasurement(measured_speed_std(design_error_m_s(plant.sensor), 0.0))
    return replace(persistent_chain(on_any_day(plant), finer), measurement=seen)


def rms_with_white_error(plant: Plant, lines: PolynomialLines, target_m_s: float, passes: RandomPasses) -> float:
    """What the lines reach where the error of the estimate is white, m/s: the figure of the chain, without its grid.

    `passes` are of `plant` on any day.
    """
    sensor = replace(plant.sensor, noise_m_s=design_error_m_s(plant.sensor), resolution_m_s=0.0)
    sample = simulate(replace(on_any_day(plant), sensor=sensor), controller_of(lines, None), passes)
    return exit_statistics(sample, target_m_s).rms_m_s


def on_any_day(plant: Plant) -> Plant:
    """`plant` with the friction of a cut on an unknown day."""
    return replace(plant, friction=plant.friction.of_any_day)
