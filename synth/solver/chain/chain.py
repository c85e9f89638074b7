"""The plant as a Markov chain: everything that a sweep needs and that depends on neither policy nor target speed."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant, path_coefficients
from plant_models.frozen_arrays import frozen_arrays
from plant_models.stage_regulator import Actuator, stage_locked_actuator
from synth.problem.resolution import Resolution
from synth.solver.chain.entry import entry_distribution
from synth.solver.chain.grid import Grid, make_grid
from synth.solver.chain.landings import CHECK_FACTOR_STEP, FACTOR_STEP, Landings, friction_factors, make_landings
from synth.solver.chain.path_noise import (
    PathNoise,
    TransientNoise,
    correlated_noise,
    independent_noise,
    transient_noise,
)
from synth.solver.chain.scenarios import Scenarios, check_scenarios, persistent_scenarios
from synth.solver.chain.speed_measurement import SpeedMeasurement, quantised_measurement, smooth_measurement

NODE_AT_ENTRANCE_M = 1e-9
"""A path node this near to the entrance is there."""


@frozen_arrays
@dataclass(frozen=True, eq=False)
class Chain:
    """One plant on the grid of one resolution; everything but policy and aim.

    `measurement`: the measured speed as command probabilities take it. `drive_m_s2`, `brake_m_s2_per_kpa` (N,): cell
    means. `entry` (M + 1, E): probability of entry energy j with the first sample at path node r.
    `entry_mode`: the resting mode that the regulator finds.
    """

    plant: Plant
    resolution: Resolution
    measurement: SpeedMeasurement
    grid: Grid
    actuator: Actuator
    drive_m_s2: NDArray[np.float64]
    brake_m_s2_per_kpa: NDArray[np.float64]
    landings: Landings
    path_noise: PathNoise
    transient_noise: TransientNoise
    scenarios: Scenarios
    entry: NDArray[np.float64]
    entry_mode: int

    @property
    def approach_nodes(self) -> int:
        """Number of path nodes before the entrance."""
        return int(np.searchsorted(self.grid.path_m, -NODE_AT_ENTRANCE_M))

    def quantised(self) -> Chain:
        """The same with the sensor's staircase."""
        return replace(self, measurement=quantised_measurement(self.plant.sensor))


def persistent_chain(plant: Plant, resolution: Resolution) -> Chain:
    """ξ_cut in scenarios, η as a correlated chain, a smooth measurement: the default formulation."""
    scenarios = persistent_scenarios(plant, resolution.friction_nodes, resolution.resistance_nodes)
    return chain_of(plant, resolution, scenarios)


def check_chain(plant: Plant, resolution: Resolution) -> Chain:
    """The persistent formulation with `check_scenarios` and the sensor's staircase: predicts a finished table."""
    scenarios = check_scenarios(plant, resolution.friction_nodes, resolution.resistance_nodes)
    return chain_of(plant, resolution, scenarios, CHECK_FACTOR_STEP).quantised()


def chain_of(plant: Plant, resolution: Resolution, scenarios: Scenarios, factor_step: float = FACTOR_STEP) -> Chain:
    """The plant on the grid of `resolution`, η as a correlated chain; `factor_step` as in `friction_factors`."""
    grid = make_grid(plant, resolution)
    actuator = stage_locked_actuator(plant.position, plant.sensor, plant.top_stage, resolution.transient_substeps)
    coefficients = path_coefficients(plant.position, plant.cut, plant.profile, grid.path_m)
    path_noise = correlated_noise(plant.friction, grid.path_step_m, resolution.path_levels)
    landings = make_landings(plant, grid, actuator, friction_factors(plant, factor_step))
    return Chain(
        plant=plant,
        resolution=resolution,
        measurement=smooth_measurement(plant.sensor),
        grid=grid,
        actuator=actuator,
        drive_m_s2=coefficients.free_m_s2(plant.resistance.mean_n_per_kn),
        brake_m_s2_per_kpa=coefficients.brake_m_s2_per_kpa,
        landings=landings,
        path_noise=path_noise,
        transient_noise=noise_on_landings(path_noise, landings, grid),
        scenarios=scenarios,
        entry=entry_distribution(plant, grid),
        entry_mode=actuator.mode_of(plant.approach.initial_stage),
    )


def with_known_friction(chain: Chain, factor: float) -> Chain:
    """The same plant whose ξ_cut is known to be `factor` (friction-known bound)."""
    return replace(chain, scenarios=Scenarios(np.array([float(factor)]), np.zeros(1), np.ones(1)))


def as_published(chain: Chain, levels: int = 5) -> Chain:
    """The same plant, grid and landings as published (zhukovitsky-2002): friction noise independent in every quantum.

    The whole spread of friction, persistent or not, is drawn anew in every quantum and not scaled to its length.
    Sampling, delays and measurement noise are those of the plant, so that only the friction is told apart.
    `levels`: Gauss–Hermite nodes of the noise in a quantum.
    """
    friction = chain.plant.friction
    path_noise = independent_noise(math.hypot(chain.plant.friction_cv, friction.path_std), levels)
    return replace(
        chain,
        path_noise=path_noise,
        transient_noise=noise_on_landings(path_noise, chain.landings, chain.grid),
        scenarios=Scenarios(np.ones(1), np.zeros(1), np.ones(1)),
    )


def noise_on_landings(path_noise: PathNoise, landings: Landings, grid: Grid) -> TransientNoise:
    """The mean of η over every change of stage, up to the longest path that one takes."""
    longest = math.ceil(landings.travel_m.max() / grid.path_step_m) + 2
    return transient_noise(path_noise, landings.overpressure_kpa, landings.samples, longest)
