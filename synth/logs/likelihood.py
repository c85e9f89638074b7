"""How likely measured passes are with given numbers of the position: by the innovations of the filter.

Motion is as the filter takes it: what grade, resistance and brake do from row to row, from `plant_models.motion`,
exactly averaged over path. The logged path is linear in time between two rows; where it was set anew within a pass, it
is the path that was set right (`path_resets`). Observations of a pass: each reading of the speed, each of the gauge,
and how much the sensor shows above path by time. Each has an innovation r with the variance S, and the logarithm of the
likelihood is −½ Σ (log 2πS + r²/S).
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from plant_models import Cut, Plant, path_coefficients
from plant_models.frozen_arrays import Bools, Floats, Ints, frozen_arrays
from plant_models.motion import braked_axles, mean_braked_axles, path_breaks_m
from plant_models.speed_sensor import measured_speed_std
from synth.kernels.measured.drive_rows import Commands, drive_rows
from synth.kernels.measured.pass_filter import BySpeed, Cuts, Rows, Spread, filter_passes
from synth.logs import unknowns as asked
from synth.logs.fitting_passes import OPEN_BAND_KPA, FittingPasses
from tuning_tables.pass_log.pass_log import path_resets_m, path_set_right_m

PART_S = 0.025
"""Longest part of the time between two rows over which a pressure counts by its mean."""


@frozen_arrays
class PassRows:
    """n rows of m passes. From each row to the next, 0 from the last row of a pass:

    `step_m`, `gained_m2_s2` (n,): path, and ΔG by the grade; `drag_m2_s2_per_n_kn` (n,): ΔR;
    `brake_m2_s2_per_kpa` (n, parts): ∫β ds of each part of the time; `by_axles_m2_s2_per_kpa` (n, parts): the same of
    β (N − N̄), what a force slope that depends on the number N of braked wheel pairs adds; `mean_axles`: N̄ of the log.
    `show_m_s` (m,): mean measured speed less path by time, NaN where no path tells it.
    """

    step_m: Floats
    gained_m2_s2: Floats
    drag_m2_s2_per_n_kn: Floats
    brake_m2_s2_per_kpa: Floats
    by_axles_m2_s2_per_kpa: Floats
    mean_axles: float
    show_m_s: Floats


def pass_rows(passes: FittingPasses) -> PassRows:
    """What the filter needs of `passes`, at the numbers of their plants."""
    log = passes.log
    n, inner = len(log.time_s), np.ones(len(log.time_s), dtype=bool)
    inner[log.first_row[1:] - 1] = False
    following = np.minimum(np.arange(n) + 1, n - 1)
    step_s = np.where(inner, log.time_s[following] - log.time_s, 0.0)
    reset_m = path_resets_m(log.time_s, log.path_m, log.speed_m_s, log.first_row)
    path_m = path_set_right_m(log.path_m, reset_m, log.first_row)
    step_m = np.where(inner, path_m[following] - path_m, 0.0)
    parts = max(1, math.ceil(float(np.median(step_s[inner])) / PART_S - 1e-9))
    mean_axles = float(np.mean([mean_braked_axles(plant.position, plant.cut) for _, plant in passes.plants]))
    gained, drag = np.zeros(n), np.zeros(n)
    brake, by_axles = np.zeros((n, parts)), np.zeros((n, parts))
    shares = np.arange(parts + 1) / parts
    class_of_row = np.repeat(passes.class_of, np.diff(log.first_row))
    cuts = [passes.cut(number) for number in range(len(log))]
    for number, (_, plant) in enumerate(passes.plants):
        rows = np.flatnonzero((class_of_row == number) & inner)
        if len(rows) == 0:
            continue
        at = path_m[rows, None] + step_m[rows, None] * shares
        way = way_of(plant, float(at.min()), mean_axles)
        gravity, force = scales(plant, passes, cuts)
        gravity_of, force_of = (x[log.pass_of_row[rows]] for x in (gravity, force))
        edges, ground, braked, braked_by_axles = way
        gained[rows] = gravity_of * np.diff(on(edges, ground, at[:, [0, -1]]), axis=1)[:, 0]
        drag[rows] = gravity_of * plant.cut.reduced_gravity_m_s2 * 1e-3 * step_m[rows]
        brake[rows] = force_of[:, None] * np.diff(np.interp(at, edges, braked), axis=1)
        by_axles[rows] = force_of[:, None] * np.diff(np.interp(at, edges, braked_by_axles), axis=1)
    return PassRows(
        step_m,
        gained,
        drag,
        brake,
        by_axles,
        mean_axles,
        shown_m_s(passes, step_s, np.where(right_steps(reset_m, log.first_row), step_m, np.nan)),
    )


def way_of(plant: Plant, from_m: float, mean_axles: float) -> tuple[Floats, Floats, Floats, Floats]:
    """Edges of the path of a class from `from_m` to the exit, and at them ∫gravity, ∫β, ∫β (N − N̄) ds."""
    start = math.floor(min(from_m, 0.0)) - 1.0
    edges = path_breaks_m(plant.position, plant.cut, plant.profile, start)
    cells = path_coefficients(plant.position, plant.cut, plant.profile, edges)
    length = np.diff(edges)
    axles = braked_axles(plant.position, plant.cut, 0.5 * (edges[1:] + edges[:-1]))
    columns = (cells.gravity_m_s2, cells.brake_m_s2_per_kpa, cells.brake_m_s2_per_kpa * (axles - mean_axles))
    ground, brake, by_axles = (np.concatenate(([0.0], np.cumsum(column * length))) for column in columns)
    return edges, ground, brake, by_axles


def scales(plant: Plant, passes: FittingPasses, cuts: list[Cut]) -> tuple[Floats, Floats]:
    """Gravity and brake of each cut over those of its class, (m,): its mass enters force law and inertia only."""
    base, force = plant.cut, plant.position.force
    gravity = np.array([cut.reduced_gravity_m_s2 for cut in cuts]) / base.reduced_gravity_m_s2
    slope = np.array([force.slope_kn_per_kpa(cut, 1) / cut.inertia_t for cut in cuts])
    return gravity, slope / (force.slope_kn_per_kpa(base, 1) / base.inertia_t)


def on(edges: Floats, values: Floats, at: Floats) -> Floats:
    """`values` at `at`; beyond the last edge they go on as before it."""
    slope = (values[-1] - values[-2]) / (edges[-1] - edges[-2])
    return np.asarray(np.interp(at, edges, values) + slope * np.maximum(at - edges[-1], 0.0))


def right_steps(reset_m: Floats, first_row: Ints) -> Bools:
    """From each row to the next, whether the path is known to count right, (n,): in a pass without a correction
    everywhere; in others between the first and the last one, for ahead of them it is off by the correction."""
    right = np.ones(len(reset_m), dtype=np.bool_)
    rows = np.flatnonzero(reset_m)
    passes = np.searchsorted(first_row, rows, side="right") - 1
    for number in np.unique(passes).tolist():
        of_pass = rows[passes == number]
        right[first_row[number] : first_row[number + 1]] = False
        right[of_pass[0] : of_pass[-1]] = True
    return right


def shown_m_s(passes: FittingPasses, step_s: Floats, step_m: Floats) -> Floats:
    """How much more than path by time the sensor showed on the mean of each pass; NaN in `step_m` is left out."""
    log = passes.log
    if not log.path_is_independent:
        return np.full(len(log), np.nan)
    following = np.minimum(np.arange(len(step_s)) + 1, len(step_s) - 1)
    seen = 0.5 * (log.speed_m_s + log.speed_m_s[following]) * step_s - step_m
    known = np.isfinite(seen)
    begins = log.first_row[:-1]
    time = np.add.reduceat(np.where(known, step_s, 0.0), begins)
    return np.add.reduceat(np.where(known, seen, 0.0), begins) / np.where(time > 0.0, time, np.nan)


USUAL_KPA = 300.0
"""Where a force that is not straight in the pressure is that of the model."""


@frozen_arrays
class Innovations:
    """k observations of m passes: `innovation`, `variance` (k,) and `pass_of` (k,).

    The first `readings` of them are of the sensor; then come `gauged` of the gauge; each row by row. `cuts`: what is
    known of the cuts in the end; `pressure_kpa` (n,) by the numbers given.
    """

    innovation: Floats
    variance: Floats
    pass_of: Ints
    readings: int
    gauged: int
    cuts: Cuts
    pressure_kpa: Floats

    def log_likelihood(self, passes: int) -> Floats:
        """Of each pass, (m,)."""
        terms = np.log(2.0 * np.pi * self.variance) + self.innovation**2 / self.variance
        return np.asarray(-0.5 * np.bincount(self.pass_of, terms, passes))


@dataclass(frozen=True, eq=False)
class Likelihood:
    """Of `passes`, at any numbers; build it with `likelihood_of`."""

    passes: FittingPasses
    rows: PassRows
    commands: Commands
    slope_key: str

    def pressures(self, values: Mapping[str, float]) -> tuple[Floats, Floats]:
        """Mean overpressure of each part of the time between rows (n, parts), and pressure at each row (n,)."""
        pneumatics = self.passes.plant.position.pneumatics
        drive = pneumatics.valves(values[asked.TOUCH_PRESSURE])._replace(
            brake_delay_s=values[asked.BRAKE_DELAY],
            touch_delay_s=values[asked.TOUCH_DELAY],
            release_delay_s=values[asked.RELEASE_DELAY],
            fill_s=values[asked.FILL],
            exhaust_s=values[asked.EXHAUST],
            band_kpa=values[asked.DEAD_BAND],
        )
        released = drive._replace(band_kpa=OPEN_BAND_KPA) if self.passes.released_vents else drive
        over, kpa = np.empty_like(self.rows.brake_m2_s2_per_kpa), np.empty(len(self.rows.step_m))
        drive_rows(self.commands, drive, released, 0, len(self.passes), over, kpa)
        return over, kpa

    def at(self, values: Mapping[str, float], pressures: tuple[Floats, Floats] | None = None) -> Innovations:
        """With the numbers `values`; `pressures` where they are known from other numbers with the same valves."""
        over, kpa = self.pressures(values) if pressures is None else pressures
        log, rows = self.passes.log, self.rows
        force = self.passes.plant.position.force
        bend = values.get(asked.FORCE_BY_PRESSURE, 0.0)
        pressing = over if bend == 0.0 else over * (1.0 + bend * (over / USUAL_KPA - 1.0))
        by_speed = BySpeed(values.get(asked.FRICTION_BY_SPEED, 0.0), values.get(asked.RESISTANCE_BY_SPEED, 0.0))
        brake = rows.brake_m2_s2_per_kpa + values[asked.SLOPE_BY_AXLES] * rows.by_axles_m2_s2_per_kpa
        configured = getattr(force, self.slope_field)
        braked = values[self.slope_key] / configured * np.einsum("ij,ij->i", brake, pressing)
        spread = self.spread(values)
        n, m = len(log.time_s), len(log)
        innovation, variance = np.empty(n), np.empty(n)
        cuts = Cuts(*(np.empty(m) for _ in Cuts._fields))
        filter_passes(
            Rows(log.speed_m_s, rows.step_m, rows.gained_m2_s2, rows.drag_m2_s2_per_n_kn, braked), spread,
            by_speed, log.first_row, 0, m, innovation, variance, cuts,
        )  # fmt: skip
        return self.observed(values, innovation, variance, cuts, kpa)

    @property
    def slope_field(self) -> str:
        """The field of the force law behind the key of the slope."""
        name = self.slope_key.rpartition(".")[2]
        return "slope_kn_per_kpa_per_pair" if name == "slope_kn_per_kpa" else name

    def spread(self, values: Mapping[str, float]) -> Spread:
        """What differs from cut to cut."""
        passes = self.passes
        plants = [plant for _, plant in passes.plants]
        axle_cv = np.array([p.friction_cv**2 - p.friction.common_cv**2 for p in plants])
        mean = np.array([values.get(asked.RESISTANCE + p.cut.category, p.resistance.mean_n_per_kn) for p in plants])
        std = np.array([p.resistance.std_n_per_kn for p in plants]) * values.get(asked.RESISTANCE_SPREAD, 1.0)
        return Spread(
            np.sqrt(values[asked.COMMON_CV] ** 2 + axle_cv)[passes.class_of],
            mean[passes.class_of],
            std[passes.class_of],
            values[asked.PATH_STD],
            values[asked.CORRELATION_LENGTH],
            measured_speed_std(values[asked.NOISE], passes.plant.sensor.resolution_m_s),
            values.get(asked.BIAS, 0.0),
        )

    def observed(
        self, values: Mapping[str, float], innovation: Floats, variance: Floats, cuts: Cuts, kpa: Floats
    ) -> Innovations:
        """All observations beside one another; those that were not made are left out."""
        log = self.passes.log
        seen = np.isfinite(innovation)
        columns = [(innovation[seen], variance[seen], log.pass_of_row[seen])]
        gauged = 0
        if asked.GAUGE_NOISE in values:
            read = np.isfinite(log.pressure_kpa)
            gauged = int(read.sum())
            noise = np.full(gauged, values[asked.GAUGE_NOISE] ** 2)
            columns.append((log.pressure_kpa[read] - kpa[read], noise, log.pass_of_row[read]))
        if asked.BIAS in values:
            shown = np.flatnonzero(np.isfinite(self.rows.show_m_s))
            counted = np.bincount(log.pass_of_row[np.isfinite(log.speed_m_s)], minlength=len(log))[shown]
            std = measured_speed_std(values[asked.NOISE], self.passes.plant.sensor.resolution_m_s)
            columns.append((self.rows.show_m_s[shown] - values[asked.BIAS], std**2 / counted, shown))
        joined = [np.concatenate(column) for column in zip(*columns, strict=True)]
        return Innovations(joined[0], joined[1], joined[2], int(seen.sum()), gauged, cuts, kpa)


def likelihood_of(passes: FittingPasses, slope_key: str, settled: bool = False) -> Likelihood:
    """The likelihood of `passes`; `slope_key` names the force slope.

    `settled`: every command is taken to have found the drive at rest. So it is in the log of a regulator that waits for
    that; but far from the true numbers the drive would still be under way, go on without its delay, and the likelihood
    would have a second summit there.
    """
    log, plant = passes.log, passes.plant
    commands = Commands(
        log.time_s,
        log.stage,
        log.first_row,
        plant.approach.initial_stage,
        np.asarray(plant.position.stage_pressures_kpa, dtype=np.float64),
        plant.sensor.computing_delay_s,
        settled,
    )
    return Likelihood(passes, pass_rows(passes), commands, slope_key)
