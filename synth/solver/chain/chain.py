"""The plant as a Markov chain: everything that a sweep needs and that depends on neither policy nor target speed.

Also on a finer speed grid, for criteria that live in the tails of the exit speed, and as the kernels take it.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from plant_models import Plant, path_coefficients
from plant_models.frozen_arrays import Floats, frozen_arrays
from plant_models.stage_regulator import Actuator, stage_locked_actuator
from synth.kernels.sweep import chain_arrays as kernel
from synth.kernels.sweep.chain_arrays import PathNoise, TransientNoise
from synth.kernels.sweep.pass_time import Times
from synth.problem.resolution import Resolution
from synth.solver.chain.decisions import DecisionEpochs, Decisions
from synth.solver.chain.grid import Grid
from synth.solver.chain.landings import Landings, friction_factors, make_landings
from synth.solver.chain.sampling import TimeSamples
from synth.solver.chain.scenarios import (
    Scenarios,
    check_scenarios,
    correlated_noise,
    persistent_scenarios,
    resistance_scenarios,
    transient_noise,
)
from synth.solver.chain.speed_measurement import SpeedMeasurement

NODE_AT_ENTRANCE_M = 1e-9
"""A path node this near to the entrance is there."""


@frozen_arrays
class Chain:
    """One plant on the grid of one resolution; everything but policy and aim.

    `epochs`: when the regulator decides, and `decisions` where that is on the grid. `measurement`: the measured speed
    as command probabilities take it. `drive_m_s2`, `brake_m_s2_per_kpa` (N,): cell means, times the cell's width over
    ΔS. `entry` (M + 1, E): probability of entry energy j with the first decision at path node r. `entry_mode`: the
    resting mode that the regulator finds. `other_days`: the plant on days on which it is another one, with the share of
    all days that each stands for; lines are polished for all of them, solved and predicted for this one.
    """

    plant: Plant
    resolution: Resolution
    epochs: DecisionEpochs
    decisions: Decisions
    measurement: SpeedMeasurement
    grid: Grid
    actuator: Actuator
    drive_m_s2: Floats
    brake_m_s2_per_kpa: Floats
    landings: Landings
    path_noise: PathNoise
    transient_noise: TransientNoise
    scenarios: Scenarios
    entry: Floats
    entry_mode: int
    other_days: tuple[tuple[float, Chain], ...] = ()

    @property
    def approach_nodes(self) -> int:
        """Number of path nodes before the entrance."""
        return int(np.searchsorted(self.grid.path_m, -NODE_AT_ENTRANCE_M))

    def quantised(self) -> Chain:
        """The same with the sensor's staircase."""
        return replace(self, measurement=self.epochs.predicted_measurement(self.plant, self.grid))


def persistent_chain(plant: Plant, resolution: Resolution, epochs: DecisionEpochs | None = None) -> Chain:
    """ξ_cut in scenarios, η as a correlated chain, a smooth measurement: the default formulation.

    `epochs`: when the regulator decides; None: at the samples of the plant's radar.
    """
    scenarios = persistent_scenarios(plant, resolution.friction_nodes, resolution.resistance_nodes)
    return chain_of(plant, resolution, scenarios, epochs)


def check_chain(plant: Plant, resolution: Resolution, epochs: DecisionEpochs | None = None) -> Chain:
    """The persistent formulation with `check_scenarios` and the sensor's staircase: predicts a finished table."""
    scenarios = check_scenarios(plant, resolution.friction_nodes, resolution.resistance_nodes)
    return chain_of(plant, resolution, scenarios, epochs).quantised()


def chain_of(plant: Plant, resolution: Resolution, scenarios: Scenarios, epochs: DecisionEpochs | None = None) -> Chain:
    """The plant on the grid of `resolution`, η as a correlated chain."""
    epochs = TimeSamples(plant.sensor) if epochs is None else epochs
    grid = epochs.grid(plant, resolution)
    actuator = stage_locked_actuator(plant.position, epochs.clock, plant.top_stage, epochs.substeps(resolution))
    coefficients = path_coefficients(plant.position, plant.cut, plant.profile, grid.path_m)
    path_noise = correlated_noise(plant.friction, grid.path_step_m, resolution.path_levels)
    decisions = epochs.decisions(plant, grid)
    factors = friction_factors(plant)
    landings = make_landings(plant, grid, decisions, actuator, epochs.clock.sample_period_s, factors)
    return Chain(
        plant=plant,
        resolution=resolution,
        epochs=epochs,
        decisions=decisions,
        measurement=epochs.measurement(plant, grid),
        grid=grid,
        actuator=actuator,
        drive_m_s2=coefficients.free_m_s2(plant.resistance.mean_n_per_kn) * grid.stretch,
        brake_m_s2_per_kpa=coefficients.brake_m_s2_per_kpa * grid.stretch,
        landings=landings,
        path_noise=path_noise,
        transient_noise=noise_on_landings(path_noise, landings, grid),
        scenarios=scenarios,
        entry=epochs.entry(plant, grid),
        entry_mode=actuator.mode_of(plant.approach.initial_stage),
    )


def noise_on_landings(path_noise: PathNoise, landings: Landings, grid: Grid) -> TransientNoise:
    """The mean of η over every change of stage, up to the longest path that one takes."""
    longest = math.ceil(landings.travel_m.max() / grid.path_step_m) + 2
    return transient_noise(path_noise, landings.overpressure_kpa, landings.samples, longest)


def finer_in_speed(chain: Chain, times: float, scenarios: Scenarios) -> Chain:
    """The same plant, path step and measurement with a speed step `times` as fine, and with `scenarios`."""
    resolution = replace(chain.resolution, speed_step_m_s=chain.resolution.speed_step_m_s / times)
    return replace(chain_of(chain.plant, resolution, scenarios), measurement=chain.measurement)


def known_factors(plant: Plant, factors: Floats, resistance_nodes: int) -> Scenarios:
    """Every friction factor (F,) with each of W values of the running resistance, which is innermost; the factors are
    weighted equally, the resistance by its law."""
    extra, weight = resistance_scenarios(plant, resistance_nodes)
    count = len(factors)
    return Scenarios(np.repeat(factors, len(extra)), np.tile(extra, count), np.tile(weight / count, count))


def chain_arrays(c: Chain, commands: int | None = None) -> kernel.ChainArrays:
    """All but policy, scenarios and aim; of so many commands, by default all."""
    a, commands = c.landings, c.decisions.commands if commands is None else commands
    return kernel.ChainArrays(
        kernel.Grid(c.grid.speed_m_s, c.grid.path_step_m, c.grid.energy_step_m2_s2),
        kernel.Track(c.drive_m_s2, c.brake_m_s2_per_kpa),
        kernel.Modes(c.actuator.mode_stage, c.actuator.mode_overpressure_kpa, c.entry_mode),
        c.path_noise,
        c.transient_noise,
        kernel.Landings(a.change_chain[:commands], a.end_mode, a.ends, a.factors),
        c.decisions.at_nodes(len(c.drive_m_s2)),
        c.epochs.hold_period_s,
        c.entry,
    )


def scenario_arrays(c: Chain, chosen: slice = slice(None)) -> kernel.Scenarios:
    """The `chosen` scenarios."""
    return kernel.Scenarios(c.scenarios.factor[chosen], c.scenarios.extra_m_s2[chosen])


def pass_times(c: Chain) -> Times:
    """What the recursions must know to count the time of a pass."""
    path = c.grid.path_m
    duration = np.asarray(c.landings.samples * c.epochs.clock.sample_period_s, dtype=np.float64)
    return Times(np.diff(path), path[-1] - path[:-1], duration, np.array(c.decisions.lead_m))
