"""Solve and evaluate problems in which a command may be given at every sample."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plant_models import Plant, path_coefficients
from plant_models.frozen_arrays import frozen_arrays
from synth.problem.criterion import Criterion
from synth.problem.resolution import Resolution
from synth.solver.backward_induction import TIE_M2_S2, true_speed_weights
from synth.solver.chain.entry import entry_distribution
from synth.solver.chain.grid import Grid, make_grid
from synth.solver.chain.landings import FINE_CELLS_PER_QUANTUM
from synth.solver.chain.path_noise import PathNoise, correlated_noise
from synth.solver.chain.scenarios import Scenarios, persistent_scenarios
from synth.studies.unlocked.drive_modes import DriveModes, drive_modes
from synth.studies.unlocked.kernels.unlocked_bellman import unlocked_sweep
from synth.studies.unlocked.surfaces import SwitchingSurfaces

PRESSURE_STEP_KPA = 15.0

DEFAULT_RESOLUTION = Resolution(path_step_m=0.25, speed_step_m_s=0.02)
"""Samples, not transients, are the steps: they want a finer grid than `Resolution`'s own default."""


@frozen_arrays
@dataclass(frozen=True, eq=False)
class UnlockedPlant:
    """One plant on one grid: everything that a sweep needs and that depends on neither policy nor target.

    `lift_m2_s2`, `work_m2_s2_per_kpa` (W + 1,): ∫ of the acceleration without brakes and of β over the path, at equal
    steps; `level_steps` (A + 1, L, L): transition of η over 0 … A quanta; `entry` (R, E): probability of entry energy j
    with the first sample at node r.
    """

    plant: Plant
    grid: Grid
    modes: DriveModes
    chain: PathNoise
    scenarios: Scenarios
    lift_m2_s2: NDArray[np.float64]
    work_m2_s2_per_kpa: NDArray[np.float64]
    level_steps: NDArray[np.float64]
    entry: NDArray[np.float64]


@dataclass(frozen=True)
class UnlockedSolution:
    """Surfaces of the common policy, and `cost_m2_s2`: what the sweep expects a pass to cost under it.

    The cost is that of the criterion: squared error, stalls, and the tolerance for every command.
    """

    surfaces: SwitchingSurfaces
    cost_m2_s2: float


def unlocked_plant(
    plant: Plant, resolution: Resolution = DEFAULT_RESOLUTION, pressure_step_kpa: float = PRESSURE_STEP_KPA
) -> UnlockedPlant:
    """`plant` on a grid; raises `PlantError` for drives that cannot be commanded during a transient."""
    grid = make_grid(plant, resolution)
    chain = correlated_noise(plant.friction, grid.path_step_m, resolution.path_levels)
    fine = np.linspace(plant.start_m, plant.exit_m, FINE_CELLS_PER_QUANTUM * (len(grid.path_m) - 1) + 1)
    cells = path_coefficients(plant.position, plant.cut, plant.profile, fine)
    free = cells.free_m_s2(plant.resistance.mean_n_per_kn)
    entry = entry_distribution(plant, grid)
    ahead = math.ceil(grid.speed_m_s[-1] * plant.sensor.sample_period_s / grid.path_step_m) + 2
    reach = max(ahead, len(entry) - 1)
    return UnlockedPlant(
        plant=plant,
        grid=grid,
        modes=drive_modes(plant, pressure_step_kpa, resolution.transient_substeps),
        chain=chain,
        scenarios=persistent_scenarios(plant, resolution.friction_nodes, resolution.resistance_nodes),
        lift_m2_s2=np.append(0.0, np.cumsum(free * np.diff(fine))),
        work_m2_s2_per_kpa=np.append(0.0, np.cumsum(cells.brake_m_s2_per_kpa * np.diff(fine))),
        level_steps=np.array([np.linalg.matrix_power(chain.transition, r) for r in range(reach + 1)]),
        entry=entry,
    )


def only_at_rest(prepared: UnlockedPlant) -> UnlockedPlant:
    """The same plant with commands at rest only: the stage-locked policies among the unlocked ones."""
    m = prepared.modes
    allowed = m.allowed & m.rests[:, None]
    allowed[:, 1] = True
    return replace(prepared, modes=replace(m, allowed=allowed))


def solve_unlocked(prepared: UnlockedPlant, target_speed_m_s: float, criterion: Criterion) -> UnlockedSolution:
    """Surfaces of the common policy for one target speed."""
    shape = (len(prepared.grid.path_m) - 1, len(prepared.modes.stage))
    lower, upper = np.empty(shape), np.empty(shape)
    cost = swept(prepared, target_speed_m_s, criterion, lower, upper, extract=True)
    lower, upper = np.vstack([lower, lower[-1:]]).T.copy(), np.vstack([upper, upper[-1:]]).T.copy()
    return UnlockedSolution(SwitchingSurfaces(prepared.modes, prepared.grid.path_m, lower, upper), cost)


def evaluate_unlocked(
    prepared: UnlockedPlant, surfaces: SwitchingSurfaces, target_speed_m_s: float, criterion: Criterion
) -> float:
    """Expected cost of given surfaces, which are on the modes and path nodes of `prepared`; nothing is sampled."""
    if not np.array_equal(surfaces.nodes_m, prepared.grid.path_m):
        raise ValueError("unlocked: the surfaces are not on the path nodes of this grid")
    lower, upper = (np.ascontiguousarray(lines[:, :-1].T) for lines in (surfaces.lower_m_s, surfaces.upper_m_s))
    return swept(prepared, target_speed_m_s, criterion, lower, upper, extract=False)


def swept(
    p: UnlockedPlant,
    target_speed_m_s: float,
    criterion: Criterion,
    lower: NDArray[np.float64],
    upper: NDArray[np.float64],
    extract: bool,
) -> float:
    """Run the sweep; `lower`, `upper` (N, M) are filled if `extract`; the expected cost of a pass."""
    t, m, sensor = p.grid, p.modes, p.plant.sensor
    terminal, stalled = criterion.exit_costs(t.speed_m_s, target_speed_m_s)
    noise = sensor.reading_std_m_s
    first = np.empty((len(p.level_steps), len(p.scenarios.weight), len(p.chain.levels), len(t.speed_m_s)))
    arguments: tuple[Any, ...] = (
        terminal, stalled, criterion.switching_tolerance_m2_s2, TIE_M2_S2,
        noise, *true_speed_weights(t.speed_m_s, t.speed_m_s, noise), p.scenarios.weight, p.chain.stationary,
        t.speed_m_s, m.allowed, m.target, m.weight, m.overpressure_kpa, m.end_overpressure_kpa,
        p.chain.levels, p.level_steps, p.scenarios.factor, p.scenarios.extra_m_s2,
        p.lift_m2_s2, p.work_m2_s2_per_kpa, FINE_CELLS_PER_QUANTUM / t.path_step_m, t.path_step_m,
        t.energy_step_m2_s2, sensor.sample_period_s / m.overpressure_kpa.shape[2], extract, lower, upper, first,
    )  # fmt: skip
    unlocked_sweep(*arguments)
    return entry_cost(p, first)


def entry_cost(p: UnlockedPlant, first: NDArray[np.float64]) -> float:
    """Expected cost over entry speed, phase of the samples, scenario and level; released cuts roll to the sample."""
    energy, total = p.grid.energy_m2_s2, 0.0
    value = np.einsum("rilj,i,l->rij", first, p.scenarios.weight, p.chain.stationary)
    for r, row in enumerate(p.entry):
        lift = p.lift_m2_s2[FINE_CELLS_PER_QUANTUM * r]
        for i, extra in enumerate(p.scenarios.extra_m_s2):
            rolled = energy + lift + extra * r * p.grid.path_step_m
            total += float(row @ np.interp(rolled, energy, value[r, i]))
    return total
