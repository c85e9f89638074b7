"""One pass but for the commanded speed: a cut at a retarder position, with what differs from cut to cut."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from plant_models.cut import Cut
from plant_models.entry_speed import EntryLaw
from plant_models.errors import require
from plant_models.friction import Friction
from plant_models.frozen_arrays import Floats
from plant_models.motion import mean_braked_axles, path_breaks_m, path_coefficients
from plant_models.retarder import RetarderPosition
from plant_models.rolling_resistance import RollingResistance
from plant_models.speed_sensor import DopplerSensor
from plant_models.track_profile import AT_THE_ENTRANCE, Approach, TrackProfile
from plant_models.valve_drive import ValveDrive

SLOWEST_START_M_S = 0.3


@dataclass(frozen=True)
class Plant:
    """Everything about a pass but the commanded speed.

    Parameters
    ----------
    position
        The retarders.
    cut
        The cut.
    profile
        The track.
    friction
        What the friction of cuts is.
    resistance
        What the rolling resistance of such cuts is.
    sensor
        The radar, and the computer behind it.
    entry
        How fast cuts enter.
    approach
        Where the regulator begins to act; by default at the entrance.

    Raises
    ------
    PlantError
        Two of these do not fit each other.

    Examples
    --------
    A cut of 52 t at a position of the library:

    >>> from plant_models import Cut, Plant, RollingResistance
    >>> from plant_models.library import load_position
    >>> at = load_position("knp-5-bunch")
    >>> cut = Cut("С", mass_t=52.0, axle_offsets_m=(0.0, 1.85, 8.65, 10.5), allowed_stage=3)
    >>> resistance = RollingResistance(mean_n_per_kn=1.5, std_n_per_kn=0.5)
    >>> plant = Plant(
    ...     at.position, cut, at.profile, at.friction, resistance, at.sensor, at.entry
    ... )
    >>> plant
    Plant(knp-5-bunch, 52 t on 4 axles, entry 5 to 6.5 m/s)
    >>> plant.top_stage, plant.start_m, plant.exit_m
    (3, 0.0, 37.45)
    """

    position: RetarderPosition
    cut: Cut
    profile: TrackProfile
    friction: Friction
    resistance: RollingResistance
    sensor: DopplerSensor
    entry: EntryLaw
    approach: Approach = AT_THE_ENTRANCE

    def __post_init__(self) -> None:
        require(
            self.entry.high_m_s <= self.position.max_entry_speed_m_s,
            f"entry: {self.entry.high_key} is {self.entry.high_m_s:g}; {self.position.name} takes at most "
            f"{self.position.max_entry_speed_m_s:g} m/s: lower it or choose another retarder",
        )
        require(
            self.approach.initial_stage <= self.top_stage,
            f"regulator: initial_stage is {self.approach.initial_stage}; the highest stage that this cut may be given "
            f"is {self.top_stage}",
        )
        self._require_reachable_entrance()

    def __repr__(self) -> str:
        return (
            f"Plant({self.position.name}, {self.cut.mass_t:g} t on {self.cut.axles} axles, "
            f"entry {self.entry.low_m_s:g} to {self.entry.high_m_s:g} m/s)"
        )

    def _require_reachable_entrance(self) -> None:
        """No cut may come to the entrance slower than the grade of the approach lets one that starts from rest."""
        if self.start_m == 0.0:
            return
        gained = float(self._gained_m2_s2(self.resistance.mean_n_per_kn))
        least_m_s = math.sqrt(2.0 * max(0.0, gained) + SLOWEST_START_M_S**2)
        require(
            self.entry.low_m_s >= least_m_s,
            f"regulator: approach_m is {self.approach.length_m:g}; there the grade alone brings each cut to "
            f"{least_m_s:.2f} m/s or more at the entrance, but the lowest entry speed is {self.entry.low_m_s:g}: "
            "shorten the approach or raise that speed",
        )

    @property
    def start_m(self) -> float:
        """Path of the first axle from which on the regulator acts, metres; 0 or negative."""
        return 0.0 - self.approach.length_m

    @property
    def entrance_stage(self) -> int:
        """Highest stage that may be commanded while the first axle is before the entrance."""
        return min(self.top_stage, self.approach.entrance_stage)

    def start_speed_m_s(self, entrance_speed_m_s: Floats, resistance_n_per_kn: Floats | float) -> Floats:
        """Speed where the regulator begins to act: nothing brakes between there and the entrance.

        Parameters
        ----------
        entrance_speed_m_s
            Speeds at the entrance, m/s, of any shape.
        resistance_n_per_kn
            Specific resistance of the cuts, N/kN, of that shape or one for all.

        Returns
        -------
        ndarray
            Speeds at `start_m`, m/s. No slower than `SLOWEST_START_M_S`: a cut that rolls so much easier than the mean
            that a steep approach would have brought it from less begins with that.
        """
        if self.start_m == 0.0:
            return entrance_speed_m_s
        gained = self._gained_m2_s2(resistance_n_per_kn)
        return np.sqrt(np.maximum(entrance_speed_m_s**2 - 2.0 * gained, SLOWEST_START_M_S**2))

    def _gained_m2_s2(self, resistance_n_per_kn: Floats | float) -> Floats:
        """Kinetic energy per mass that a cut gains on the approach; negative where it is slowed down."""
        edges = path_breaks_m(self.position, self.cut, self.profile, self.start_m)
        edges = np.append(edges[edges < 0.0], 0.0)
        cells = path_coefficients(self.position, self.cut, self.profile, edges)
        grade = float(cells.gravity_m_s2 @ np.diff(edges))
        return grade + self.start_m * cells.resistance_m_s2_per_n_kn * np.asarray(resistance_n_per_kn)

    @property
    def pass_m(self) -> float:
        """Length of a pass, from where the regulator acts to S_exit, m."""
        return self.exit_m - self.start_m

    @property
    def exit_m(self) -> float:
        """S_exit, path of the first axle at which the last one leaves the last retarder, m."""
        return self.position.exit_m(self.cut)

    @property
    def top_stage(self) -> int:
        """Highest stage that position and weight category both allow."""
        return min(self.position.top_stage, self.cut.allowed_stage)

    def drive_at_any_time(self) -> ValveDrive:
        """The drive for commands at every sample; raises `PlantError` where it cannot be commanded so."""
        require(
            self.sensor.computing_delay_s < self.sensor.sample_period_s,
            f"sensor: computing_delay_s is {self.sensor.computing_delay_s:g}; commands at every sample are modelled "
            "for delays shorter than sample_period_s",
        )
        return self.position.pneumatics.valves_shutting_at_once(self.position.force.touch_pressure_kpa)

    @property
    def friction_cv(self) -> float:
        """CV of ξ_cut for this cut at this position."""
        return self.friction.cut_cv(mean_braked_axles(self.position, self.cut))
