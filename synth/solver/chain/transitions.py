"""Everything of a plant that a sweep needs and that depends on neither policy nor target speed."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant, path_coefficients
from plant_models.stage_regulator import Actuator, stage_locked_actuator
from synth.kernels.sweep.landing import land
from synth.kernels.vector.packs import EIGHT, SIXTEEN
from synth.problem.resolution import Resolution
from synth.solver.chain.grid import Grid, make_grid
from synth.solver.chain.path_noise import (
    PathChain,
    TransientNoise,
    correlated_chain,
    independent_chain,
    transient_noise,
)

FACTOR_STEP = 0.5
"""Largest distance of the friction factors for which transients are integrated; between them a parabola.

Halving it changes no predicted rms in the sixth digit."""

FINE_CELLS_PER_QUANTUM = 4


@dataclass(frozen=True)
class Landings:
    """End of every neighbouring stage change from every grid node, for friction `factors` (F,).

    `ends` (N, C, F, 2, E'), see `kernels.landing.land`, of which `points` E are energies of the grid; `lower_chain`,
    `upper_chain` (H,): index of the transient one stage down / up from a mode, −1 if none; `end_mode` (C,).
    """

    factors: NDArray[np.float64]
    ends: NDArray[np.float64]
    lower_chain: NDArray[np.int64]
    upper_chain: NDArray[np.int64]
    end_mode: NDArray[np.int64]
    overpressure_kpa: NDArray[np.float64]
    samples: NDArray[np.int64]
    points: int

    @property
    def travel_m(self) -> NDArray[np.float64]:
        """Path until the end of the transient, or to S_exit, (N, C, F, E); −1 for a stall."""
        return self.ends[..., 0, : self.points]

    @property
    def energy_m2_s2(self) -> NDArray[np.float64]:
        """v²/2 at the end of the transient, (N, C, F, E)."""
        return self.ends[..., 1, : self.points]


@dataclass(frozen=True)
class Scenarios:
    """Hidden constants of a pass: friction factor ξ_cut, added acceleration by w − E w, weights; shape (I,)."""

    factor: NDArray[np.float64]
    extra_m_s2: NDArray[np.float64]
    weight: NDArray[np.float64]


@dataclass(frozen=True)
class Transitions:
    """One plant on one grid: `drive_m_s2`, `brake_m_s2_per_kpa` (N,) cell means, landings, noise, entry.

    `entry` (M + 1, E): probability of entry energy j with the first sample at path node r.
    """

    plant: Plant
    grid: Grid
    actuator: Actuator
    drive_m_s2: NDArray[np.float64]
    brake_m_s2_per_kpa: NDArray[np.float64]
    landings: Landings
    chain: PathChain
    noise: TransientNoise
    scenarios: Scenarios
    entry: NDArray[np.float64]


def persistent_transitions(plant: Plant, resolution: Resolution) -> Transitions:
    """ξ_cut in scenarios, η as a correlated chain: the default formulation."""
    grid, actuator = make_grid(plant, resolution), actuator_of(plant, resolution)
    chain = correlated_chain(plant.friction, grid.path_step_m, resolution.path_levels)
    scenarios = persistent_scenarios(plant, resolution.friction_nodes, resolution.resistance_nodes)
    return assemble(plant, grid, actuator, chain, scenarios, make_landings(plant, grid, actuator))


def check_transitions(plant: Plant, resolution: Resolution) -> Transitions:
    """The persistent formulation with `check_scenarios`, for the prediction of a finished table."""
    grid, actuator = make_grid(plant, resolution), actuator_of(plant, resolution)
    chain = correlated_chain(plant.friction, grid.path_step_m, resolution.path_levels)
    scenarios = check_scenarios(plant, resolution.friction_nodes, resolution.resistance_nodes)
    return assemble(plant, grid, actuator, chain, scenarios, make_landings(plant, grid, actuator))


def with_known_friction(transitions: Transitions, factor: float) -> Transitions:
    """The same plant whose ξ_cut is known to be `factor` (friction-known bound)."""
    known = Scenarios(np.array([float(factor)]), np.zeros(1), np.ones(1))
    return Transitions(**{**vars(transitions), "scenarios": known})


def as_published(transitions: Transitions, levels: int = 5) -> Transitions:
    """The same plant, grid and landings as published (zhukovitsky-2002): friction noise independent in every quantum.

    The whole spread of friction, persistent or not, is drawn anew in every quantum and not scaled to its length.
    Sampling, delays and measurement noise are those of the plant, so that only the friction is told apart.
    `levels`: Gauss–Hermite nodes of the noise in a quantum.
    """
    plant = transitions.plant
    chain = independent_chain(math.hypot(plant.friction_cv, plant.friction.path_std), levels)
    scenarios = Scenarios(np.ones(1), np.zeros(1), np.ones(1))
    return assemble(plant, transitions.grid, transitions.actuator, chain, scenarios, transitions.landings)


def actuator_of(plant: Plant, resolution: Resolution) -> Actuator:
    """The plant's actuator cut into the resolution's transient sub-steps."""
    return stage_locked_actuator(plant.position, plant.sensor, plant.top_stage, resolution.transient_substeps)


def persistent_scenarios(plant: Plant, friction_nodes: int, resistance_nodes: int) -> Scenarios:
    """Product of Gauss–Hermite nodes of ξ_cut and Gauss nodes of w."""
    z, z_weight = np.polynomial.hermite_e.hermegauss(friction_nodes)
    factor = plant.friction.cut_factor(z, plant.friction_cv)
    extra, w_weight = resistance_scenarios(plant, resistance_nodes)
    return Scenarios(
        factor=np.repeat(factor, len(extra)),
        extra_m_s2=np.tile(extra, len(z)),
        weight=np.outer(z_weight / z_weight.sum(), w_weight).ravel(),
    )


def check_scenarios(plant: Plant, friction_nodes: int, resistance_nodes: int) -> Scenarios:
    """Scenarios for a prediction that must get the tails right, and not pay for every pair of (ξ_cut, w).

    ξ_cut at equally spaced nodes up to four standard deviations (the cost has a kink where the brake power
    ends, which a Gauss rule misses); w added as its main effect: E f(ξ, w) ≈ E f(ξ, w̄) + E f(1, w) − f(1, w̄),
    so one weight may be negative. `friction_nodes` must be odd.
    """
    z, z_weight = equally_spaced_normal(friction_nodes)
    extra, w_weight = resistance_scenarios(plant, resistance_nodes)
    z_weight[friction_nodes // 2] -= 1.0
    return Scenarios(
        factor=np.concatenate([plant.friction.cut_factor(z, plant.friction_cv), np.ones(len(extra))]),
        extra_m_s2=np.concatenate([np.zeros(len(z)), extra]),
        weight=np.concatenate([z_weight, w_weight]),
    )


def equally_spaced_normal(count: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Nodes from −4 to 4 and trapezoidal weights of the standard normal law, (count,) each."""
    z = np.linspace(-4.0, 4.0, count)
    weight = np.exp(-0.5 * z**2)
    return z, weight / weight.sum()


def resistance_scenarios(plant: Plant, count: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """(added acceleration of w − E w in m/s², probability) at Gauss nodes of the gamma law."""
    w, weight = plant.resistance.nodes(count)
    return -plant.cut.reduced_gravity_m_s2 * 1e-3 * (w - plant.resistance.mean_n_per_kn), weight


def assemble(
    plant: Plant, grid: Grid, actuator: Actuator, chain: PathChain, scenarios: Scenarios, landings: Landings
) -> Transitions:
    """Put the pieces of one plant together."""
    coefficients = path_coefficients(plant.position, plant.cut, plant.profile, grid.path_m)
    resistance = coefficients.resistance_m_s2_per_n_kn * plant.resistance.mean_n_per_kn
    longest = math.ceil(landings.travel_m.max() / grid.path_step_m) + 2
    return Transitions(
        plant=plant,
        grid=grid,
        actuator=actuator,
        drive_m_s2=coefficients.gravity_m_s2 - resistance,
        brake_m_s2_per_kpa=coefficients.brake_m_s2_per_kpa,
        landings=landings,
        chain=chain,
        noise=transient_noise(chain, landings.overpressure_kpa, landings.samples, longest),
        scenarios=scenarios,
        entry=entry_distribution(plant, grid),
    )


def make_landings(plant: Plant, grid: Grid, actuator: Actuator) -> Landings:
    """Integrate the motion through every change to a neighbouring stage (kernel `land`)."""
    modes = len(actuator.mode_stage)
    used: list[int] = []
    lower, upper = np.full(modes, -1), np.full(modes, -1)
    for neighbours, step in ((lower, -1), (upper, 1)):
        for mode, stage in enumerate(actuator.mode_stage):
            if 0 <= stage + step < actuator.stages:
                neighbours[mode] = len(used)
                used.append(int(actuator.command[mode, stage + step]))
    fine = np.linspace(0.0, plant.exit_m, FINE_CELLS_PER_QUANTUM * (len(grid.path_m) - 1) + 1)
    cells = path_coefficients(plant.position, plant.cut, plant.profile, fine)
    work = np.concatenate([[0.0], np.cumsum(cells.brake_m_s2_per_kpa * np.diff(fine))])
    drive = cells.gravity_m_s2 - cells.resistance_m_s2_per_n_kn * plant.resistance.mean_n_per_kn
    factors = friction_factors(plant)
    samples = actuator.chain_samples[used]
    overpressure = np.ascontiguousarray(actuator.chain_overpressure_kpa[used, : samples.max() * actuator.substeps])
    speed = in_whole_packs(grid.speed_m_s)
    ends = np.empty((len(grid.path_m) - 1, len(used), len(factors), 2, len(speed)))
    dt = plant.sensor.sample_period_s / actuator.substeps
    land(
        grid.path_step_m, work, drive, overpressure, samples, actuator.substeps, dt, factors,
        speed, ends,
    )  # fmt: skip
    return Landings(factors, ends, lower, upper, actuator.chain_mode[used], overpressure, samples, len(grid.speed_m_s))


def in_whole_packs(speed_m_s: NDArray[np.float64]) -> NDArray[np.float64]:
    """The speeds, the last one repeated, so that whole packs may be read from any of them on (`kernels.packs`)."""
    return np.pad(speed_m_s, (0, EIGHT + -(len(speed_m_s) + EIGHT) % SIXTEEN), mode="edge")


def friction_factors(plant: Plant) -> NDArray[np.float64]:
    """Equally spaced factors ξ that cover four standard deviations of ξ_cut and three of η."""
    cv, std = plant.friction_cv, plant.friction.path_std
    low = min(max(plant.friction.floor, 1.0 - 4.0 * cv) * max(1.0 - 3.0 * std, 0.0), 0.9)
    high = max((1.0 + 4.0 * cv) * (1.0 + 3.0 * std), 1.1)
    return np.linspace(low, high, max(3, math.ceil((high - low) / FACTOR_STEP) + 1))


def entry_distribution(plant: Plant, grid: Grid) -> NDArray[np.float64]:
    """Entry speed uniform, sampling phase uniform: the first sample lies within v·T_c of the entrance.

    The mass is spread so that the mean energy is kept; along the path by integrating the hat functions.
    """
    count = 2000 if plant.entry.high_m_s > plant.entry.low_m_s else 1
    v = plant.entry.speed_m_s((np.arange(count) + 0.5) / count)
    period, step = plant.sensor.sample_period_s, grid.path_step_m
    most_quanta = 1.01 * grid.speed_m_s[-1] * period / step  # a hundredth: downhill it runs a little faster
    reach = math.floor(most_quanta) + 2
    position = 0.5 * v**2 / grid.energy_m2_s2[1]
    cell = np.minimum(position.astype(int), len(grid.energy_m2_s2) - 2)
    share = position - cell
    entry = np.zeros((reach, len(grid.energy_m2_s2)))
    far = v * period / step
    for r in range(reach):
        weight = (hat_integral(far - r) - hat_integral(-r * np.ones_like(far))) / far
        np.add.at(entry[r], cell, weight * (1.0 - share) / count)
        np.add.at(entry[r], cell + 1, weight * share / count)
    return entry


def hat_integral(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """∫ from −1 to x of the hat function max(0, 1 − |t|)."""
    x = np.clip(x, -1.0, 1.0)
    return np.where(x < 0, 0.5 * (1 + x) ** 2, 1.0 - 0.5 * (1 - x) ** 2)
