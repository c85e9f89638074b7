"""A plant whose regulator may give a command at every sample, as a Markov chain on a grid; and the error of an
estimated speed along the path: what the hidden constants of a pass shift, and noise about it.

An estimator does not learn the running resistance, and learns the friction by and by. Both enter its error and the
motion alike, so they are no noise that the next sample takes away: each scenario has its own shift.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from plant_models import Plant, path_coefficients
from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from synth.kernels.any_time.period import NEAREST, ROOM
from synth.kernels.any_time.sampled_arrays import Entry, Motion, Periods, SampledArrays
from synth.kernels.sweep.chain_arrays import PathNoise
from synth.problem.resolution import Resolution, finer_for_check
from synth.solver.any_time.drive_modes import DriveModes, drive_modes
from synth.solver.chain.chain import NODE_AT_ENTRANCE_M
from synth.solver.chain.grid import Grid, make_grid
from synth.solver.chain.sampling import entry_distribution
from synth.solver.chain.scenarios import Scenarios, check_scenarios, correlated_noise, persistent_scenarios
from synth.solver.chain.speed_measurement import SpeedMeasurement, quantised_measurement, smooth_measurement

LEAST_OBSERVATIONS = 50
"""A section of the path with fewer has the figures of the whole path."""

Observed = Floats
"""Rows of path, error, ξ_cut − 1, acceleration by w − E w, weight: (n, 5)."""


@frozen_arrays
class EstimateError:
    """Of an estimated speed at `path_m` (R,), linear in between: its noise and its shifts.

    `std_m_s` (R,) of the noise, taken as white; `per_friction` (R,) m/s of shift per 1 of ξ_cut − 1;
    `per_acceleration_s` (R,) m/s of shift per m/s² that the running resistance adds to the acceleration.
    """

    path_m: Floats
    std_m_s: Floats
    per_friction: Floats
    per_acceleration_s: Floats

    def noise_m_s(self, path_m: Floats) -> Floats:
        """Standard deviation of the noise at places of the path."""
        return np.interp(path_m, self.path_m, self.std_m_s)

    def shift_m_s(self, path_m: Floats, scenarios: Scenarios, i: int) -> Floats:
        """Mean of estimated minus true speed in scenario `i`."""
        by_friction = np.interp(path_m, self.path_m, self.per_friction) * (scenarios.factor[i] - 1.0)
        by_resistance = np.interp(path_m, self.path_m, self.per_acceleration_s) * scenarios.extra_m_s2[i]
        return np.asarray(by_friction + by_resistance)


def error_along_path(observed: Observed, edges_m: Floats, least_std_m_s: float) -> EstimateError:
    """Fit of `observed`, in each section between `edges_m` (R + 1,) for itself.

    No noise is smaller than `least_std_m_s`: what is left of an error is not white, and a smaller one would ask for a
    finer grid.
    """
    section = np.searchsorted(edges_m, observed[:, 0], side="right") - 1
    found = []
    for number in range(len(edges_m) - 1):
        here = observed[section == number]
        found.append(shifts_and_std(here if len(here) >= LEAST_OBSERVATIONS else observed))
    per_friction, per_acceleration, std = np.array(found).T
    middle = 0.5 * (edges_m[1:] + edges_m[:-1])
    return EstimateError(middle, np.maximum(std, least_std_m_s), per_friction, per_acceleration)


def shifts_and_std(observed: Observed) -> tuple[float, float, float]:
    """Weighted least squares without a constant: (per friction, per acceleration, rms of what is left)."""
    root = np.sqrt(observed[:, 4])
    hidden, error = observed[:, 2:4] * root[:, None], observed[:, 1] * root
    shifts = np.linalg.lstsq(hidden, error, rcond=None)[0]
    left = float(np.sqrt(((error - hidden @ shifts) ** 2).sum() / observed[:, 4].sum()))
    return float(shifts[0]), float(shifts[1]), left


PRESSURE_STEP_KPA = 30.0
"""Largest distance of pressures at which the drive is valued; between them a cubic."""


@frozen_arrays
class SampledChain:
    """One plant on one grid: all but policy and aim.

    `drive_m2_s2`, `brake_m2_s2_per_kpa` (N + 1,): integrals over the path, up to each node, of the acceleration without
    brakes and of what one kPa takes away. `noise`: of the path over a period at the reference speed; `mixing`
    (L, L, E') its transition over the path of a period at each speed. `entry` (A, E): probability of entry energy j
    with the first sample at node r; `entry_mode` the mode until then. `first_energy` (R + 2,): first speed whose period
    ends nearest to each number of quanta. `estimate`: the error of the speed that the regulator knows, where it is an
    estimated one; else that of `measurement` counts.
    """

    plant: Plant
    resolution: Resolution
    grid: Grid
    modes: DriveModes
    periods: Periods
    measurement: SpeedMeasurement
    scenarios: Scenarios
    noise: PathNoise
    mixing: Floats
    drive_m2_s2: Floats
    brake_m2_s2_per_kpa: Floats
    entry: Floats
    entry_mode: int
    first_energy: Ints
    estimate: EstimateError | None = None

    @property
    def approach_nodes(self) -> int:
        """Number of path nodes before the entrance."""
        return int(np.searchsorted(self.grid.path_m, -NODE_AT_ENTRANCE_M))

    @property
    def quanta_per_period(self) -> Floats:
        """Path of a period at every speed, in quanta, (E,)."""
        quanta: Floats = self.grid.speed_m_s * (self.plant.sensor.sample_period_s / self.grid.path_step_m)
        return quanta


def check_sampled_chain(plant: Plant, design: Resolution) -> SampledChain:
    """The chain that predicts finished surfaces: half of both steps, more scenarios, and the sensor's staircase."""
    finer = finer_for_check(design)
    chain = sampled_chain(plant, finer, quantised_measurement(plant.sensor))
    return replace(chain, scenarios=check_scenarios(plant, finer.friction_nodes, finer.resistance_nodes))


def sampled_chain(
    plant: Plant,
    resolution: Resolution,
    measurement: SpeedMeasurement | None = None,
    pressure_step_kpa: float = PRESSURE_STEP_KPA,
) -> SampledChain:
    """`plant` on a grid; `measurement` by default smooth. Raises `PlantError` for a computing delay beyond a period."""
    grid = make_grid(plant, resolution)
    modes = drive_modes(plant, pressure_step_kpa, 1)
    coefficients = path_coefficients(plant.position, plant.cut, plant.profile, grid.path_m)
    period_m = grid.speed_m_s * plant.sensor.sample_period_s
    usual_m = resolution.reference_speed_m_s * plant.sensor.sample_period_s
    levels = resolution.path_levels
    moved_m = np.pad(np.maximum(period_m, period_m[1]), (0, ROOM), mode="edge")
    middle = np.maximum(np.floor(period_m / grid.path_step_m + 0.5).astype(np.int64), NEAREST)
    entry_mode = at_rest_from_below(modes, plant.approach.initial_stage)
    return SampledChain(
        plant=plant,
        resolution=resolution,
        grid=grid,
        modes=modes,
        periods=different_periods(modes, entry_mode),
        measurement=smooth_measurement(plant.sensor) if measurement is None else measurement,
        scenarios=persistent_scenarios(plant, resolution.friction_nodes, resolution.resistance_nodes),
        noise=correlated_noise(plant.friction, usual_m, levels),
        mixing=np.stack([correlated_noise(plant.friction, each, levels).transition for each in moved_m], axis=2),
        drive_m2_s2=summed(coefficients.free_m_s2(plant.resistance.mean_n_per_kn) * np.diff(grid.path_m)),
        brake_m2_s2_per_kpa=summed(coefficients.brake_m_s2_per_kpa * np.diff(grid.path_m)),
        entry=entry_distribution(plant, grid),
        entry_mode=entry_mode,
        first_energy=np.searchsorted(middle, np.arange(int(middle[-1]) + 2)),
    )


def at_rest_from_below(modes: DriveModes, stage: int) -> int:
    """The mode in which `stage` rests after it was reached from below."""
    resting = np.flatnonzero(modes.rests & (modes.stage == stage))
    return int(resting[np.argmin(modes.pressure_kpa[resting])])


def different_periods(modes: DriveModes, entry_mode: int) -> Periods:
    """The periods after all commands in all modes, each kept once."""
    periods: dict[tuple[float, int], int] = {}
    ways: dict[tuple[tuple[int, ...], tuple[float, ...]], int] = {}

    def way(target: Ints, share: Floats) -> int:
        key = tuple(target.tolist()), tuple(np.round(share, 12).tolist())
        return ways.setdefault(key, len(ways))

    of_mode = np.full(modes.allowed.shape, -1)
    for mode, command in np.argwhere(modes.allowed):
        to = way(modes.target[mode, command], modes.weight[mode, command])
        mean = round(float(modes.overpressure_kpa[mode, command].mean()), 9)
        of_mode[mode, command] = periods.setdefault((mean, to), len(periods))
    entry = (entry_mode,) * 4, (1.0, 0.0, 0.0, 0.0)
    target, share = zip(*ways, entry, strict=True)
    kpa, leads = zip(*periods, strict=True)
    return Periods(of_mode, np.array(kpa), np.array(leads), np.array(target), np.array(share))


def summed(per_quantum: Floats) -> Floats:
    """Sums up to every node."""
    return np.append(0.0, np.cumsum(per_quantum))


def sampled_arrays(c: SampledChain) -> SampledArrays:
    """All but policy, scenarios and aim, as the kernels take it."""
    p, period_s, step = c.periods, c.plant.sensor.sample_period_s, c.grid.path_step_m
    motion = Motion(
        np.pad(c.quanta_per_period, (0, ROOM)), 0.5 * period_s**2 / step, step, c.grid.energy_step_m2_s2,
        c.first_energy, c.drive_m2_s2, c.brake_m2_s2_per_kpa,
    )  # fmt: skip
    entry = Entry(c.entry, len(p.target) - 1, float(p.kpa[p.of_mode[c.entry_mode, 1]]))
    return SampledArrays(p, entry, c.noise.stationary, c.mixing, motion)
