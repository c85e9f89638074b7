"""How likely measured passes are with given numbers of the position: by the innovations of the filter.

Observations of a pass: each reading of the speed, each of the gauge, and how much the sensor shows above path by time.
Each has an innovation r with the variance S, and the logarithm of the likelihood is −½ Σ (log 2πS + r²/S).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from plant_models.frozen_arrays import Floats, Ints, frozen_arrays
from plant_models.speed_sensor import measured_speed_std
from synth.kernels.measured.drive_rows import Commands, drive_rows
from synth.kernels.measured.pass_filter import BySpeed, Cuts, Rows, Spread, filter_passes
from synth.logs import unknowns as asked
from synth.logs.fitting_passes import FittingPasses
from synth.logs.pass_rows import PassRows, pass_rows
from synth.logs.released_drive import OPEN_BAND_KPA

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
