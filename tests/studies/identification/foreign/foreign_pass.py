"""One pass of the foreign plant under a controller table: sampled, delayed, locked while the drive is at work."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from plant_models.frozen_arrays import frozen_arrays
from tests.studies.identification.foreign.foreign_draws import LONGEST_PASS_S, ForeignDraw
from tests.studies.identification.foreign.foreign_motion import (
    CYLINDER,
    GAUGE,
    GONE,
    LINE,
    MODE,
    MOVING,
    PATH,
    SHUT,
    SPEED,
    STAGE_KPA,
    Laws,
    advance,
    laws_of,
)
from tests.studies.identification.foreign.foreign_plant import ForeignPlant
from tuning_tables import ControllerTable
from tuning_tables import estimator as memory
from tuning_tables.rule import decide_for, speed_for

Floats = NDArray[np.float64]

STEP_S = 0.005
"""Of the integration; halving it moves an exit speed by less than 1e-6 m/s (test_foreign_motion)."""

COLUMNS = ("time_s", "path_m", "speed_m_s", "pressure_kpa", "stage", "true_speed_m_s")


@frozen_arrays
@dataclass(frozen=True, eq=False)
class ForeignPass:
    """One pass; rows (n,), one a sample, the last one before the end.

    `time_s` since the first sample; `path_m`, `speed_m_s`, `pressure_kpa` as measured; `stage` commanded from the row
    on; `true_speed_m_s`. `exit_speed_m_s`: true, when the last axle leaves the last retarder, 0 where the cut `stalled`
    (stands, or creeps for longer than LONGEST_PASS_S); `end_s`: then.
    """

    time_s: Floats
    path_m: Floats
    speed_m_s: Floats
    pressure_kpa: Floats
    stage: NDArray[np.int64]
    true_speed_m_s: Floats
    exit_speed_m_s: float
    stalled: bool
    switchings: int
    end_s: float


@dataclass
class PlantInMotion:
    """The plant while a pass lasts: its state and its valve change in place."""

    laws: Laws
    step_s: float
    y: Floats
    valve: Floats = field(default_factory=lambda: np.zeros(5))

    def command(self, pressure_kpa: float) -> None:
        """Set the pressure regulator."""
        self.valve[STAGE_KPA] = pressure_kpa

    @property
    def is_locked(self) -> bool:
        """Whether the drive is still at work, so that no command is taken."""
        return bool(self.valve[MODE] != SHUT)

    def roll(self, duration_s: float) -> tuple[int, float]:
        """Go on for `duration_s`; returns (MOVING, GONE or STANDING, time used)."""
        status, used = advance(self.y, self.valve, self.laws, duration_s, self.step_s)
        return int(status), float(used)


@dataclass
class Controller:
    """What stands beside the track: it asks `table` at a sample, on its own path range, while nothing is under way."""

    table: ControllerTable
    stage: int = 0
    last_gauge_kpa: float = 0.0
    state: Any = field(default_factory=memory.begin)

    def wanted(self, s_m: float, v_m_s: float, gauge_kpa: float, is_locked: bool) -> int:
        """The stage to command at this sample; the estimator of the table, if any, sees every sample."""
        table = self.table
        start = 0.0 if table.approach is None else -table.approach.length_m
        overpressure = 0.0
        if table.estimator is not None:
            touch = table.estimator.touch_pressure_kpa
            overpressure = 0.5 * (max(0.0, gauge_kpa - touch) + max(0.0, self.last_gauge_kpa - touch))
        self.last_gauge_kpa = gauge_kpa
        if s_m < start:
            return self.stage
        speed = speed_for(table, self.state, s_m, v_m_s, overpressure)
        return self.stage if is_locked else decide_for(table, self.stage, s_m, speed)


def plant_at_rest(plant: ForeignPlant, draw: ForeignDraw, step_s: float = STEP_S) -> PlantInMotion:
    """The cut where the radar first sees it, the brake empty, the supply line full."""
    laws = laws_of(plant, draw)
    begin = [plant.track.seen_from_m, draw.entry_m_s, laws.atmosphere_kpa, laws.main_kpa, 0.0, 0.0]
    return PlantInMotion(laws, step_s, np.array(begin))


def foreign_pass(table: ControllerTable, plant: ForeignPlant, draw: ForeignDraw, step_s: float = STEP_S) -> ForeignPass:
    """The pass `draw` of `plant` under `table`. Raises `ValueError` where the table has other stages or sees farther.

    A command is decided at a sample and reaches the drive `computing_delay_s` later; until the drive rests again no
    other is decided.
    """
    _require_fit(table, plant)
    sensor, moving, controller = plant.sensor, plant_at_rest(plant, draw, step_s), Controller(table)
    rows: list[tuple[float, ...]] = []
    status, time = moving.roll(draw.first_sample_s)
    switchings = 0
    while status == MOVING and len(rows) * sensor.period_s < LONGEST_PASS_S:
        s_m, v_m_s, gauge_kpa = readings(moving.y, plant, draw, len(rows))
        wanted = controller.wanted(s_m, v_m_s, gauge_kpa, moving.is_locked)
        switchings += wanted != controller.stage
        controller.stage = wanted
        shown = gauge_kpa if sensor.has_gauge else math.nan
        rows.append((len(rows) * sensor.period_s, s_m, v_m_s, shown, wanted, moving.y[SPEED]))
        status, time = moving.roll(sensor.computing_delay_s)
        moving.command(plant.stage_pressures_kpa[wanted])
        if status == MOVING:
            status, used = moving.roll(sensor.period_s - sensor.computing_delay_s)
            time += used
    columns = dict(zip(COLUMNS, np.array(rows).reshape(-1, len(COLUMNS)).T.copy(), strict=True))
    stage = columns.pop("stage").astype(np.int64)
    left = status == GONE
    exit_speed = float(moving.y[SPEED]) if left else 0.0
    return ForeignPass(
        **columns, stage=stage, exit_speed_m_s=exit_speed, stalled=not left, switchings=switchings,
        end_s=(len(rows) - 1) * sensor.period_s + time,
    )  # fmt: skip


def readings(y: Floats, plant: ForeignPlant, draw: ForeignDraw, sample: int) -> tuple[float, float, float]:
    """(path, speed, gauge) as measured at this sample; the radar knows no sign."""
    sensor = plant.sensor
    speed = y[SPEED] + sensor.noise_m_s * draw.radar_z[sample]
    if sensor.resolution_m_s > 0.0:
        speed = sensor.resolution_m_s * round(speed / sensor.resolution_m_s)
    path = y[PATH] + sensor.path_noise_m * draw.path_z[sample]
    return float(path), abs(float(speed)), float(y[GAUGE] + sensor.gauge_noise_kpa * draw.gauge_z[sample])


def pressure_after_command(
    plant: ForeignPlant, draw: ForeignDraw, start_kpa: float, stage: int, times_s: Floats
) -> Floats:
    """True pressure in the cylinder, kPa gauge, (n,), at `times_s` after the drive was set to `stage` at `start_kpa`.

    The times must rise. The cut stands still far outside meanwhile, so nothing else happens.
    """
    moving = plant_at_rest(plant, draw)
    moving.y[[PATH, SPEED]] = -1e9, 1e-3
    moving.y[CYLINDER] += start_kpa
    moving.y[LINE] = moving.laws.main_kpa
    moving.command(plant.stage_pressures_kpa[stage])
    found, now = [], 0.0
    for time in times_s:
        moving.roll(float(time) - now)
        found.append(moving.y[CYLINDER] - moving.laws.atmosphere_kpa)
        now = float(time)
    return np.array(found)


def _require_fit(table: ControllerTable, plant: ForeignPlant) -> None:
    if len(table.stages) != len(plant.stage_pressures_kpa):
        raise ValueError(f"the table has {len(table.stages)} stages, the plant {len(plant.stage_pressures_kpa)}.")
    if table.approach is not None and -table.approach.length_m < plant.track.seen_from_m:
        raise ValueError(f"the table's approach is {table.approach.length_m:g} m; the radar sees less far.")
