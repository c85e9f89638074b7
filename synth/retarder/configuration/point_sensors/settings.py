"""What the section [sensors] of a configuration may contain: where point sensors stand, and what is different of them.

Physical limits are the sensors' own (`PlantError`).
"""

from __future__ import annotations

from typing import Final, Literal

from synth.frame.settings.section import Section
from synth.frame.settings.value_forms import Numbers

DEFAULT_WHEEL_SENSOR: Final = "ds-2"


class PointSensorSettings(Section):
    """Sensors of a `type` of the library at `path_m`; the other numbers replace values of that type.

    `decides_on`: at whose passages the regulator decides.
    """

    type: str = DEFAULT_WHEEL_SENSOR
    path_m: Numbers
    decides_on: Literal["first_axle", "every_axle"] = "first_axle"
    base_m: float | None = None
    base_tolerance: float | None = None
    timer_noise_s: float | None = None
    timer_resolution_s: float | None = None
    computing_delay_s: float | None = None
    scan_period_s: float | None = None
    missed_share: float | None = None

    def replaced_numbers(self) -> dict[str, float]:
        """The values of the type that are replaced, by key."""
        kept = self.model_dump(exclude={"type", "path_m", "decides_on"}, exclude_none=True)
        return {key: float(value) for key, value in kept.items()}
