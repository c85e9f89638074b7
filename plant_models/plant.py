"""One pass but for the commanded speed: a cut at a retarder position, with what differs from cut to cut."""

from __future__ import annotations

from dataclasses import dataclass

from plant_models.cut import Cut
from plant_models.entry_speed import EntryLaw
from plant_models.errors import require
from plant_models.friction import Friction
from plant_models.motion import mean_braked_axles
from plant_models.retarder import RetarderPosition
from plant_models.rolling_resistance import RollingResistance
from plant_models.speed_sensor import DopplerSensor
from plant_models.track_profile import TrackProfile


@dataclass(frozen=True)
class Plant:
    """Everything about a pass but the commanded speed."""

    position: RetarderPosition
    cut: Cut
    profile: TrackProfile
    friction: Friction
    resistance: RollingResistance
    sensor: DopplerSensor
    entry: EntryLaw

    def __post_init__(self) -> None:
        require(
            self.entry.high_m_s <= self.position.max_entry_speed_m_s,
            f"entry: {self.entry.high_key} is {self.entry.high_m_s:g}; {self.position.name} takes at most "
            f"{self.position.max_entry_speed_m_s:g} m/s: lower it or choose another retarder",
        )

    @property
    def exit_m(self) -> float:
        """S_exit, metres."""
        return self.position.exit_m(self.cut)

    @property
    def top_stage(self) -> int:
        """Highest stage that position and weight category both allow."""
        return min(self.position.top_stage, self.cut.allowed_stage)

    @property
    def friction_cv(self) -> float:
        """CV of ξ_cut for this cut at this position."""
        return self.friction.cut_cv(mean_braked_axles(self.position, self.cut))
