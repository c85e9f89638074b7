"""Rows of plain values that the study `point-sensors` finds."""

from __future__ import annotations

from dataclasses import dataclass

from scripts.studies.study import Findings
from synth.simulation.replicates import Interval


@dataclass(frozen=True)
class RadarRow:
    """The table of the radar at one site; `brake_saturated`: share of the cars that no table stops."""

    case: str
    predicted_m_s: float
    rms_m_s: float
    rms_ci95_m_s: Interval
    switchings: float
    stalled: float
    stalled_ci95: Interval
    overspeed: float
    overspeed_ci95: Interval
    brake_saturated: float


@dataclass(frozen=True)
class Told:
    """Predicted rms of a table, and of switching speeds made for each of `frictions` frictions; `regret`: the ratio.

    `table_better`: at how many frictions the table's speeds are no worse, and stand in the bound.
    """

    table_m_s: float
    told_m_s: float
    regret: float
    frictions: int
    table_better: int


@dataclass(frozen=True)
class SensorRow:
    """One layout of sensors; `axles` that are decided on: 'first' or 'every'; `layout`: 'planned', 'equal' or 'rule'.

    `places_m` with that behind the exit. `radar_ratio`: rms / rms of the radar's table, `equal_ratio`: / rms of equal
    sections, both paired. `unfinished`: share of the passages that find a change of stage unfinished.
    """

    case: str
    axles: str
    layout: str
    places_m: tuple[float, ...]
    predicted_m_s: float
    rms_m_s: float
    rms_ci95_m_s: Interval
    radar_ratio: float
    radar_ratio_ci95: Interval
    equal_ratio: tuple[float, Interval] | None
    told: Told | None
    unfinished: float
    unfinished_ci95: Interval
    switchings: float
    stalled: float
    stalled_ci95: Interval
    overspeed: float
    overspeed_ci95: Interval

    @property
    def sensors(self) -> int:
        """Number of sensors, with that behind the exit."""
        return len(self.places_m)

    @property
    def prediction_ratio(self) -> float:
        """Predicted rms / simulated rms."""
        return self.predicted_m_s / self.rms_m_s

    @property
    def prediction_ratio_ci95(self) -> Interval:
        """Its interval: that of the simulated rms."""
        low, high = self.rms_ci95_m_s
        return self.predicted_m_s / high, self.predicted_m_s / low

    @property
    def name(self) -> str:
        """'bunch, 22 t to 2 m/s, 6 sensors, first axle, planned'."""
        return f"{self.case}, {self.sensors} sensors, {self.axles} axle, {self.layout}"


@dataclass(frozen=True)
class FaultRow:
    """One fault in every pass; `ratio`: rms / rms of the same passes without fault, paired; `wide_ratio`: the same with
    limits of the tracker that believe anything."""

    case: str
    axles: str
    fault: str
    rms_m_s: float
    rms_ci95_m_s: Interval
    ratio: float
    ratio_ci95: Interval
    wide_ratio: float
    wide_ratio_ci95: Interval
    overspeed: float
    overspeed_ci95: Interval
    stalled: float
    stalled_ci95: Interval


@dataclass(frozen=True)
class ManyRow:
    """So many deciding sensors of one noise, whose passages lie `distance_m` apart on average, beside a radar.

    The radar has the same noise and decides as often, every `period_s`. `ratio`: rms / rms of the radar, paired.
    """

    noise: str
    deciding: int
    passages: int
    distance_m: float
    period_s: float
    predicted_m_s: float
    rms_m_s: float
    rms_ci95_m_s: Interval
    radar_rms_m_s: float
    radar_rms_ci95_m_s: Interval
    ratio: float
    ratio_ci95: Interval


@dataclass(frozen=True)
class GridRow:
    """One layout whose table was made on this grid."""

    case: str
    axles: str
    sensors: int
    path_step_m: float
    speed_step_m_s: float
    predicted_m_s: float
    rms_m_s: float
    rms_ci95_m_s: Interval

    @property
    def prediction_ratio(self) -> float:
        """Predicted rms / simulated rms."""
        return self.predicted_m_s / self.rms_m_s


@dataclass(frozen=True)
class MissedRow:
    """A planned layout whose design counts `missed_share` of the passages as not heard: without a fault, and with a
    dead sensor; `worst`: the one, from 0, whose death costs most; `most_stalled`: of cuts, whichever sensor is dead."""

    case: str
    axles: str
    sensors: int
    missed_share: float
    predicted_m_s: float
    rms_m_s: float
    rms_ci95_m_s: Interval
    worst: int
    dead_rms_m_s: float
    dead_rms_ci95_m_s: Interval
    most_stalled: float
    most_stalled_ci95: Interval


@dataclass(frozen=True)
class WorthRows(Findings):
    """All parts; `fault_passes`: those that faults were run on."""

    seed: int
    passes: int
    fault_passes: int
    path_step_m: float
    speed_step_m_s: float
    friction_nodes: int
    radar: tuple[RadarRow, ...]
    sensors: tuple[SensorRow, ...]
    faulty: tuple[FaultRow, ...]
    many: tuple[ManyRow, ...]
    grids: tuple[GridRow, ...]
    missed: tuple[MissedRow, ...]
