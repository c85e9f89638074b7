"""What the section [sensors] of a configuration may contain: where point sensors stand, and what is different of them.

Physical limits are the sensors' own (`PlantError`).
"""

from __future__ import annotations

from typing import Final, Literal

from pydantic import Field

from plant_models.library import WHEEL_SENSORS
from synth.frame.settings.section import Section, choice, of_library
from synth.frame.settings.value_forms import Numbers
from synth.retarder.configuration.top_keys import named_type

DEFAULT_WHEEL_SENSOR: Final = "ds-2"


class PointSensorSettings(Section):
    """Point sensors; they stand in place of [sensor] and [regulator] approach_m."""

    type: str = named_type(DEFAULT_WHEEL_SENSOR, WHEEL_SENSORS, "type of the sensors")
    path_m: Numbers = Field(
        description="from the entrance of the first retarder to the middle of each sensor's base, rising, at least 0.3 "
        "m apart; the first at the entrance or ahead of it, and one behind the exit may log",
        json_schema_extra={"unit": "m", "source": "where you put them"},
    )
    decides_on: Literal["first_axle", "every_axle"] = choice("first_axle", "at whose passages the regulator decides")
    base_m: float | None = of_library("distance of the coils")
    base_tolerance: float | None = of_library("standard deviation of its relative error, lasting for each sensor")
    timer_noise_s: float | None = of_library("standard deviation of a measured time")
    timer_resolution_s: float | None = of_library("times are whole multiples of it; 0: not rounded")
    computing_delay_s: float | None = of_library("from the second pulse to the command on the wires")
    scan_period_s: float | None = of_library("step of the regulator's clock; changes of stage last whole steps")
    missed_share: float | None = of_library("share of the passages that a table counts as not heard")
